// SPDX-License-Identifier: BSD-3-Clause
// The curve is the quintic between both ends as a uniform B-spline; the arrival is put off until it keeps
// the limits. Source: this example.

#include "straight_planner.h"

#include <utility>

#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/planning/spline/boundary_lift.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace own {
namespace {
constexpr int kSegments = 12;
constexpr double kShortest = 0.8;  // of a plan [s]
constexpr double kLongest = 30.0;  // [s]
constexpr double kGrowth = 1.1;
}  // namespace

void StraightPlanner::CommitHover(const Eigen::Vector3d& p_W, double t) {
  next_ = MakeRestTrajectory({.p = p_W}, t, Eigen::Vector3d::Zero(), limits_);
  current_ = next_;
}

const ReplanResult& StraightPlanner::Replan(const ReplanInput& input, const OccupancyMap& map) {
  if (input.pad == nullptr) return Rest(input, 0.0, map);
  result_.times = {};
  StageTimer total(&result_.times.total);
  // Shortly before contact the plan that leads there goes on: a new one would put it off.
  const bool goes_on = touches_ && next_.t_end() - input.t_start < kShortest;
  if (goes_on && input.endpoint.leads_to_contact()) {
    result_.status = ReplanStatus::kKept;
    result_.committed = false;
    return result_;
  }
  const SplineState start = StartAt(input.t_start);
  for (double T = kShortest; T < kLongest; T *= kGrowth) {
    const EndState end = EndStateAt(*input.pad, input.endpoint, input.t_start + T);
    UniformBspline curve(HermiteControlPoints(start, end.state, kSegments, T), T / kSegments,
                         input.t_start);
    const DerivativeBounds bounds = BoundDerivatives(curve);
    if (bounds.speed <= limits_.speed && bounds.acceleration <= limits_.acceleration) {
      Commit(std::move(curve), ReplanStatus::kPlanned, ReplanReason::kNone);
      touches_ = input.endpoint.touches();
      return result_;
    }
  }
  return Commit(MakeRestTrajectory(start, input.t_start, Eigen::Vector3d::Zero(), limits_),
                ReplanStatus::kBraking, ReplanReason::kPadUnreachable);
}

const ReplanResult& StraightPlanner::Rest(const ReplanInput& input, double climb,
                                          const OccupancyMap& /*map*/) {
  if (climb_ == climb) {  // asked again at every step while it lasts
    result_.committed = false;
    return result_;
  }
  const Eigen::Vector3d up = climb * Eigen::Vector3d::UnitZ();
  Commit(MakeRestTrajectory(StartAt(input.t_start), input.t_start, up, limits_),
         climb > 0.0 ? ReplanStatus::kClimbing : ReplanStatus::kBraking, ReplanReason::kNone);
  climb_ = climb;
  return result_;
}

FlatState StraightPlanner::Reference(double t) const {
  return (t < takes_over_ ? current_ : next_).EvaluateOnward(t);
}

const ReplanResult& StraightPlanner::Commit(UniformBspline curve, ReplanStatus status,
                                            ReplanReason reason) {
  current_ = std::exchange(next_, std::move(curve));
  takes_over_ = next_.t0();
  climb_.reset();
  touches_ = false;
  result_ = {};
  result_.status = status;
  result_.reason = reason;
  result_.committed = true;
  result_.curve = next_;
  return result_;
}

SplineState StraightPlanner::StartAt(double t) const {
  const FlatState at = Reference(t);
  return {at.p_WB, at.v_WB, at.a_WB};
}

}  // namespace own
