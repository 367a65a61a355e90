// SPDX-License-Identifier: BSD-3-Clause
// One attempt at a plan: solve without obstacles, then find a guide past what is in the way, bind the
// control points to free space along it, solve and check, until the whole curve is clear. Pairs start
// empty at every attempt, so that none outlives the obstacle it was made for; the side of an obstacle is
// kept by taking the committed curve as the guide, and only where it knows no way a new A* path.

#include "touchdown/planning/plan_attempt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "touchdown/planning/pad_strip.h"
#include "touchdown/planning/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kNear = 1.5;           // segments until an obstacle
constexpr double kPressure = 2.5;       // weight of the pairs grows by this every round
constexpr double kProgress = 0.5;       // of the blocked time that a round leaves at most
constexpr double kLimitPressure = 6.0;  // weight of limits that are exceeded grows by this, ...
constexpr double kFarBeyond = 1.06;     // by its square beyond this share of a limit
constexpr int kLimitRounds = 2;
constexpr double kRowTolerance = 2e-6;  // what backends leave of the equality rows, as a norm
constexpr double kLongerWay = 1.05;     // than the first way around: another is not followed then
constexpr double kLatestKept = 1.06;    // of the time left: what arrives later is not kept
constexpr double kMuchCheaper = 0.8;    // share of the cost that makes a change of side worth while

/// Of the limits, the largest that a plan uses; that of a recovery is not told.
double ShareOfLimits(const Certificate& certificate, const Limits& limits) {
  if (certificate.recovering) return 1.0;
  return std::max(certificate.speed_bound / limits.speed,
                  certificate.acceleration_bound / limits.acceleration);
}

double LengthOf(const UniformBspline& curve, double from, double to) {
  constexpr int kChords = 24;
  double length = 0.0;
  Eigen::Vector3d last = curve.Position(from);
  for (int i = 1; i <= kChords; ++i) {
    const Eigen::Vector3d p = curve.Position(from + i * (to - from) / kChords);
    length += (p - last).norm();
    last = p;
  }
  return length;
}

}  // namespace

PlanAttempt::PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends)
    : options_(options),
      problems_(options, backends),
      finder_(options.vertical_cost),
      binder_(options.problem) {
  for (const TermEntry& entry : options.problem.terms) {
    if (entry.is_clearance || entry.is_limit) pressed_.push_back(entry.info.name);
  }
  // Room for all that usually comes.
  for (Candidate* candidate : {&best_, &other_}) candidate->bound.reserve(kMostControlPoints);
  for (GuidePath* guide : {&first_guide_, &guide_}) guide->reserve(1024);
  pairs_.reserve(static_cast<std::size_t>(options.problem.max_pairs_per_point) *
                 kMostControlPoints);
  runs_.reserve(64);
  for (UniformBspline* curve : {&first_curve_, &best_.pair.curve, &best_.pair.stop,
                                &other_.pair.curve, &other_.pair.stop}) {
    curve->Reserve(kMostControlPoints);
  }
}

/// Without the terms whose weights grow from round to round.
double PlanAttempt::CostOfShape(const solvers::SolverSummary& solver) const {
  double cost = 0.0;
  for (const solvers::TermCost& term : solver.cost_by_term) {
    if (std::find(pressed_.begin(), pressed_.end(), term.name) == pressed_.end()) cost += term.cost;
  }
  return cost;
}

bool PlanAttempt::Better(const Candidate& a, const Candidate& b, bool keeps_side) const {
  if (a.reason != ReplanReason::kNone) return false;
  if (b.reason != ReplanReason::kNone) return true;
  const double share = keeps_side ? kMuchCheaper : 1.0;
  return CostOfShape(a.solver) < share * CostOfShape(b.solver);
}

ReplanReason PlanAttempt::Run(const AttemptRequest& request, ReplanResult* result) {
  Clear(&best_);
  best_.reason = Try(request, result);
  if (request.arrival == ArrivalMode::kFree && best_.solved)
    duration_ = best_.pair.curve.duration();
  if (best_.solved) {
    result->pair() = best_.pair;
    result->solver = best_.solver;
  }
  result->certificate = best_.certificate.value_or(Certificate());
  result->pairs = best_.pairs;
  result->bound = best_.bound;
  if (request.log) {
    request.log->duration = duration_;
    request.log->arrival = request.arrival;
    request.log->segments = segments_;
    request.log->best = best_.round;
    request.log->certificate = best_.certificate;
    request.log->reason = best_.reason;
  }
  return best_.reason;
}

