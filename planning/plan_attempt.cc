// SPDX-License-Identifier: BSD-3-Clause
// One attempt at a plan: solve without obstacles, then check / bind / solve until the whole curve
// is clear. Pairs start empty at every attempt, so that none outlives the obstacle it was made for;
// the side of an obstacle is kept by taking the committed curve, while it is clear, as the guide
// path, and only else a new A* path.

#include "touchdown/planning/plan_attempt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "touchdown/planning/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kSegmentDuration = 0.20;  // [s], aimed at
constexpr int kFewestSegments = 12;
constexpr int kMostSegments = PlanAttempt::kMostControlPoints - 3;
constexpr int kSegmentStep = 4;         // keeps the number of prepared problems small
constexpr double kPressure = 1.6;       // weight of the pairs grows by this every round
constexpr double kRowTolerance = 2e-6;  // what backends leave of the equality rows, as a norm
constexpr double kGuideStep = 0.05;     // sampling of the committed curve as a guide [s]
constexpr double kMuchCheaper = 0.8;    // share of the cost that makes a change of side worth while
constexpr double kStill = 1e-3;         // a slower curve has no direction [m/s]
constexpr double kNoSide = 1e-2;        // from the curve to the guide [m]
/// A way that is found only after so many cells is a long one.
constexpr int kOtherWayExpansions = 3000;

int SegmentsFor(double duration) {
  const int wanted = static_cast<int>(std::ceil(duration / kSegmentDuration));
  const int rounded = (wanted + kSegmentStep - 1) / kSegmentStep * kSegmentStep;
  return std::clamp(rounded, kFewestSegments, kMostSegments);
}

/// Without what the pairs themselves cost: their weight grows from round to round.
double CostOfShape(const solvers::SolverSummary& solver) {
  double cost = solver.cost;
  for (const solvers::TermCost& term : solver.cost_by_term) {
    if (term.name == "obstacle_pair") cost -= term.cost;
  }
  return cost;
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
    PrepareProblem(segments, ArrivalMode::kFixed);
    if (options.arrival == ArrivalMode::kFree) PrepareProblem(segments, ArrivalMode::kFree);
  }
  for (UniformBspline* curve : {&first_curve_, &best_.curve, &other_.curve}) {
    curve->Reserve(kMostControlPoints);
  }
}

void PlanAttempt::PrepareProblem(int segments, ArrivalMode arrival) {
  Prepared& prepared = prepared_[{segments, arrival}];
  prepared.problem = std::make_unique<LandingProblem>(segments, ProblemOptions(options_, arrival));
  prepared.backend = solvers::MakeBackend(backends_, options_.backend);
  for (const auto& [name, value] : options_.solver_options) {
    prepared.backend->options().Set(name, value);
  }
  prepared.backend->Prepare(prepared.problem->view());
  prepared.start.y.resize(prepared.problem->view().num_variables());
  prepared.solver.x = prepared.y_without_pairs = prepared.start.y;
}

bool PlanAttempt::Better(const Candidate& a, const Candidate& b, bool keeps_side) {
  if (a.reason != ReplanReason::kNone) return false;
  if (b.reason != ReplanReason::kNone) return true;
  const double share = keeps_side ? kMuchCheaper : 1.0;
  return CostOfShape(a.solver) < share * CostOfShape(b.solver);
}

ReplanReason PlanAttempt::Run(const AttemptRequest& request, ReplanResult* result) {
  best_.certificate.reset();
  best_.solved = false;
  best_.pairs = 0;
  best_.round = -1;
  best_.reason = Try(request, result);
  if (best_.solved) {
    result->curve = best_.curve;
    result->solver = best_.solver;
  }
  result->certificate = best_.certificate.value_or(Certificate());
  result->pairs = best_.pairs;
  if (request.log) {
    request.log->duration = request.duration;
    request.log->arrival = request.arrival;
    request.log->segments = SegmentsFor(request.duration);
    request.log->best = best_.round;
    request.log->certificate = best_.certificate;
    request.log->reason = best_.reason;
  }
  return best_.reason;
}

