// SPDX-License-Identifier: BSD-3-Clause
// How early a landing is possible at all. A trial's time to land is compared with this. The proof is in docs/t_star.md
// and landing_time_lower.cc.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/pad/pad_motion.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// The task of a point that hovers at first and flies within limits on the norms of velocity and
/// acceleration. It must touch a pad whose future is known. There are no obstacles, no wind and no
/// ground.
struct LandingTimeTask {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< start, at rest [m]
  double speed = 3.0;                              ///< limit [m/s], > 0
  double acceleration = 6.0;                       ///< limit [m/s^2], > 0
  double deck_half_size = 0.75;    ///< half the side of the deck, a square in the pad's yaw [m]
  double deck_thickness = 0.03;    ///< [m]
  double foot_reach = 0.21;        ///< greatest distance of a point of the feet from B [m]
  double foot_radius = 0.16;       ///< horizontal distance of a foot from B if it is level [m], > 0
  double foot_depth = 0.12;        ///< lowest point of the feet below B if the vehicle is level [m]
  double horizontal_speed = 0.6;   ///< at contact, relative to the deck point below B [m/s]
  double vertical_speed = 0.5;     ///< the same [m/s]
  double horizon = 60.0;           ///< no later landings are looked for [s], > 0
  sim::PadMotionBounds pad_rates;  ///< hold over the horizon
  /// The pad is never farther from the motion that is given than this.
  double pad_position_error = 0.0;  ///< [m]
  double pad_velocity_error = 0.0;  ///< [m/s]
  double pad_yaw_error = 0.0;       ///< [rad]
  double pad_yaw_rate_error = 0.0;  ///< [rad/s]

  double deck_radius() const { return std::numbers::sqrt2 * deck_half_size; }  ///< to a corner [m]
};

/// A flight of the task: position is a uniform quadratic B-spline on [0, time].
struct LandingFlight {
  double time = 0.0;                            ///< of contact [s]
  std::vector<Eigen::Vector3d> control_points;  ///< [m]
};

/// T*: no trajectory of the task ends in contact before this [s], at most the horizon. Contact has
/// the widest meaning: any attitude, any point of the feet on any point of the deck. `pad` is asked
/// from t = 0, the start, on. Takes some 0.5 ms.
/// @throws std::invalid_argument if a limit or the horizon is not > 0.
double LandingTimeLowerBound(const LandingTimeTask& task, const estimation::PadPrediction& pad);

/// A flight that was found and checked: T* is not far below its time. It comes from above the deck's plane. It ends
/// level with a foot on the deck at some heading, for all errors of the pad that the task allows. Empty if none was
/// found within the horizon, for example where the start is lower than that end. `lower_bound`: where the search
/// starts. Takes tens of milliseconds.
std::optional<LandingFlight> LandingTimeUpperBound(const LandingTimeTask& task,
                                                   const estimation::PadPrediction& pad,
                                                   double lower_bound);

}  // namespace touchdown::evaluation