void PlanAttempt::Clear(Candidate* candidate) const {
  candidate->certificate.reset();
  candidate->solved = false;
  candidate->pairs = 0;
  candidate->bound.clear();
  candidate->round = -1;
}

/// Refuses ends that no plan can have.
ReplanReason PlanAttempt::SetEnds(const AttemptRequest& request) {
  now_ = &problems_.At(segments_, request.arrival);
  LandingProblem& problem = *now_->problem;
  problem.SetBoundary(request.start, request.t0, *request.pad, request.target, request.pull_W);
  problem.SetDuration(request.duration);
  duration_ = request.duration;
  problem.SetPrevious(request.previous);
  const bool hard = options_.problem.limits_mode == LimitsMode::kHard;
  if (hard && problem.boundary_facts().end_too_fast) return ReplanReason::kEndTooFast;
  const double t_end = request.t0 + request.duration;
  const bool fixed = request.arrival == ArrivalMode::kFixed;
  if (fixed && request.space->Blocked(EndStateAt(*request.pad, request.target, t_end).state.p)) {
    return ReplanReason::kGoalBlocked;
  }
  return ReplanReason::kNone;
}

ReplanReason PlanAttempt::SolveWithoutPairs(const AttemptRequest& request,
                                            const UniformBspline* guess, ReplanResult* result) {
  const ReplanReason refused = SetEnds(request);
  if (refused != ReplanReason::kNone) return refused;
  LandingProblem& problem = *now_->problem;
  if (guess) {
    problem.WarmGuess(*guess, &now_->start.y);
  } else {
    problem.Guess(&now_->start.y);
  }
  now_->first_guess = now_->start.y;
  return SolveAndCheck(request, &best_, result);
}

/// So near that the first control point that is free comes too late to pass it.
bool PlanAttempt::ObstacleNear(const AttemptRequest& request) const {
  if (runs_.empty() || runs_.front().at_start) return false;
  return runs_.front().t_in - request.t0 < kNear * best_.pair.curve.interval();
}

/// The curve on shorter segments, before it is led past what is in its way. Where the arrival is fixed its
/// optimum there is cheap, and a better start. Where it is free the solve would cost more than the rounds
/// after it gain: there the curve is only interpolated, to within millimetres, so that the blocked runs
/// stand. If no round can be solved then, the next attempt fixes the arrival.
ReplanReason PlanAttempt::Refine(const AttemptRequest& request, ReplanResult* result) {
  first_curve_ = best_.pair.curve;
  segments_ = request.near_segments;
  const bool interpolates = request.arrival == ArrivalMode::kFree && options_.max_rebinds > 0 &&
                            options_.problem.endpoint == EndpointMode::kEliminated;
  if (!interpolates) {
    const ReplanReason reason = SolveWithoutPairs(request, &first_curve_, result);
    if (reason != ReplanReason::kSolverFailed) return reason;
    segments_ = request.segments;  // the coarse ones will have to do
    return SolveWithoutPairs(request, &first_curve_, result);
  }
  SetEnds(request);  // refused by the coarse problem, if at all
  LandingProblem& problem = *now_->problem;
  problem.SetDuration(first_curve_.duration());
  problem.WarmGuess(first_curve_, &now_->start.y);
  now_->first_guess = now_->start.y;
  problem.Curve(now_->start.y, &best_.pair.curve);
  return ReplanReason::kNone;
}

ReplanReason PlanAttempt::Try(const AttemptRequest& request, ReplanResult* result) {
  finder_.Begin(request.at_rest);
  // Shortly before contact there is no time for a way around.
  const bool leads_around = options_.max_rebinds > 0 && request.pair_end != PairEnd::kContact;
  const UniformBspline* warm = options_.warm_start ? request.previous : nullptr;
  if (warm && leads_around && !request.looks) {
    const ReplanReason reason = KeepCommitted(request, result);
    if (reason == ReplanReason::kNone || reason == ReplanReason::kUnobserved) return reason;
    Clear(&best_);
  }
  pairs_.clear();
  pressure_ = {};
  segments_ = request.segments;
  ReplanReason reason = SolveWithoutPairs(request, warm, result);
  if (reason == ReplanReason::kNone && ObstacleNear(request) && segments_ < request.near_segments) {
    reason = Refine(request, result);
  }
  if (reason != ReplanReason::kNone) return reason;
  if (!runs_.empty() && leads_around) return TryGuides(request, result);
  return KeepLimits(request, &best_, result);
}

