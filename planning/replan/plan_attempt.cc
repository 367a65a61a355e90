// SPDX-License-Identifier: BSD-3-Clause
// One attempt at a plan, top to bottom:
//   Pose    sets the problem's ends, or refuses them;
//   Solve   without obstacles, which nearly always shows the plan's shape;
//   KeepPath, LayPath  lay a way past all that blocks that curve;
//   Follow  binds control points to free space along the way, solves, binds what is still blocked,
//           until the whole curve is clear;
//   Finish  certifies it.
//
// Pairs are bound to the present map at every attempt, so that none outlives its obstacle. Only the way lasts: the
// committed curve is the first that is tried.

#include "planning/replan/plan_attempt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "planning/certify/pad_strip.h"
#include "planning/replan/replan_checks.h"
#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kRowTolerance = 2e-6;  // what backends leave of the equality rows, as a norm
constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// The largest share of a limit that a plan uses; 1 for a recovery.
double ShareOfLimits(const Certificate& certificate, const Limits& limits) {
  if (certificate.recovering) return 1.0;
  return std::max(certificate.speed_bound / limits.speed,
                  certificate.acceleration_bound / limits.acceleration);
}

/// The limit that a certificate does not find kept. Of a recovery only the body rate has a name.
std::string_view LimitBroken(const Certificate& certificate, const Limits& limits) {
  if (!(certificate.body_rate_bound <= limits.body_rate + kLimitSlack)) return "limits.body_rate";
  if (certificate.recovering) return {};
  return certificate.speed_bound > limits.speed + kLimitSlack ? "limits.speed"
                                                              : "limits.acceleration";
}

/// The term that forbids the solver's point, by its row or because it has no value there. Its name lasts as long as
/// the problem.
std::string_view TermBroken(const solvers::SolverSummary& solver, const LandingProblem& problem) {
  const bool failed = solver.status == solvers::SolveStatus::kEvaluationFailed;
  if (solver.worst_term < 0 || !(failed || solver.max_violation > kRowTolerance)) return {};
  return problem.view().problem().term(solver.worst_term).info().name;
}

/// [s]
double BlockedTime(const std::vector<BlockedRun>& blocked) {
  double sum = 0.0;
  for (const BlockedRun& run : blocked) sum += run.t_out - run.t_in;
  return sum;
}

}  // namespace

PlanAttempt::PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends)
    : options_(options),
      problems_(options, backends),
      finder_(options.vertical_cost, options.constants, &budget_),
      binder_(options.problem, options.constants) {
  for (const TermEntry& entry : options.problem.terms) {
    if (entry.is_clearance || entry.is_limit) pressed_.push_back(entry.info.name);
  }
  // Room for the usual sizes.
  const auto most_pairs = static_cast<std::size_t>(options.problem.max_pairs_per_point) *
                          static_cast<std::size_t>(kMostControlPoints);
  for (Candidate* candidate : {&best_, &other_}) {
    candidate->pairs.reserve(most_pairs);
    candidate->blocked.reserve(64);
    candidate->bound.reserve(kMostControlPoints);
    candidate->pair.curve.Reserve(kMostControlPoints);
    candidate->pair.stop.Reserve(kMostControlPoints);
  }
  path_.reserve(1024);
  first_curve_.Reserve(kMostControlPoints);
}

void PlanAttempt::Begin(Candidate* candidate) {
  candidate->pairs.clear();
  candidate->pressure = {};
  candidate->blocked.clear();
  candidate->certificate.reset();
  candidate->bound.clear();
  candidate->solved = false;
  candidate->round = -1;
}

ReplanReason PlanAttempt::Run(const AttemptRequest& request, ReplanResult* result) {
  const Refusal refusal = Try(request, result);
  if (request.arrival == ArrivalMode::kFree && best_.solved)
    duration_ = best_.pair.curve.duration();
  if (best_.solved) {
    result->pair() = best_.pair;
    result->solver = best_.solver;
  }
  result->certificate = best_.certificate.value_or(Certificate());
  result->pairs = static_cast<int>(best_.pairs.size());
  result->bound = best_.bound;
  result->forbidden_by = refusal.forbidden_by;
  if (request.log) {
    request.log->duration = duration_;
    request.log->arrival = request.arrival;
    request.log->segments = segments_;
    request.log->best = best_.round;
    request.log->certificate = best_.certificate;
    request.log->reason = refusal;
    request.log->forbidden_by = result->forbidden_by;
  }
  return refusal;
}

