// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "planning/baselines/ego/ego_options.h"
#include "planning/baselines/ego/quintic.h"

namespace touchdown::planning {

/// Where a local plan shall end.
struct LocalTarget {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< in W [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< in W [m/s]
};

/// The global reference of the EGO-Planner baseline, and the progress along it. It is a chain of
/// quintics on the straight line from the vehicle to the goal, which ignores obstacles.
class EgoReference {
 public:
  /// From the vehicle's position and velocity to the goal, which is reached with velocity v_goal (zero,
  /// as published; the pad's for `ego-velocity`).
  void Set(const Eigen::Vector3d& p, const Eigen::Vector3d& v, const Eigen::Vector3d& goal,
           const Eigen::Vector3d& v_goal, const EgoOptions& options);

  /// The first point of the reference that is a horizon away from `p`; the goal where none is. If
  /// the first point looked at is already farther away, returns the old target, as published.
  LocalTarget Target(const Eigen::Vector3d& p, const EgoOptions& options);

  const Eigen::Vector3d& goal() const { return goal_.p; }

 private:
  QuinticChain chain_;
  LocalTarget goal_;
  LocalTarget last_;
  double progress_ = 0.0;  // time of the nearest point passed [s]
};

}  // namespace touchdown::planning