/// The committed plan is the best that is known: its rest, bound as it was, but to the map of now, takes one
/// solve while it holds. What has come to block it leads to further rounds.
ReplanReason PlanAttempt::KeepCommitted(const AttemptRequest& request, ReplanResult* result) {
  segments_ = request.segments;
  const ReplanReason refused = SetEnds(request);
  if (refused != ReplanReason::kNone) return refused;
  {
    StageTimer timer(&result->times.search, StageTimer::kWhileLogged);
    finder_.Keep(*request.previous, request.t0, *request.space);
  }
  LandingProblem& problem = *now_->problem;
  problem.WarmGuess(*request.previous, &now_->start.y);
  problem.Curve(now_->start.y, &best_.pair.curve);
  runs_.clear();
  if (!finder_.KeepsClear()) {
    StageTimer timer(&result->times.check, StageTimer::kWhileLogged);
    FindBlockedRuns(best_.pair.curve, request.t0, *request.space, &runs_);
  }
  return Follow(request, Lead::kCommitted, &best_, result);
}

// The way around the first obstacle makes the difference: behind it the usual choices follow.
ReplanReason PlanAttempt::TryGuides(const AttemptRequest& asked, ReplanResult* result) {
  AttemptRequest request = asked;
  if (!request.previous) now_->first_guess = now_->start.y;
  first_curve_ = best_.pair.curve;
  const BlockedRun first = runs_.front();
  if (runs_.back().at_end) return ReplanReason::kGoalBlocked;
  if (request.previous && request.previous->t_end() > request.t0) {
    StageTimer timer(&result->times.search, StageTimer::kWhileLogged);
    finder_.Keep(*request.previous, request.t0, *request.space);
  }
  // One path past everything that is in the way, so that one detour does not lead into the next.
  BlockedRun span = {first.t_in, runs_.back().t_out, first.at_start, false};
  const bool keeps_side = finder_.Keeps(span);
  if (keeps_side) finder_.EndBesideKept(*request.space, first_curve_, &span);
  const int guides = first.at_start ? 1 : std::max(options_.max_guides, request.rescue_guides);
  double shortest = 0.0;
  for (int i = 0; i < guides; ++i) {
    if (i >= options_.max_guides && best_.reason == ReplanReason::kNone) break;
    const ReplanReason found = FindGuide(request, first_curve_, /*local=*/false, &span, result);
    if (i > 0 && found != ReplanReason::kNone) break;  // there is no other way
    if (found != ReplanReason::kNone) return found;
    // Of two ways the longer one is hardly ever the cheaper: its length tells before it is solved for.
    const double length = PathLength(guide_);
    if (i == 0) shortest = length;
    if (best_.reason == ReplanReason::kNone && length > kLongerWay * shortest) break;
    if (i == 0 && !request.previous) Postpone(span, &request);
    first_guide_ = guide_;
    Candidate* candidate = i == 0 ? &best_ : &other_;
    candidate->pair.curve = first_curve_;
    candidate->certificate.reset();
    now_->start.y = now_->first_guess;
    runs_.assign(1, span);
    candidate->reason = Follow(request, Lead::kGuide, candidate, result);
    if (i > 0 && Better(other_, best_, keeps_side)) std::swap(best_, other_);
    if (i + 1 == guides) break;
    const FlatState through = first_curve_.Evaluate(0.5 * (first.t_in + first.t_out));
    const std::optional<Barrier> barrier = CloseWay(first_guide_, through);
    if (!barrier) break;
    finder_.Close(*barrier);
  }
  return best_.reason;
}

