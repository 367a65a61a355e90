// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/mujoco/mujoco_model.h"

namespace touchdown::sim {

/// Points in W whose hull holds a geom, after mj_kinematics: a mesh's own points, or those of a prism around a round
/// geom.
std::vector<Eigen::Vector3d> PointsAround(const mjModel_& m, const mjData_& d, int geom);

/// For pictures: for each geom of the vehicle in the MJCF file at `path`, points whose hull holds it. They are in axes
/// of the body that has the free joint, from the centre of mass [m]. Empty where there is no free joint. Throws
/// std::invalid_argument with MuJoCo's message.
std::vector<std::vector<Eigen::Vector3d>> VehicleOutlines(const std::string& path);

}  // namespace touchdown::sim