Refusal PlanAttempt::Try(const AttemptRequest& request, ReplanResult* result) {
  finder_.Begin(request.limits.speed);
  kept_.Clear();
  kept_asked_ = false;
  // Shortly before contact there is no time for a way around.
  const bool leads_around = options_.max_rebinds > 0 && request.pair_end != PairEnd::kContact;
  const UniformBspline* warm = options_.warm_start ? request.previous : nullptr;
  const bool keeps = warm && leads_around && request.keeps;
  const auto holds = [](ReplanReason reason) {
    return reason == ReplanReason::kNone || reason == ReplanReason::kUnobserved;
  };
  if (keeps && !request.looks) {
    const Refusal refusal = KeepCommitted(request, result);
    if (holds(refusal)) return refusal;
  }
  const bool may_keep = keeps && request.looks;
  std::optional<WorkBudget::SetAside> aside;
  if (may_keep) aside.emplace(WorkBudget::kKeptShare, &budget_);
  const Refusal found = FindAnew(request, warm, leads_around, result);
  aside.reset();
  if (holds(found) || !may_keep) return found;
  // If no better plan is found, a committed plan that holds is kept before a later arrival is
  // tried.
  const Refusal kept = KeepCommitted(request, result);
  return holds(kept) ? kept : found;
}

Refusal PlanAttempt::FindAnew(const AttemptRequest& request, const UniformBspline* warm,
                              bool leads_around, ReplanResult* result) {
  Begin(&best_);
  Posed posed;
  Refusal refusal = SolveWithoutPairs(request, request.segments, warm, &posed, &best_, result);
  if (refusal != ReplanReason::kNone) return refusal;
  // So near that the first free control point comes too late to pass it.
  const bool near = leads_around && !best_.blocked.empty() && !best_.blocked.front().at_start &&
                    best_.blocked.front().t_in - request.t0 <
                        options_.constants.near_obstacle * best_.pair.curve.interval();
  if (near && request.segments < request.near_segments) {
    refusal = Refine(request, &posed, &best_, result);
    if (refusal != ReplanReason::kNone) return refusal;
  }
  if (!best_.blocked.empty() && leads_around) return TryPaths(request, &posed, result);
  return KeepLimits(request, posed, &best_, result);
}

/// Refuses ends that no plan can have.
ReplanReason PlanAttempt::Pose(const AttemptRequest& request, int segments, Posed* posed) {
  posed->prepared = &problems_.At(segments, request.arrival);
  posed->segments = segments_ = segments;
  LandingProblem& problem = *posed->prepared->problem;
  problem.SetBoundary(request.start, request.t0, *request.pad, request.target, request.pull_W);
  problem.SetDuration(request.duration);
  duration_ = request.duration;
  problem.SetPrevious(request.previous);
  const bool hard = options_.problem.limits_mode == LimitsMode::kHard;
  if (hard && problem.boundary_facts().end_too_fast) return ReplanReason::kEndTooFast;
  const double t_end = request.t0 + request.duration;
  const Eigen::Vector3d end = EndStateAt(*request.pad, request.target, t_end).state.p;
  if (!end.allFinite()) return ReplanReason::kPadUnreachable;  // where it is then is not known
  if (request.space->Blocked(end)) return ReplanReason::kGoalBlocked;
  return ReplanReason::kNone;
}

Refusal PlanAttempt::SolveWithoutPairs(const AttemptRequest& request, int segments,
                                       const UniformBspline* guess, Posed* posed,
                                       Candidate* candidate, ReplanResult* result) {
  const ReplanReason refused = Pose(request, segments, posed);
  if (refused != ReplanReason::kNone) return refused;
  PreparedProblem& prepared = *posed->prepared;
  if (guess) {
    prepared.problem->WarmGuess(*guess, &prepared.start.y);
  } else {
    prepared.problem->Guess(&prepared.start.y);
  }
  prepared.first_guess = prepared.start.y;
  return Solve(request, *posed, candidate, result);
}