/// The way round takes longer than the straight one, by as much as it is longer at full speed. An arrival
/// that others reckon with already is not put off like that.
void PlanAttempt::Postpone(const BlockedRun& span, AttemptRequest* request) {
  if (request->arrival == ArrivalMode::kFree) return;
  const double longer = PathLength(guide_) - LengthOf(first_curve_, span.t_in, span.t_out);
  AttemptRequest later = *request;
  later.duration = std::min(request->duration + std::max(0.0, longer) / request->limits.speed,
                            options_.max_duration);
  if (later.duration <= request->duration) return;
  later_space_ = *request->space;
  later.space = &later_space_;
  LayPadStrip(*request->pad, request->target, request->start.p, request->t0,
              request->t0 + later.duration, later_space_.pad_radius, options_.contact_height,
              &later_space_);
  if (SetEnds(later) == ReplanReason::kNone) {
    *request = later;
    now_->problem->WarmGuess(first_curve_, &now_->first_guess);
  } else {
    SetEnds(*request);
  }
}

/// Binds pairs along the guide and solves again until the curve is clear, or hardly clearer than before. In
/// the first round they lead along the guide, or are those of the committed plan; later ones bind what is still
/// blocked. What is kept may not arrive much later than was promised.
ReplanReason PlanAttempt::Follow(const AttemptRequest& request, Lead lead, Candidate* candidate,
                                 ReplanResult* result) {
  const double latest =
      lead == Lead::kCommitted
          ? kLatestKept * std::max(request.duration, request.previous->t_end() - request.t0)
          : std::numeric_limits<double>::infinity();
  binder_.Begin(candidate->pair.curve.segments() + 3);
  pressure_ = {};
  double blocked = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= options_.max_rebinds; ++round) {
    ReplanReason reason = Bind(request, candidate->pair.curve,
                               round == 1 ? std::optional(lead) : std::nullopt, result);
    if (reason != ReplanReason::kNone) return reason;
    if (round > 1) pressure_.pairs *= kPressure;
    ++result->rebinds;
    reason = SolveAndCheck(request, candidate, result);
    if (reason != ReplanReason::kNone) return reason;
    if (candidate->pair.curve.duration() > latest) return ReplanReason::kCollisionRemains;
    // A blocked start alone is for the certificate: it may be an escape.
    const bool only_start = runs_.size() == 1 && runs_.front().at_start;
    if (runs_.empty() || only_start) {
      reason = KeepLimits(request, candidate, result);
      if (runs_.empty() || only_start) return reason;
    }
    const double before = std::exchange(blocked, BlockedTime());
    if (blocked > kProgress * before) break;
  }
  return Finish(request, candidate, result);
}

/// Of the latest curve [s].
double PlanAttempt::BlockedTime() const {
  double sum = 0.0;
  for (const BlockedRun& run : runs_) sum += run.t_out - run.t_in;
  return sum;
}

/// Certifies a clear candidate; where only limits are exceeded, presses these harder and solves
/// again.
ReplanReason PlanAttempt::KeepLimits(const AttemptRequest& request, Candidate* candidate,
                                     ReplanResult* result) {
  for (int round = 0;; ++round) {
    const ReplanReason reason = Finish(request, candidate, result);
    const bool soft = options_.problem.limits_mode == LimitsMode::kSoft;
    if (reason != ReplanReason::kLimitsExceeded || !soft || round == kLimitRounds) return reason;
    const double share = ShareOfLimits(*candidate->certificate, request.limits);
    pressure_.limits *= share > kFarBeyond ? kLimitPressure * kLimitPressure : kLimitPressure;
    // The last curve stands where the solver fails under the pressure.
    if (SolveAndCheck(request, candidate, result) != ReplanReason::kNone) return reason;
  }
}