ReplanReason PlanAttempt::Try(const AttemptRequest& request, ReplanResult* result) {
  now_ = &prepared_.at({SegmentsFor(request.duration), request.arrival});
  LandingProblem& problem = *now_->problem;
  problem.SetBoundary(request.start, request.t0, *request.pad, request.target);
  problem.SetDuration(request.duration);
  problem.SetPrevious(request.previous);
  const bool hard = options_.problem.limits_mode == LimitsMode::kHard;
  if (hard && problem.boundary_facts().end_too_fast) return ReplanReason::kEndTooFast;
  expansions_left_ = options_.max_expansions;
  pairs_.clear();
  barriers_.clear();
  problem.Guess(&now_->start.y);
  const ReplanReason reason = SolveAndCheck(request, 1.0, &best_, result);
  if (reason != ReplanReason::kNone) return reason;
  if (runs_.empty() || options_.max_rebinds == 0) return Finish(request, &best_, result);
  return TryGuides(request, result);
}

// The way around the first obstacle makes the difference: behind it the usual choices follow.
ReplanReason PlanAttempt::TryGuides(const AttemptRequest& request, ReplanResult* result) {
  now_->y_without_pairs = now_->start.y;
  first_curve_ = best_.curve;
  first_runs_ = runs_;
  const BlockedRun run = first_runs_.front();
  if (run.at_end) return ReplanReason::kGoalBlocked;
  {
    StageTimer timer(&result->times.check);
    previous_clear_ = request.previous && !std::isfinite(FirstBlockedTime(
                                              *request.previous, request.t0, *request.space));
  }
  const bool keeps_side = Keeps(request, run);
  const int guides = run.at_start ? 1 : options_.max_guides;
  for (int i = 0; i < guides; ++i) {
    const ReplanReason found = FindGuide(request, first_curve_, run, &guide_, result);
    if (i > 0 && found != ReplanReason::kNone) break;  // there is no other way
    if (found != ReplanReason::kNone) return found;
    Candidate* candidate = i == 0 ? &best_ : &other_;
    candidate->curve = first_curve_;
    candidate->certificate.reset();
    now_->start.y = now_->y_without_pairs;
    runs_ = first_runs_;
    first_guide_ = guide_;
    candidate->reason = Follow(request, candidate, result);
    if (i > 0 && Better(other_, best_, keeps_side)) std::swap(best_, other_);
    if (i + 1 < guides && !CloseWay(run)) break;
  }
  return best_.reason;
}

/// Binds pairs to the guide and solves again until the curve is clear.
ReplanReason PlanAttempt::Follow(const AttemptRequest& request, Candidate* candidate,
                                 ReplanResult* result) {
  pairs_.clear();
  double pressure = 1.0;
  for (int round = 1;; ++round) {
    const ReplanReason bound = Bind(request, candidate->curve, round == 1, result);
    if (bound != ReplanReason::kNone) return bound;
    if (round > 1) pressure *= kPressure;
    ++result->rebinds;
    const ReplanReason solved = SolveAndCheck(request, pressure, candidate, result);
    if (solved != ReplanReason::kNone) return solved;
    // A blocked start alone is for the certificate: it may be an escape.
    const bool only_start = runs_.size() == 1 && runs_.front().at_start;
    if (runs_.empty() || only_start || round == options_.max_rebinds) {
      return Finish(request, candidate, result);
    }
  }
}

ReplanReason PlanAttempt::SolveAndCheck(const AttemptRequest& request, double pressure,
                                        Candidate* candidate, ReplanResult* result) {
  LandingProblem& problem = *now_->problem;
  problem.SetPairs(pairs_);
  problem.SetPairWeightScale(pressure);
  solvers::Stop stop;
  stop.max_iterations = options_.max_iterations;
  stop.trace = request.log != nullptr;
  {
    StageTimer timer(&result->times.solve);
    now_->backend->Solve(problem.view(), now_->start, stop, &now_->solver);
  }
  ++result->solves;
  candidate->solver = now_->solver;
  candidate->pairs = static_cast<int>(pairs_.size());
  if (request.log) {
    const int guide = static_cast<int>(barriers_.size());
    candidate->round = static_cast<int>(request.log->rounds.size());
    request.log->rounds.push_back({pressure, pairs_, now_->solver, {}, {}, guide});
  }
  if (!now_->solver.usable()) return ReplanReason::kSolverFailed;
  now_->start.y = now_->solver.x;
  problem.Curve(now_->start.y, &candidate->curve);
  candidate->solved = true;
  {
    StageTimer timer(&result->times.check);
    FindBlockedRuns(candidate->curve, request.t0, *request.space, &runs_);
  }
  if (request.log) {
    request.log->rounds.back().curve = candidate->curve;
    request.log->rounds.back().blocked = runs_;
  }
  return ReplanReason::kNone;
}

