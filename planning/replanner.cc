// SPDX-License-Identifier: BSD-3-Clause
// The replanning step: start from the committed trajectory (or from the vehicle where tracking lost
// it), choose an arrival, try, re-time while limits or obstacles forbid, commit what is certified. If
// nothing is: keep the previous plan while it is safe, else brake, else climb, and say so.

#include "touchdown/planning/replanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/duration_guess.h"
#include "touchdown/planning/plan_attempt.h"
#include "touchdown/planning/rest_trajectory.h"
#include "touchdown/planning/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr int kMaxAttempts = 6;
constexpr double kStretch = 1.2;          // of the duration after an attempt that failed
constexpr double kReTimeBelow = 0.75;     // a fresh guess this much shorter replaces the arrival
constexpr double kKeepReserve = 0.5;      // time to spare before a kept plan has to brake [s]
constexpr double kClimb = 1.5;            // [m]
constexpr double kAtRest = 0.05;          // below this speed and way to go [m/s, m]

const Eigen::Vector3d kNoShift = Eigen::Vector3d::Zero();

/// State on a curve; past its end it goes on at the end's velocity.
FlatState StateOn(const UniformBspline& curve, double t) {
  FlatState state = curve.Evaluate(t);
  const double past = t - curve.t_end();
  if (past > 0.0) {
    state.p_WB += past * state.v_WB;
    state.a_WB.setZero();
    state.j_WB.setZero();
  }
  return state;
}

SplineState ToSpline(const FlatState& flat) { return {flat.p_WB, flat.v_WB, flat.a_WB}; }

bool Finite(const ReplanInput& input) {
  return std::isfinite(input.t_now) && std::isfinite(input.t_start) && input.vehicle.p_WB.allFinite() &&
         input.vehicle.v_WB.allFinite() && std::isfinite(input.endpoint.height) &&
         std::isfinite(input.endpoint.sink_rate) && std::isfinite(input.endpoint.height_floor) &&
         std::isfinite(input.endpoint.t_reference) && input.pad != nullptr &&
         input.pad->At(input.t_start).p_WP.allFinite() &&
         input.pad->At(input.t_start).v_WP.allFinite();
}

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string("ReplannerOptions: ") + name + " is " +
                              std::to_string(value) + ", it must be " + range);
}

void Validate(const ReplannerOptions& o) {
  Require(o.limits.speed > 0.0, "limits.speed", o.limits.speed, "> 0 m/s");
  Require(o.limits.acceleration > 0.0, "limits.acceleration", o.limits.acceleration, "> 0 m/s^2");
  Require(o.ceiling_height > o.floor_height, "ceiling_height", o.ceiling_height,
          "above floor_height");
  Require(o.min_duration > 0.0, "min_duration", o.min_duration, "> 0 s");
  Require(o.max_duration > o.min_duration, "max_duration", o.max_duration, "above min_duration");
  Require(o.odometry_threshold > 0.0, "odometry_threshold", o.odometry_threshold, "> 0 m");
  Require(o.reaction >= 0.0, "reaction", o.reaction, ">= 0 s");
  Require(o.max_rebinds >= 0, "max_rebinds", o.max_rebinds, ">= 0");
  Require(o.max_iterations >= 1, "max_iterations", o.max_iterations, ">= 1");
  Require(o.max_expansions >= 1, "max_expansions", o.max_expansions, ">= 1");
}

}  // namespace

class Replanner::Impl {
 public:
  Impl(const ReplannerOptions& options, const solvers::BackendRegistry& backends)
      : options_(options), attempt_(options, backends) {}

  void Commit(const UniformBspline& curve) {
    current_ = next_;
    next_ = curve;
  }

  /// The curve that is flown at time t.
  const UniformBspline& InForce(double t) const { return t < next_.t0() ? current_ : next_; }

  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map);

  const ReplannerOptions options_;
  UniformBspline current_, next_;

 private:
  FreeSpace Space(const ReplanInput& input, double t_end, const OccupancyMap& map) const;
  ReplanReason Plan(const ReplanInput& input, const SplineState& start, const OccupancyMap& map);
  void FallBack(const ReplanInput& input, const SplineState& start, const OccupancyMap& map);
  bool TryRest(const SplineState& start, double t0, const Eigen::Vector3d& shift,
               const FreeSpace& space);

  PlanAttempt attempt_;
  ReplanResult result_;
  bool planned_before_ = false;  // the committed curve is a plan to the pad: its arrival is kept
};