/// The curve on shorter segments, before it is led past obstacles. Where the arrival is fixed, its optimum there is
/// cheap, and a better start. Where it is free, the solve would cost more than the rounds after it gain. There the
/// curve is only interpolated, to within millimetres, so that the blocked runs stay valid. If no round can be solved
/// then, the next attempt fixes the arrival.
Refusal PlanAttempt::Refine(const AttemptRequest& request, Posed* posed, Candidate* candidate,
                            ReplanResult* result) {
  first_curve_ = candidate->pair.curve;
  const bool interpolates = request.arrival == ArrivalMode::kFree && options_.max_rebinds > 0 &&
                            options_.problem.endpoint == EndpointMode::kEliminated;
  if (!interpolates) {
    const Refusal refusal =
        SolveWithoutPairs(request, request.near_segments, &first_curve_, posed, candidate, result);
    if (refusal != ReplanReason::kSolverFailed) return refusal;
    // The coarse ones are used.
    return SolveWithoutPairs(request, request.segments, &first_curve_, posed, candidate, result);
  }
  Pose(request, request.near_segments, posed);  // refused by the coarse problem, if at all
  PreparedProblem& prepared = *posed->prepared;
  prepared.problem->SetDuration(first_curve_.duration());
  prepared.problem->WarmGuess(first_curve_, &prepared.start.y);
  prepared.first_guess = prepared.start.y;
  prepared.problem->Curve(prepared.start.y, &candidate->pair.curve);
  return ReplanReason::kNone;
}

/// The committed way on the present map, once an attempt.
void PlanAttempt::KeepPath(const AttemptRequest& request, ReplanResult* result) {
  if (std::exchange(kept_asked_, true)) return;
  if (!request.starts_on_previous || request.previous->t_end() <= request.t0) return;
  StageTimer timer(&result->times.search, StageTimer::kWhileLogged);
  finder_.Keep(*request.previous, request.t0, *request.space, &kept_);
}

/// A new way past all of `span`.
ReplanReason PlanAttempt::LayPath(const AttemptRequest& request, const BlockedRun& span,
                                  double max_cost, ReplanResult* result) {
  StageTimer timer(&result->times.search, StageTimer::kWhileLogged);
  // A way for which no budget to follow it is left would only be found again.
  const int reserve = WorkBudget::kLeastEvaluations * WorkBudget::kSegment * segments_;
  const SearchStatus status =
      finder_.LeadPast(first_curve_, span, *request.space, &way_, reserve, max_cost);
  // The search moves a blocked start to the nearest free cell: a start in the inflated zone is led out.
  if (span.at_start && status == SearchStatus::kEndsBlocked) return ReplanReason::kStartBlocked;
  // What is left for other ways is less than the budget.
  if (status == SearchStatus::kExpansionLimit && finder_.paths_closed() == 0) spent_ = true;
  if (status == SearchStatus::kFound) result->guide_paths.Add(finder_.detour());
  return way_.known() ? ReplanReason::kNone : ReplanReason::kSearchFailed;
}

/// The committed plan is the best known. Its rest, bound as before, but to the present map, takes one solve while it
/// holds. New obstacles on it need further rounds.
Refusal PlanAttempt::KeepCommitted(const AttemptRequest& request, ReplanResult* result) {
  KeepPath(request, result);
  if (!kept_.known()) return ReplanReason::kCollisionRemains;
  Posed posed;
  const ReplanReason refused = Pose(request, request.segments, &posed);
  if (refused != ReplanReason::kNone) return refused;
  posed.prepared->problem->WarmGuess(*request.previous, &posed.prepared->start.y);
  Begin(&best_);
  const double left = request.previous->t_end() - request.t0;
  return Follow(request, kept_, *request.bound,
                options_.constants.kept_latest * std::max(request.duration, left), posed, &best_,
                result);
}

