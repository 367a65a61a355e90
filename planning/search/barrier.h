// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "touchdown/planning/spline/flatness.h"

namespace touchdown::planning {

/// The half of the plane through `p` across `normal` that lies on `side` of it must not be crossed.
/// Closes one way around an obstacle at p, so that the search finds another.
struct Barrier {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();        ///< in W [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit vector, along the way
  Eigen::Vector3d side = Eigen::Vector3d::UnitY();    ///< unit vector in the plane
};

/// Closes the way that a path takes around an obstacle. `through` is the state of a curve through
/// the obstacle. None if the path passes too near to the state to determine a side, or there is no
/// direction.
std::optional<Barrier> ClosePath(std::span<const Eigen::Vector3d> path, const FlatState& through);

/// Distance from the plane of the barrier, positive along its normal [m].
inline double DistanceAlong(const Barrier& barrier, const Eigen::Vector3d& p_W) {
  return (p_W - barrier.p).dot(barrier.normal);
}

/// True if a cell of this size at this centre belongs to the barrier. No path of neighbouring cells passes
/// the half plane without one.
bool Closes(const Barrier& barrier, const Eigen::Vector3d& centre, double resolution);

/// Beyond this distance from its plane no cell belongs to a barrier [cells].
inline constexpr double kBarrierThickness = 0.9;

}  // namespace touchdown::planning