ReplanReason PlanAttempt::SolveAndCheck(const AttemptRequest& request, Candidate* candidate,
                                        ReplanResult* result) {
  LandingProblem& problem = *now_->problem;
  problem.SetPairs(pairs_);
  problem.SetPairWeightScale(pressure_.pairs);
  problem.SetLimitWeightScale(pressure_.limits);
  solvers::Stop stop;
  stop.max_iterations = options_.max_iterations;
  stop.confirm = false;  // the certificate judges the plan
  stop.trace = request.log != nullptr;
  {
    StageTimer timer(&result->times.solve, StageTimer::kWhileLogged);
    now_->backend->Solve(problem.view(), now_->start, stop, &now_->solver);
  }
  ++result->solves;
  candidate->solver = now_->solver;
  candidate->pairs = static_cast<int>(pairs_.size());
  candidate->bound.clear();
  if (request.log) {
    const int guide = finder_.ways_closed();
    candidate->round = static_cast<int>(request.log->rounds.size());
    request.log->rounds.push_back(
        {pressure_.pairs, pressure_.limits, pairs_, now_->solver, {}, {}, guide});
  }
  if (!now_->solver.usable()) return ReplanReason::kSolverFailed;
  now_->start.y = now_->solver.x;
  problem.Curve(now_->start.y, &candidate->pair.curve);
  if (!pairs_.empty()) binder_.Remember(candidate->pair.curve, &candidate->bound);
  candidate->solved = true;
  {
    StageTimer timer(&result->times.check, StageTimer::kWhileLogged);
    FindBlockedRuns(candidate->pair.curve, request.t0, *request.space, &runs_);
  }
  if (request.log) {
    request.log->rounds.back().curve = candidate->pair.curve;
    request.log->rounds.back().blocked = runs_;
  }
  return ReplanReason::kNone;
}

/// Certifies a candidate that has been solved for the last time.
ReplanReason PlanAttempt::Finish(const AttemptRequest& request, Candidate* candidate,
                                 ReplanResult* result) {
  StageTimer timer(&result->times.certificate, StageTimer::kWhileLogged);
  const UniformBspline& curve = candidate->pair.curve;
  const SplineState wanted = EndStateAt(*request.pad, request.target, curve.t_end()).state;
  Certificate& certificate = candidate->certificate.emplace(
      Certify(curve, request.t0, &request.start, &wanted, request.limits, *request.space));
  if (certificate.limits_kept && (certificate.clear || certificate.escaping)) {
    const PairProof proof = ProvePair(request.t0, request.t0 + options_.reaction, request.pair_end,
                                      request.limits, *request.hull, &candidate->pair);
    Enter(proof, &certificate);
    if (!proof.proven && !result->unseen_W) result->unseen_W = proof.unseen_W;
  }
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

/// In the first round guide_ is the way past all that is in the way, or the committed plan's parts are bound again.
/// What is blocked otherwise gets guides of its own: corners that the curve cuts.
ReplanReason PlanAttempt::Bind(const AttemptRequest& request, const UniformBspline& curve,
                               std::optional<Lead> lead, ReplanResult* result) {
  binder_.Start(curve);
  if (lead == Lead::kCommitted) binder_.Recall(curve, *request.bound);
  for (BlockedRun& run : runs_) {
    if (run.at_end) return ReplanReason::kGoalBlocked;
    if (lead != Lead::kGuide) {
      const ReplanReason reason =
          FindGuide(request, curve, /*local=*/!request.at_rest, &run, result);
      // A corner that cannot be looked past is one that a slower plan may not cut.
      if (reason == ReplanReason::kSearchFailed) return ReplanReason::kCollisionRemains;
      if (reason != ReplanReason::kNone) return reason;
      binder_.AddCorner(curve, run, guide_, *request.space);
    }
    binder_.Follow(curve, run, guide_, *request.space);
  }
  StageTimer timer(&result->times.pairs, StageTimer::kWhileLogged);
  binder_.Bind(*request.space, &pairs_);
  return ReplanReason::kNone;
}

ReplanReason PlanAttempt::FindGuide(const AttemptRequest& request, const UniformBspline& curve,
                                    bool local, BlockedRun* run, ReplanResult* result) {
  StageTimer timer(&result->times.search, StageTimer::kWhileLogged);
  const bool searches = !finder_.Keeps(*run);
  const SearchStatus status = finder_.Find(*request.space, curve, local, run, &guide_);
  // A* moves a blocked start to the nearest free cell: a start in the inflated zone is led out.
  if (run->at_start && status == SearchStatus::kEndsBlocked) return ReplanReason::kStartBlocked;
  if (status == SearchStatus::kFound && searches) result->guide_paths.Add(guide_);
  const bool led = status == SearchStatus::kFound || status == SearchStatus::kEndsOutside;
  return led ? ReplanReason::kNone : ReplanReason::kSearchFailed;
}

}  // namespace touchdown::planning