/// One way leads past all obstacles, so that one detour does not lead into the next. Ways differ in how they pass the
/// first obstacle.
Refusal PlanAttempt::TryPaths(const AttemptRequest& asked, Posed* posed, ReplanResult* result) {
  AttemptRequest request = asked;
  if (!request.previous) posed->prepared->first_guess = posed->prepared->start.y;
  first_curve_ = best_.pair.curve;
  if (best_.blocked.back().at_end) return ReplanReason::kGoalBlocked;
  const BlockedRun first = best_.blocked.front();
  BlockedRun span = {first.t_in, best_.blocked.back().t_out, first.at_start, false};
  if (!first.at_start) KeepPath(request, result);
  const bool keeps_side = kept_.known() && !first.at_start;
  if (keeps_side) {
    EndBeside(kept_, first_curve_, *request.space, options_.constants.hold_beside_time, &span);
    const double share = (kept_.t_end() - kept_.t0()) / first_curve_.duration();
    kept_.Bind({kept_.t0() + share * (span.t_in - request.t0),
                kept_.t0() + share * (span.t_out - request.t0)});
  }
  // If the committed way fails, another is tried at once. A way that was searched for is kept until a later arrival.
  const int rescues = keeps_side ? 2 : 1;
  double first_cost = kNoBound;
  for (int i = 0;; ++i) {
    const bool planned = i > 0 && best_.refusal == ReplanReason::kNone;
    if (i > 0 && (first.at_start || i >= (planned ? options_.max_guides : rescues))) break;
    const bool kept = i == 0 && keeps_side;
    if (!kept) {
      const ReplanReason found =
          LayPath(request, span,
                  planned ? options_.constants.path_cost_ratio * first_cost : kNoBound, result);
      if (i > 0 && found != ReplanReason::kNone) break;  // there is no other way
      if (found != ReplanReason::kNone) return found;
    }
    const TimedPath& way = kept ? kept_ : way_;
    if (i == 0) first_cost = kept ? kept_.LengthOf(kept_.bound().back()) : finder_.cost();
    if (i == 0 && !request.previous) Postpone(way, posed, &request);
    Candidate* candidate = i == 0 ? &best_ : &other_;
    posed->prepared->start.y = posed->prepared->first_guess;
    Begin(candidate);
    candidate->refusal = Follow(request, way, {}, kNoBound, *posed, candidate, result);
    if (i > 0 && Better(other_, best_, keeps_side)) std::swap(best_, other_);
    if (spent_) break;
    way.Sample(way.bound().back().from, way.bound().back().to, &path_);
    const FlatState through = first_curve_.Evaluate(0.5 * (first.t_in + first.t_out));
    const std::optional<Barrier> barrier = ClosePath(path_, through);
    if (!barrier) break;
    finder_.Close(*barrier);
  }
  return best_.refusal;
}

/// The path around takes longer than the straight one: by its extra length at full speed. A committed arrival is not
/// postponed like that.
void PlanAttempt::Postpone(const TimedPath& way, Posed* posed, AttemptRequest* request) {
  if (request->arrival == ArrivalMode::kFree) return;
  AttemptRequest later = *request;
  later.duration = std::min(request->duration + way.delay(), options_.max_duration);
  if (later.duration <= request->duration) return;
  later_space_ = *request->space;
  later.space = &later_space_;
  LayPadStrip(*request->pad, request->target, request->start.p, request->t0,
              request->t0 + later.duration, later_space_.pad_radius, options_.contact_height,
              &later_space_);
  if (Pose(later, posed->segments, posed) == ReplanReason::kNone) {
    *request = later;
    posed->prepared->problem->WarmGuess(first_curve_, &posed->prepared->first_guess);
  } else {
    Pose(*request, posed->segments, posed);
  }
}

