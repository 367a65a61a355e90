// SPDX-License-Identifier: BSD-3-Clause
// How early a landing is possible at all: what a trial's time to land is measured against. The proof
// is in docs/t_star.md.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/sim/pad_motion.h"

namespace touchdown::evaluation {

/// A point that hovers at first, flies within limits on the norms of velocity and acceleration, and
/// shall touch a pad whose future is known. There are no obstacles, no wind and no ground.
struct LandingTimeTask {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< start, at rest [m]
  double speed = 3.0;                              ///< limit [m/s], > 0
  double acceleration = 6.0;                       ///< limit [m/s^2], > 0
  /// The contact point is on the deck, this far from its centre at most [m] ...
  double deck_radius = 1.06;
  double foot_reach = 0.21;        ///< ... and this far from B [m]
  double horizontal_speed = 0.6;   ///< at contact, relative to the deck point below B [m/s]
  double vertical_speed = 0.5;     ///< the same [m/s]
  double horizon = 60.0;           ///< no later landings are looked for [s], > 0
  sim::PadMotionBounds pad_rates;  ///< hold over the horizon
  /// The pad is never farther from the motion that is given than this [m, m/s].
  double pad_position_error = 0.0;
  double pad_velocity_error = 0.0;
};

/// T*: no trajectory of the task ends in contact before this [s], at most the horizon. `pad` is asked
/// from t = 0, the start, on. Some 0.5 ms.
/// @throws std::invalid_argument if a limit or the horizon is not > 0.
double LandingTimeLowerBound(const LandingTimeTask& task, const estimation::PadPrediction& pad);

/// A contact time of a trajectory that was found and checked [s]: T* is not far below. Empty if none
/// was found within the horizon. `lower_bound`: where to begin to look. Some 20 ms.
std::optional<double> LandingTimeUpperBound(const LandingTimeTask& task,
                                            const estimation::PadPrediction& pad,
                                            double lower_bound);

}  // namespace touchdown::evaluation
