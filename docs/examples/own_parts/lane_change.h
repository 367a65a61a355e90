// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/sim/pad/curvature_chain.h"

namespace own {

/// The turns of a lane change.
struct LaneChangeTurns {
  double after = 0.0;      ///< driven before the first one begins [m]
  double angle = 0.0;      ///< of each; left first for a positive one [rad]
  double curvature = 0.0;  ///< at its tightest, of the angle's sign [1/m]
  double ramp = 0.0;       ///< way in which the curvature builds up [m], < angle / curvature
};

/// Straight on, a turn and the same turn back, straight on for ever.
touchdown::sim::CurvatureChain LaneChange(const Eigen::Vector2d& start, double heading,
                                          const LaneChangeTurns& turns);

}  // namespace own