/// Binds control points along the way and solves, until the curve is clear, or hardly clearer than before. The first
/// round binds the parts of the way that need it, and `more`; later ones what is still blocked. A plan must end
/// before `latest` after the start [s].
Refusal PlanAttempt::Follow(const AttemptRequest& request, const TimedPath& way,
                            const BoundParts& more, double latest, const Posed& posed,
                            Candidate* candidate, ReplanResult* result) {
  binder_.Begin(posed.segments + 3);
  double blocked = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= options_.max_rebinds; ++round) {
    {
      StageTimer timer(&result->times.pairs, StageTimer::kWhileLogged);
      if (round == 1) {
        binder_.Lead(way, more);
      } else {
        const ReplanReason reason = BindBlocked(request, way, *candidate);
        if (reason != ReplanReason::kNone) return reason;
        candidate->pressure.pairs *= options_.constants.pair_growth;
      }
      binder_.Bind(*request.space, &candidate->pairs);
    }
    ++result->rebinds;
    const Refusal refusal = Solve(request, posed, candidate, result);
    if (refusal != ReplanReason::kNone) return refusal;
    if (candidate->pair.curve.duration() > latest) return ReplanReason::kCollisionRemains;
    // If only the start is blocked, the certificate decides: it may be an escape.
    const auto& runs = candidate->blocked;
    const bool only_start = runs.size() == 1 && runs.front().at_start;
    if (runs.empty() || only_start) {
      const Refusal end = KeepLimits(request, posed, candidate, result);
      if (runs.empty() || (runs.size() == 1 && runs.front().at_start)) return end;
    }
    const double before = std::exchange(blocked, BlockedTime(runs));
    if (blocked > options_.constants.blocked_share_left * before) break;
  }
  return Finish(request, posed, candidate, result);
}

/// Leads blocked parts to the way, with a plane at the corner that is cut.
ReplanReason PlanAttempt::BindBlocked(const AttemptRequest& request, const TimedPath& way,
                                      const Candidate& candidate) {
  const UniformBspline& curve = candidate.pair.curve;
  binder_.Start(curve);
  for (const BlockedRun& run : candidate.blocked) {
    if (run.at_end) return ReplanReason::kGoalBlocked;
    way.SampleBeside(curve, run, &path_);
    binder_.AddCorner(curve, run, path_, *request.space);
    binder_.Follow(curve, run, path_, *request.space);
  }
  return ReplanReason::kNone;
}

/// Solves with the candidate's pairs and pressure, and checks its curve.
Refusal PlanAttempt::Solve(const AttemptRequest& request, const Posed& posed, Candidate* candidate,
                           ReplanResult* result) {
  PreparedProblem& prepared = *posed.prepared;
  LandingProblem& problem = *prepared.problem;
  problem.SetPairs(candidate->pairs);
  problem.SetPairWeightScale(candidate->pressure.pairs);
  problem.SetLimitWeightScale(candidate->pressure.limits);
  solvers::Stop stop;
  stop.max_iterations = options_.max_iterations;
  stop.gap = options_.gap;
  stop.confirm = false;  // the certificate judges the plan
  stop.trace = request.log != nullptr;
  const int curve_work = WorkBudget::kSegment * posed.segments;
  const int other_work = WorkBudget::kEvaluationsOfSetUp * curve_work +
                         WorkBudget::kPair * static_cast<int>(candidate->pairs.size());
  stop.max_evaluations = (budget_.left() - other_work) / curve_work;
  if (stop.max_evaluations <= 0) {
    spent_ = true;
    return ReplanReason::kBudgetSpent;
  }
  {
    StageTimer timer(&result->times.solve, StageTimer::kWhileLogged);
    prepared.backend->Solve(problem.view(), prepared.start, stop, &prepared.solver);
  }
  ++result->solves;
  budget_.Take(other_work + prepared.solver.evaluations * curve_work);
  spent_ = spent_ || prepared.solver.evaluations >= stop.max_evaluations;
  candidate->solver = prepared.solver;
  candidate->bound.clear();
  if (request.log) {
    candidate->round = static_cast<int>(request.log->rounds.size());
    request.log->rounds.push_back({candidate->pressure.pairs,
                                   candidate->pressure.limits,
                                   candidate->pairs,
                                   prepared.solver,
                                   {},
                                   {},
                                   finder_.paths_closed()});
  }
  const Refusal failed(ReplanReason::kSolverFailed, TermBroken(prepared.solver, problem));
  if (!prepared.solver.usable()) return failed;
  prepared.start.y = prepared.solver.x;
  problem.Curve(prepared.start.y, &candidate->pair.curve);
  if (!IsWalkable(candidate->pair.curve)) return failed;
  if (!candidate->pairs.empty()) binder_.Remember(candidate->pair.curve, &candidate->bound);
  candidate->solved = true;
  {
    StageTimer timer(&result->times.check, StageTimer::kWhileLogged);
    FindBlockedRuns(candidate->pair.curve, request.t0, *request.space, &candidate->blocked);
  }
  if (request.log) {
    request.log->rounds.back().curve = candidate->pair.curve;
    request.log->rounds.back().blocked = candidate->blocked;
  }
  return ReplanReason::kNone;
}

