// SPDX-License-Identifier: BSD-3-Clause
// One attempt at a plan: solve without obstacles, then check / bind / solve until the whole curve
// is clear. Pairs start empty at every attempt, so that none outlives the obstacle it was made for;
// the side of an obstacle is kept by taking the committed curve, while it is clear, as the guide
// path, and only else a new A* path.

#include "touchdown/planning/plan_attempt.h"

#include <algorithm>
#include <cmath>

#include "touchdown/planning/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kSegmentDuration = 0.20;  // [s], aimed at
constexpr int kFewestSegments = 12;
constexpr int kMostSegments = 64;
constexpr int kSegmentStep = 4;         // keeps the number of prepared problems small
constexpr double kPressure = 1.6;       // weight of the pairs grows by this every round
constexpr double kRowTolerance = 2e-6;  // what backends leave of the equality rows, as a norm
constexpr double kGuideStep = 0.05;     // sampling of the committed curve as a guide [s]

int SegmentsFor(double duration) {
  const int wanted = static_cast<int>(std::ceil(duration / kSegmentDuration));
  const int rounded = (wanted + kSegmentStep - 1) / kSegmentStep * kSegmentStep;
  return std::clamp(rounded, kFewestSegments, kMostSegments);
}

void SampleGuide(const UniformBspline& curve, double t_from, GuidePath* guide) {
  guide->clear();
  for (double t = std::max(t_from, curve.t0()); t < curve.t_end(); t += kGuideStep) {
    guide->push_back(curve.Evaluate(t).p_WB);
  }
  guide->push_back(curve.Evaluate(curve.t_end()).p_WB);
}

}  // namespace

LandingProblemOptions ProblemOptions(const ReplannerOptions& options, ArrivalMode arrival) {
  LandingProblemOptions problem = options.problem;
  problem.arrival = arrival;
  problem.limits = options.limits;
  problem.min_duration = options.min_duration;
  problem.max_duration = options.max_duration;
  return problem;
}

PlanAttempt::PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends)
    : options_(options), backends_(backends), search_(options.vertical_cost) {
  // All of it now: refusals surface here, and nothing is built in the middle of a flight. A free
  // arrival falls back to a fixed one.
  for (int segments = kFewestSegments; segments <= kMostSegments; segments += kSegmentStep) {
    Prepare(segments, ArrivalMode::kFixed);
    if (options.arrival == ArrivalMode::kFree) Prepare(segments, ArrivalMode::kFree);
  }
}

void PlanAttempt::Prepare(int segments, ArrivalMode arrival) {
  Prepared& prepared = prepared_[{segments, arrival}];
  prepared.problem = std::make_unique<LandingProblem>(segments, ProblemOptions(options_, arrival));
  prepared.backend = solvers::MakeBackend(backends_, options_.backend);
  for (const auto& [name, value] : options_.solver_options) {
    prepared.backend->options().Set(name, value);
  }
  prepared.backend->Prepare(prepared.problem->view());
}

ReplanReason PlanAttempt::Run(const AttemptRequest& request, ReplanResult* result) {
  const ReplanReason reason = Try(request, result);
  if (request.log) {
    request.log->duration = request.duration;
    request.log->arrival = request.arrival;
    request.log->segments = SegmentsFor(request.duration);
    request.log->reason = reason;
  }
  return reason;
}

