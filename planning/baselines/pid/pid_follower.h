// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "planning/baselines/pid/pid_law.h"
#include "touchdown/planning/replan/planner.h"

namespace touchdown::planning {

/// The track-then-descend baseline: a PID law leads the vehicle above the pad, and the height follows the mission's.
/// It plans nothing and knows no obstacle, floor or ceiling. Call Replan at kRate. An answer for t_now takes over at
/// t_start, and a step that is asked sooner is idle. A result's curve is the reference of one period: a parabola,
/// past whose end it goes on at its velocity.
class PidFollower : public Planner {
 public:
  static constexpr double kRate = 50.0;      ///< of the law [Hz]
  static constexpr double kLostTrack = 0.5;  ///< farther from the vehicle it starts there anew [m]

  /// Throws std::invalid_argument if a gain is out of range, or a limit is not positive.
  PidFollower(const PidGains& gains, const Limits& limits);

  void CommitHover(const Eigen::Vector3d& p_W, double t) override;
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) override;
  const ReplanResult& Rest(const ReplanInput& input, double climb,
                           const OccupancyMap& map) override;
  void TakeOverAt(double t) override;
  FlatState Reference(double t) const override;

 private:
  bool Begin(const ReplanInput& input);
  SplineState Start(const ReplanInput& input);
  void Commit(const SplineState& start, const Eigen::Vector3d& a, double t);
  const UniformBspline& InForce(double t) const { return t < takes_over_ ? current_ : next_; }

  Limits limits_;
  PidLaw law_;
  UniformBspline current_, next_;
  double takes_over_ = 0.0;      // next_ does [s]
  std::optional<double> climb_;  // of the rest under way [m] ...
  double rest_height_ = 0.0;     // ... and where it ends, in W [m]
  ReplanResult result_;
};

}  // namespace touchdown::planning