FreeSpace Replanner::Impl::Space(const ReplanInput& input, double t_end,
                                 const OccupancyMap& map) const {
  FreeSpace space;
  space.map = &map;
  space.floor = options_.floor_height;
  space.ceiling = options_.ceiling_height;
  space.pad_from = input.pad->At(input.t_start).p_WP.head<2>();
  space.pad_to = input.pad->At(t_end).p_WP.head<2>();
  space.pad_radius = options_.pad_radius;
  return space;
}

const ReplanResult& Replanner::Impl::Replan(const ReplanInput& input, const OccupancyMap& map) {
  result_.times = {};
  StageTimer total(&result_.times.total);
  result_.guide_paths.clear();
  result_.pairs = result_.solves = result_.rebinds = 0;
  result_.from_odometry = false;
  result_.solver = {};
  if (!Finite(input) || input.t_start < input.t_now) {
    result_.status = ReplanStatus::kKept;
    result_.reason = ReplanReason::kInvalidInput;
    result_.curve = next_;
    return result_;
  }

  const FlatState reference = StateOn(InForce(input.t_now), input.t_now);
  SplineState start = ToSpline(StateOn(InForce(input.t_start), input.t_start));
  if ((reference.p_WB - input.vehicle.p_WB).norm() > options_.odometry_threshold) {
    result_.from_odometry = true;
    const double latency = input.t_start - input.t_now;
    start.p = input.vehicle.p_WB + latency * input.vehicle.v_WB;
    start.v = input.vehicle.v_WB;
    start.a.setZero();
  }

  result_.reason = Plan(input, start, map);
  if (result_.reason == ReplanReason::kNone) {
    result_.status = ReplanStatus::kPlanned;
    planned_before_ = true;
    Commit(result_.curve);
  } else {
    FallBack(input, start, map);
  }
  return result_;
}

ReplanReason Replanner::Impl::Plan(const ReplanInput& input, const SplineState& start,
                                   const OccupancyMap& map) {
  double fresh;
  {
    StageTimer timer(&result_.times.predict);
    fresh = GuessDuration(start, input.t_start, *input.pad, input.endpoint, options_.limits, 1.0);
  }
  if (!(fresh <= options_.max_duration)) return ReplanReason::kPadUnreachable;
  // An arrival once promised is kept: guessing anew at every step would put it off for ever.
  double T = fresh;
  if (planned_before_ && !result_.from_odometry) {
    const double left = next_.t_end() - input.t_start;
    if (fresh > kReTimeBelow * left) T = left;
  }
  T = std::max(T, options_.min_duration);

  AttemptRequest request;
  request.start = start;
  request.t0 = input.t_start;
  request.pad = input.pad;
  request.target = input.endpoint;
  request.arrival = options_.arrival;
  request.previous = planned_before_ ? &next_ : nullptr;
  ReplanReason reason = ReplanReason::kNone;
  for (int i = 0; i < kMaxAttempts && T <= options_.max_duration; ++i) {
    const FreeSpace space = Space(input, input.t_start + T, map);
    request.duration = T;
    request.space = &space;
    reason = attempt_.Run(request, &result_);
    const bool slower_helps = reason == ReplanReason::kLimitsExceeded ||
                              reason == ReplanReason::kUnobserved ||
                              reason == ReplanReason::kCollisionRemains ||
                              reason == ReplanReason::kGoalBlocked;
    if (!slower_helps) return reason;
    // Free arrival traded a limit for time: fix a longer one.
    if (request.arrival == ArrivalMode::kFree) T = std::max(T, result_.curve.duration());
    request.arrival = ArrivalMode::kFixed;
    T *= kStretch;
  }
  return reason;
}

bool Replanner::Impl::TryRest(const SplineState& start, double t0, const Eigen::Vector3d& shift,
                              const FreeSpace& space) {
  result_.curve = MakeRestTrajectory(start, t0, shift, options_.limits);
  StageTimer timer(&result_.times.certificate);
  result_.certificate = Certify(result_.curve, t0, nullptr, options_.limits, 0.0, space);
  return result_.certificate.passed();
}