/// Certifies a clear candidate. If only limits are exceeded, raises their weights and solves again.
Refusal PlanAttempt::KeepLimits(const AttemptRequest& request, const Posed& posed,
                                Candidate* candidate, ReplanResult* result) {
  for (int round = 0;; ++round) {
    const Refusal refusal = Finish(request, posed, candidate, result);
    const bool soft = options_.problem.limits_mode == LimitsMode::kSoft;
    if (refusal != ReplanReason::kLimitsExceeded || !soft ||
        round == options_.constants.limit_rounds)
      return refusal;
    const double share = ShareOfLimits(*candidate->certificate, request.limits);
    candidate->pressure.limits *=
        share > options_.constants.limit_far
            ? options_.constants.limit_growth * options_.constants.limit_growth
            : options_.constants.limit_growth;
    // If the solver fails under the pressure, the last curve is kept.
    if (Solve(request, posed, candidate, result) != ReplanReason::kNone) return refusal;
  }
}

/// Certifies a candidate that has been solved for the last time.
Refusal PlanAttempt::Finish(const AttemptRequest& request, const Posed& posed, Candidate* candidate,
                            ReplanResult* result) {
  StageTimer timer(&result->times.certificate, StageTimer::kWhileLogged);
  const UniformBspline& curve = candidate->pair.curve;
  const SplineState wanted = EndStateAt(*request.pad, request.target, curve.t_end()).state;
  Certificate& certificate = candidate->certificate.emplace(
      Certify(curve, request.t0, &request.start, &wanted, request.limits, *request.space));
  if (certificate.limits_kept && (certificate.clear || certificate.escaping)) {
    const PairProof proof = ProvePair(request.t0, request.t0 + request.reaction, request.pair_end,
                                      request.limits, *request.hull, &candidate->pair);
    Enter(proof, &certificate);
    if (!proof.proven && !result->unseen_W) result->unseen_W = proof.unseen_W;
  }
  if (options_.problem.endpoint == EndpointMode::kExplicit) {
    certificate.endpoint_tolerance = kRowTolerance;
  }
  // The certificate does not check every row: for tilt, thrust and a user's own, the solver's claim
  // counts.
  const bool rows_kept = candidate->solver.max_violation <= kRowTolerance;
  if (certificate.passed() && rows_kept) return ReplanReason::kNone;
  if (!certificate.clear && !certificate.escaping) {
    return candidate->blocked.front().at_start ? ReplanReason::kStartBlocked
                                               : ReplanReason::kCollisionRemains;
  }
  const std::string_view term = TermBroken(candidate->solver, *posed.prepared->problem);
  if (!certificate.start_met() || !certificate.endpoint_met()) {
    return {ReplanReason::kSolverFailed, term};
  }
  if (certificate.limits_kept && rows_kept) return ReplanReason::kUnobserved;
  return {ReplanReason::kLimitsExceeded,
          rows_kept ? LimitBroken(certificate, request.limits) : term};
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
  if (a.refusal != ReplanReason::kNone) return false;
  if (b.refusal != ReplanReason::kNone) return true;
  const double share = keeps_side ? options_.constants.side_change_ratio : 1.0;
  return CostOfShape(a.solver) < share * CostOfShape(b.solver);
}

}  // namespace touchdown::planning