/// Certifies a candidate that has been solved for the last time.
ReplanReason PlanAttempt::Finish(const AttemptRequest& request, Candidate* candidate,
                                 ReplanResult* result) {
  StageTimer timer(&result->times.certificate);
  const UniformBspline& curve = candidate->curve;
  const SplineState wanted = EndStateAt(*request.pad, request.target, curve.t_end()).state;
  Certificate& certificate =
      candidate->certificate.emplace(Certify(curve, request.t0, &request.start, &wanted,
                                             options_.limits, options_.reaction, *request.space));
  if (options_.problem.endpoint == EndpointMode::kExplicit) {
    certificate.endpoint_tolerance = kRowTolerance;
  }
  // The certificate does not know every row: tilt, thrust and a user's own are the solver's word.
  const bool rows_kept = candidate->solver.max_violation <= kRowTolerance;
  if (certificate.passed() && rows_kept) return ReplanReason::kNone;
  if (!certificate.clear && !certificate.escaping) {
    return runs_.front().at_start ? ReplanReason::kStartBlocked : ReplanReason::kCollisionRemains;
  }
  if (!certificate.start_met() || !certificate.endpoint_met()) return ReplanReason::kSolverFailed;
  return certificate.limits_kept && rows_kept ? ReplanReason::kUnobserved
                                              : ReplanReason::kLimitsExceeded;
}

ReplanReason PlanAttempt::Bind(const AttemptRequest& request, const UniformBspline& curve,
                               bool first_is_known, ReplanResult* result) {
  const auto max_pairs = static_cast<std::size_t>(now_->problem->max_pairs());
  int bound = 0;
  for (const BlockedRun& run : runs_) {
    if (run.at_end) return ReplanReason::kGoalBlocked;
    const bool known = first_is_known && &run == &runs_.front();
    if (!known) {
      const ReplanReason reason = FindGuide(request, curve, run, &guide_, result);
      if (reason != ReplanReason::kNone) return reason;
    }
    StageTimer timer(&result->times.pairs);
    bound +=
        BindPairs(curve, run, known ? first_guide_ : guide_, *request.space, max_pairs, &pairs_);
  }
  // Without a new pair the next solve would be the last one again.
  return bound > 0 ? ReplanReason::kNone : ReplanReason::kCollisionRemains;
}

/// The committed curve leads past this stretch, and no way was closed yet.
bool PlanAttempt::Keeps(const AttemptRequest& request, const BlockedRun& run) const {
  return barriers_.empty() && !run.at_start && previous_clear_ &&
         request.previous->t_end() > run.t_out;
}

ReplanReason PlanAttempt::FindGuide(const AttemptRequest& request, const UniformBspline& curve,
                                    const BlockedRun& run, GuidePath* guide, ReplanResult* result) {
  StageTimer timer(&result->times.search);
  if (Keeps(request, run)) {
    SampleGuide(*request.previous, request.t0, guide);
    return ReplanReason::kNone;
  }
  const int budget =
      barriers_.empty() ? expansions_left_ : std::min(expansions_left_, kOtherWayExpansions);
  const SearchStatus status =
      search_.Search(*request.space, curve.Evaluate(run.t_in).p_WB, curve.Evaluate(run.t_out).p_WB,
                     budget, guide, barriers_);
  expansions_left_ = std::max(1, expansions_left_ - search_.expansions());
  // A* moves a blocked start to the nearest free cell: a start in the inflated zone is led out.
  if (run.at_start && status == SearchStatus::kEndsBlocked) return ReplanReason::kStartBlocked;
  if (status != SearchStatus::kFound) return ReplanReason::kSearchFailed;
  result->guide_paths.Add(*guide);
  return ReplanReason::kNone;
}

/// Closes the way that first_guide_ takes around the obstacle in the middle of the run, so that the
/// next search finds another. False if it passes too near to tell a side.
bool PlanAttempt::CloseWay(const BlockedRun& run) {
  const FlatState at = first_curve_.Evaluate(0.5 * (run.t_in + run.t_out));
  Barrier barrier;
  barrier.p = at.p_WB;
  barrier.normal = at.v_WB.norm() > kStill ? at.v_WB : first_guide_.back() - first_guide_.front();
  barrier.normal.normalize();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : first_guide_) {
    const Eigen::Vector3d offset = p - at.p_WB;
    const double along = offset.dot(barrier.normal);
    if (std::abs(along) >= nearest) continue;
    nearest = std::abs(along);
    barrier.side = offset - along * barrier.normal;
  }
  if (!(barrier.side.norm() > kNoSide) || !barrier.normal.allFinite()) return false;
  barrier.side.normalize();
  barriers_.push_back(barrier);
  return true;
}

}  // namespace touchdown::planning
