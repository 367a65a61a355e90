// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// The parts of the room around the hull, at one moment (docs/safety.md) [m].
struct Margins {
  double own_state =
      0.0;  ///< a cell was seen with one error of the own position, and is passed with another
  double attitude = 0.0;   ///< an attitude in error turns what the camera sees
  double tracking = 0.08;  ///< how far the vehicle is from its reference

  double Sum() const { return own_state + attitude + tracking; }
};

/// Margins from the vehicle's own estimates: one standard deviation of its position [m] and of its
/// attitude [rad], and its recent distance from its reference [m]. `gust` is the root mean square
/// of the force's quick changes over the vehicle's mass [m/s^2]: steady wind is balanced, a gust
/// pushes.
Margins MarginsOf(double sigma_position, double sigma_attitude, double recent_tracking,
                  double gust) noexcept;

/// The largest recent error: it fades with kFade [s].
class RecentError {
 public:
  static constexpr double kFade = 1.0;

  /// An error at time t [s], rising. Does not allocate.
  void Note(double t, double error) noexcept;

  double value() const { return value_; }

 private:
  double t_ = 0.0;
  double value_ = 0.0;
};

}  // namespace touchdown::planning
