// SPDX-License-Identifier: BSD-3-Clause
// From a scene to what plans and flies in it.
#pragma once

#include "evaluation/playground/scene.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/pad_geometry.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// The vehicle that comes with the library (sim/models/quadrotor.xml): no MJCF is read in a browser.
estimation::VehicleModel PlaygroundVehicle();

sim::PadGeometry PlaygroundPad();
sim::ObstacleField FieldOf(const PlaygroundScene& scene);

/// It hovers at the scene's start and looks towards the pad.
estimation::VehicleState StartOf(const PlaygroundScene& scene);

/// As the program plans a landing by default, but for what the scene says.
planning::ReplannerOptions PlannerOf(const PlaygroundScene& scene);
control::OnboardOptions OnboardOptionsOf(const PlaygroundScene& scene);

/// Distance from the hull, at every tilt, to the nearest obstacle [m].
double HullClearance(const sim::ObstacleField& field, const Eigen::Vector3d& p_WB);

}  // namespace touchdown::evaluation
