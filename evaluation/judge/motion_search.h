// SPDX-License-Identifier: BSD-3-Clause
// A search in position and speed. It finds ways that a vehicle can fly from the speed it has; a path through free cells
// does not consider that speed.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/planning/spline/limits.h"

namespace touchdown::evaluation {

/// A place on a way and when it is passed.
struct TimedPlace {
  double t = 0.0;                               ///< after the start [s]
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< in W [m]
};
using TimedMotion = std::vector<TimedPlace>;

struct MotionSearchOptions {
  double share = 0.8;  ///< of the acceleration limit that is used
  double step = 0.3;   ///< of one acceleration [s]
  int max_expansions = 20000;
};

/// A way of pieces of constant acceleration that stays in free cells and below the limits. It ends with a quintic in
/// the end's state at its arrival. Greedy: not the earliest. Empty: none was found. Allocates.
std::optional<TimedMotion> SearchMotion(const planning::SplineState& start,
                                        const estimation::PadPrediction& pad,
                                        const planning::EndpointTarget& target,
                                        const planning::Limits& limits,
                                        const planning::FreeSpace& space,
                                        const MotionSearchOptions& options);

}  // namespace touchdown::evaluation
