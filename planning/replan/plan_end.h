// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "touchdown/planning/replan/goal.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// Where the plans of a step end: at the pad or goal, at a place to look from, or on the straight way there if that is
/// too far for one plan.
class PlanEnd {
 public:
  explicit PlanEnd(const ReplannerOptions& options) : options_(options) {}

  /// A pad that drives away is met where it will be when the vehicle has caught up with it.
  void Set(const ReplanInput& input, const SplineState& start, const Limits& limits);

  /// No place to look from, nor on the way.
  void Forget() {
    look_from_.reset();
    on_the_way_.reset();
  }

  /// The first arrival from T on, and before the next attempt's, at which the end is free [s]. So a pad that passes an
  /// obstacle is met behind it. Under a roof there is none: then T, and an end above the pad comes down.
  double FindFree(double t_start, double T, const OccupancyMap& map);

  const estimation::PadPrediction& pad() const { return *pad_; }
  const EndpointTarget& target() const { return target_; }
  bool is_look() const { return look_from_.has_value(); }
  bool is_on_the_way() const { return on_the_way_.has_value(); }

 private:
  const ReplannerOptions& options_;
  std::optional<GoalAt> look_from_, on_the_way_;
  const estimation::PadPrediction* pad_ = nullptr;
  EndpointTarget target_;
};

/// Heights above a deck at p_WP come down below a roof: the greatest up to `height` at which the body's place is free
/// [m]. If none from 0.6 m on is, `height`.
double LowerUnderRoof(const FreeSpace& space, const Eigen::Vector3d& p_WP, double height);

}  // namespace touchdown::planning