ReplanReason PlanAttempt::Try(const AttemptRequest& request, ReplanResult* result) {
  Prepared& prepared = prepared_.at({SegmentsFor(request.duration), request.arrival});
  LandingProblem& problem = *prepared.problem;
  problem.SetBoundary(request.start, request.t0, *request.pad, request.target);
  problem.SetDuration(request.duration);
  problem.SetPrevious(request.previous);
  const bool hard = options_.problem.limits_mode == LimitsMode::kHard;
  if (hard && problem.boundary_facts().end_too_fast) return ReplanReason::kEndTooFast;
  pairs_.clear();
  expansions_left_ = options_.max_expansions;
  previous_clear_ = request.previous &&
                    !std::isfinite(FirstBlockedTime(*request.previous, request.t0, *request.space));
  Eigen::VectorXd y = problem.Guess();
  solvers::Stop stop;
  stop.max_iterations = options_.max_iterations;
  stop.trace = request.log != nullptr;
  double pressure = 1.0;

  for (int round = 0;; ++round) {
    problem.SetPairs(pairs_);
    problem.SetPairWeightScale(pressure);
    {
      StageTimer timer(&result->times.solve);
      prepared.backend->Solve(problem.view(), y, stop, &result->solver);
    }
    ++result->solves;
    if (round > 0) ++result->rebinds;
    if (request.log) request.log->rounds.push_back({pressure, pairs_, result->solver, {}, {}});
    if (!result->solver.usable()) return ReplanReason::kSolverFailed;
    y = result->solver.x;
    result->curve = problem.Curve(y);
    {
      StageTimer timer(&result->times.check);
      FindBlockedRuns(result->curve, request.t0, *request.space, &runs_);
    }
    if (request.log) {
      request.log->rounds.back().curve = result->curve;
      request.log->rounds.back().blocked = runs_;
    }
    // A blocked start alone is for the certificate: it may be an escape.
    const bool only_start = runs_.size() == 1 && runs_.front().at_start && round > 0;
    if (runs_.empty() || only_start || round == options_.max_rebinds) break;
    const ReplanReason reason =
        Bind(request, result->curve, static_cast<std::size_t>(problem.max_pairs()), result);
    if (reason != ReplanReason::kNone) return reason;
    if (round > 0) pressure *= kPressure;
  }
  result->pairs = static_cast<int>(pairs_.size());

  StageTimer timer(&result->times.certificate);
  const SplineState wanted = EndStateAt(*request.pad, request.target, result->curve.t_end()).state;
  result->certificate = Certify(result->curve, request.t0, &request.start, &wanted, options_.limits,
                                options_.reaction, *request.space);
  if (options_.problem.endpoint == EndpointMode::kExplicit) {
    result->certificate.endpoint_tolerance = kRowTolerance;
  }
  if (request.log) request.log->certificate = result->certificate;
  // The certificate does not know every row: tilt, thrust and a user's own are the solver's word.
  const bool rows_kept = result->solver.max_violation <= kRowTolerance;
  if (result->certificate.passed() && rows_kept) return ReplanReason::kNone;
  if (!result->certificate.clear && !result->certificate.escaping) {
    return runs_.front().at_start ? ReplanReason::kStartBlocked : ReplanReason::kCollisionRemains;
  }
  if (!result->certificate.start_met() || !result->certificate.endpoint_met()) {
    return ReplanReason::kSolverFailed;
  }
  return result->certificate.limits_kept && rows_kept ? ReplanReason::kUnobserved
                                                      : ReplanReason::kLimitsExceeded;
}

ReplanReason PlanAttempt::Bind(const AttemptRequest& request, const UniformBspline& curve,
                               std::size_t max_pairs, ReplanResult* result) {
  int bound = 0;
  for (const BlockedRun& run : runs_) {
    if (run.at_end) return ReplanReason::kGoalBlocked;
    GuidePath guide;
    const ReplanReason reason = FindGuide(request, curve, run, &guide, result);
    if (reason != ReplanReason::kNone) return reason;
    StageTimer timer(&result->times.pairs);
    bound += BindPairs(curve, run, guide, *request.space, max_pairs, &pairs_);
  }
  // Without a new pair the next solve would be the last one again.
  return bound > 0 ? ReplanReason::kNone : ReplanReason::kCollisionRemains;
}

ReplanReason PlanAttempt::FindGuide(const AttemptRequest& request, const UniformBspline& curve,
                                    const BlockedRun& run, GuidePath* guide, ReplanResult* result) {
  StageTimer timer(&result->times.search);
  if (!run.at_start && previous_clear_ && request.previous->t_end() > run.t_out) {
    SampleGuide(*request.previous, request.t0, guide);
    return ReplanReason::kNone;
  }
  const SearchStatus status =
      search_.Search(*request.space, curve.Evaluate(run.t_in).p_WB, curve.Evaluate(run.t_out).p_WB,
                     expansions_left_, guide);
  expansions_left_ = std::max(1, expansions_left_ - search_.expansions());
  // A* moves a blocked start to the nearest free cell: a start in the inflated zone is led out.
  if (run.at_start && status == SearchStatus::kEndsBlocked) return ReplanReason::kStartBlocked;
  if (status != SearchStatus::kFound) return ReplanReason::kSearchFailed;
  result->guide_paths.push_back(*guide);
  return ReplanReason::kNone;
}

}  // namespace touchdown::planning
