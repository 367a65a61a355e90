// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace touchdown::sim {

/// Way along a path at one instant, with its derivatives by time.
struct PacePoint {
  double s = 0.0;             ///< [m]
  double speed = 0.0;         ///< signed [m/s]
  double acceleration = 0.0;  ///< [m/s^2]
  double jerk = 0.0;          ///< [m/s^3]
};

/// How a path is driven: arc length over time, in stretches of constant speed. Changes of speed are smoothed over three
/// times `smoothing` [s], so that speed, acceleration and jerk are continuous. Before the first and after the last knot
/// the speed stays what it is there, unless the pace is periodic.
class Pace {
 public:
  struct Knot {
    double t = 0.0;  ///< [s]
    double s = 0.0;  ///< [m]
  };

  /// Throws std::invalid_argument unless there are two knots or more, at rising times, and
  /// smoothing > 0.
  Pace(std::vector<Knot> knots, double smoothing);

  /// The knots repeat for ever, forwards and backwards in time. Each period adds the arc length between the first and
  /// the last knot. Throws likewise, and unless a period is 1.5 times `smoothing` or longer.
  static Pace Periodic(const std::vector<Knot>& knots, double smoothing);

  /// Any finite t [s]. Does not allocate.
  PacePoint At(double t) const noexcept;

  double LeastSpeed() const { return slowest_; }     ///< [m/s]
  double GreatestSpeed() const { return fastest_; }  ///< [m/s]
  /// Bounds on the magnitudes of acceleration and jerk.
  double MaxAcceleration() const { return MaxAcceleration(fastest_ - slowest_, smoothing_); }
  double MaxJerk() const { return MaxJerk(fastest_ - slowest_, smoothing_); }
  static double MaxAcceleration(double range, double smoothing) { return 0.75 * range / smoothing; }
  static double MaxJerk(double range, double smoothing) {
    return 2.0 * range / (smoothing * smoothing);
  }
  /// The least smoothing that keeps both bounds for speeds within `range` of each other.
  static double SmoothingFor(double range, double acceleration, double jerk);

 private:
  double SlopeAfter(std::size_t knot) const;
  PacePoint AmongKnots(double t) const noexcept;

  std::vector<Knot> knots_;  ///< of three periods, if it is periodic
  double smoothing_;
  Knot period_;  ///< time and way of one; time 0: not periodic
  double slowest_ = 0.0;
  double fastest_ = 0.0;
};

}  // namespace touchdown::sim