void Replanner::Impl::FallBack(const ReplanInput& input, const SplineState& start,
                               const OccupancyMap& map) {
  const FreeSpace space = Space(input, input.t_start + options_.min_duration, map);
  const UniformBspline brake = MakeRestTrajectory(start, input.t_start, kNoShift, options_.limits);
  const double reserve = brake.duration() + kKeepReserve;
  if (!result_.from_odometry) {
    const double hit = FirstBlockedTime(next_, input.t_start, space);
    const SplineState last = next_.AtKnot(next_.segments());
    const bool moves_at_end = last.v.norm() > kAtRest;
    const double end = moves_at_end ? next_.t_end() : std::numeric_limits<double>::infinity();
    const bool at_rest = !space.Blocked(start.p) && start.v.norm() <= kAtRest && (last.p - start.p).norm() <= kAtRest;
    if (std::min(hit, end) > input.t_start + reserve || at_rest) {
      result_.status = at_rest ? ReplanStatus::kHolding : ReplanStatus::kKept;
      result_.curve = next_;
      result_.certificate = Certify(next_, input.t_start, nullptr, options_.limits, 0.0, space);
      return;
    }
  }
  planned_before_ = false;
  CellIndex way_out = map.CellOf(start.p);
  const bool inside = space.Blocked(start.p) && GridSearch::NearestFree(space, &way_out);
  const Eigen::Vector3d climb = kClimb * Eigen::Vector3d::UnitZ();
  if (inside && TryRest(start, input.t_start, map.CentreOf(way_out) - start.p, space)) {
    result_.status = ReplanStatus::kEscaping;
  } else if (TryRest(start, input.t_start, kNoShift, space)) {
    result_.status = ReplanStatus::kBraking;
  } else if (TryRest(start, input.t_start, climb, space)) {
    result_.status = ReplanStatus::kClimbing;
  } else {
    // Nothing is certified. Of what is left, braking meets any obstacle slowest.
    result_.status = ReplanStatus::kUnsafe;
    result_.curve = brake;
  }
  Commit(result_.curve);
}

Replanner::Replanner(const ReplannerOptions& options, const solvers::BackendRegistry& backends) {
  Validate(options);
  impl_ = std::make_unique<Impl>(options, backends);
}
Replanner::~Replanner() = default;
Replanner::Replanner(Replanner&&) noexcept = default;
Replanner& Replanner::operator=(Replanner&&) noexcept = default;

void Replanner::CommitHover(const Eigen::Vector3d& p_W, double t) {
  ControlPoints points(3, 4);
  points.colwise() = p_W;
  const UniformBspline hover(points, 1.0, t);
  impl_->current_ = hover;
  impl_->next_ = hover;
}

const ReplanResult& Replanner::Replan(const ReplanInput& input, const OccupancyMap& map) {
  return impl_->Replan(input, map);
}

FlatState Replanner::Reference(double t) const { return StateOn(impl_->InForce(t), t); }

const ReplannerOptions& Replanner::options() const { return impl_->options_; }

const char* ToString(ReplanStatus status) {
  switch (status) {
    case ReplanStatus::kPlanned: return "planned";
    case ReplanStatus::kKept: return "kept";
    case ReplanStatus::kBraking: return "braking";
    case ReplanStatus::kClimbing: return "climbing";
    case ReplanStatus::kEscaping: return "escaping";
    case ReplanStatus::kHolding: return "holding";
    case ReplanStatus::kUnsafe: return "unsafe";
  }
  return "unknown";
}

const char* ToString(ReplanReason reason) {
  switch (reason) {
    case ReplanReason::kNone: return "none";
    case ReplanReason::kInvalidInput: return "invalid_input";
    case ReplanReason::kStartBlocked: return "start_blocked";
    case ReplanReason::kGoalBlocked: return "goal_blocked";
    case ReplanReason::kPadUnreachable: return "pad_unreachable";
    case ReplanReason::kSearchFailed: return "search_failed";
    case ReplanReason::kSolverFailed: return "solver_failed";
    case ReplanReason::kCollisionRemains: return "collision_remains";
    case ReplanReason::kUnobserved: return "unobserved";
    case ReplanReason::kLimitsExceeded: return "limits_exceeded";
  }
  return "unknown";
}

const char* Explain(ReplanReason reason) {
  switch (reason) {
    case ReplanReason::kNone: return "A new plan was certified.";
    case ReplanReason::kInvalidInput: return "A number of the input is not finite, or the plan would start in the past.";
    case ReplanReason::kStartBlocked: return "The start is inside an inflated obstacle and no certified way leads out.";
    case ReplanReason::kGoalBlocked: return "The end is inside an inflated obstacle at every arrival time tried.";
    case ReplanReason::kPadUnreachable: return "No arrival time up to the longest allowed reaches the pad within the limits.";
    case ReplanReason::kSearchFailed: return "No way around an obstacle was found within the budget of expansions.";
    case ReplanReason::kSolverFailed: return "The solver returned no usable point.";
    case ReplanReason::kCollisionRemains: return "The curve is still blocked after every re-binding round.";
    case ReplanReason::kUnobserved: return "The plan is too fast to stop before space that was never observed.";
    case ReplanReason::kLimitsExceeded: return "The curve still exceeds a limit after every re-timing.";
  }
  return "unknown";
}

}  // namespace touchdown::planning
