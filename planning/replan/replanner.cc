// SPDX-License-Identifier: BSD-3-Clause
// The replanning step. It starts from the committed trajectory (or from the vehicle where tracking lost it) and
// chooses an arrival. It tries, re-times while limits or obstacles forbid, and commits what is certified. If nothing
// is, it uses the ladder of fallback_ladder.h. What is committed is always a pair, a curve and its stop, so a step
// without an answer is safe.

#include "touchdown/planning/replan/replanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "planning/certify/pad_strip.h"
#include "planning/problem/duration_guess.h"
#include "planning/replan/fallback.h"
#include "planning/replan/fallback_ladder.h"
#include "planning/replan/plan_attempt.h"
#include "planning/replan/plan_end.h"
#include "planning/replan/replan_checks.h"
#include "planning/replan/spaces.h"
#include "planning/search/timed_path.h"
#include "touchdown/planning/replan/attempt_ladder.h"
#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::planning {

namespace {

constexpr double kStripMemory = 2.0;  // the strip over a pad that was lost holds this long [s]
constexpr int kUsualPaths = 32;       // room for those of one step
constexpr int kUsualPathPoints = 512;
constexpr double kClockRounding = 1e-6;  // [s]
constexpr double kNearEnd = 0.1;         // of a curve that arrives [m]
constexpr double kRestartAfter = 2.0;    // a longer pause between calls resets the memory [s]

/// Length of what is left of a curve over the straight line between its ends, at least 1.
double DetourOf(const UniformBspline& curve, double from) {
  const double straight = (curve.Position(curve.t_end()) - curve.Position(from)).norm();
  return straight > 0.0 ? std::max(1.0, LengthOf(curve, from, curve.t_end()) / straight) : 1.0;
}

SplineState ToSpline(const FlatState& flat) { return {flat.p_WB, flat.v_WB, flat.a_WB}; }

}  // namespace

class Replanner::Impl {
 public:
  Impl(const ReplannerOptions& options, const solvers::BackendRegistry& backends)
      : options_(options), attempt_(options, backends), fallback_(options.limits), end_(options_) {
    for (UniformBspline* curve :
         {&memory_.current.curve, &memory_.current.stop, &memory_.next.curve, &memory_.next.stop,
          &result_.curve, &result_.stop}) {
      curve->Reserve(PlanAttempt::kMostControlPoints);
    }
    result_.guide_paths.Reserve(kUsualPaths, kUsualPathPoints);
    for (BoundParts* parts : {&memory_.bound, &result_.bound}) {
      parts->reserve(PlanAttempt::kMostControlPoints);
    }
  }

  void Prepare(const OccupancyMap& map) { attempt_.Prepare(map); }

  /// The pair of the result takes over at t0.
  void Commit(double t0) {
    memory_.current = memory_.next;
    memory_.next = result_.pair();
    memory_.next.from_unknown = result_.certificate.start_cells.unknown;
    takes_over_ = t0;
    result_.committed = true;
  }

  /// A pair that comes after the older one's stop has begun is too late: it does not start there.
  void TakeOverAt(double t) {
    if (!result_.committed || t <= takes_over_) return;
    takes_over_ = t;
    if (t > memory_.current.t_stop) {
      memory_.next = memory_.current;
      result_.committed = memory_.planned = false;
      memory_.climb.reset();
      Fallback::FlyStop(memory_.next, t, HullSpace{}, &result_);
    }
  }

  void CommitStop(const FlatState& from, double t) {
    MakeRestTrajectory(ToSpline(from), t, Eigen::Vector3d::Zero(), options_.limits,
                       &memory_.next.curve);
    memory_.next.t_stop = std::numeric_limits<double>::infinity();
    memory_.next.proven = memory_.planned = false;
    memory_.next.from_unknown = true;
    memory_.current = memory_.next;
    takes_over_ = t;
    memory_.asked_t.reset();
    memory_.unfinished.reset();
    memory_.climb.reset();
  }

  /// The pair that is flown at time t.
  const FlightPair& InForce(double t) const {
    return t < takes_over_ ? memory_.current : memory_.next;
  }

  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map);
  const ReplanResult& Rest(const ReplanInput& input, double climb, const OccupancyMap& map);

  void Restore(const ReplannerState& state);

  const ReplannerOptions options_;
  ReplannerState memory_;
  double takes_over_ = 0.0;  // the memory's `next` does [s]
  ReplanLog* log_ = nullptr;

 private:
  FreeSpace Space(const OccupancyMap& map) const;
  bool RemembersStrip(double t) const;
  FreeSpace SpaceWithoutPad(const ReplanInput& input, const OccupancyMap& map) const;
  double WatchedUntil(const ReplanInput& input) const;
  FreeSpace SpaceOverPad(const ReplanInput& input, const SplineState& start, double t_end,
                         const OccupancyMap& map) const;
  void Begin(const ReplanInput& input);
  const char* WrongInState(const ReplanInput& input) const;
  const ReplanResult& RefuseState(const ReplanInput& input, const char* wrong);
  void NoteAsked(double t_start);
  SplineState Start(const ReplanInput& input);
  bool ArrivesSoon(double t_start) const;
  Attempt FirstAttempt(const ReplanInput& input, const SplineState& start, const FreeSpace& plain,
                       AttemptFacts* facts);
  AttemptRequest RequestFor(const ReplanInput& input, const SplineState& start,
                            const Attempt& attempt, const AttemptFacts& facts, double first,
                            const HullSpace& hull);
  ReplanReason Plan(const ReplanInput& input, const SplineState& start, const OccupancyMap& map);
  HullSpace HullIn(const FreeSpace& space, const estimation::PadPrediction* pad) const;
  std::optional<Eigen::Vector3d> NeededNext(const ReplanInput& input, const HullSpace& hull) const;
  FallbackFacts FactsFor(const ReplanInput& input, const SplineState& start,
                         const HullSpace& hull) const;
  const ReplanResult& Finish(const Fallen& fallen, double t0);

  PlanAttempt attempt_;
  FallbackLadder fallback_;
  Limits limits_;                  // what the pull of this step leaves
  double margin_ = 0.0;            // around the hull in this step [m]
  double reaction_ = 0.0;          // after which a stop of this step begins [s]
  bool stands_ = false;            // something is committed
  PlanEnd end_;                    // of this step's plans
  ReplanResult result_;
  UnseenZone unseen_;
  std::optional<Attempt> resumes_;  // at which the last step ran out of its budget
};

FreeSpace Replanner::Impl::Space(const OccupancyMap& map) const { return SpaceFor(options_, map); }

FreeSpace Replanner::Impl::SpaceOverPad(const ReplanInput& input, const SplineState& start,
                                        double t_end, const OccupancyMap& map) const {
  if (DeckOf(input) == nullptr) return SpaceWithoutPad(input, map);
  FreeSpace space = Space(map);
  LayPadStrip(*input.pad, input.endpoint, start.p, input.t_start, t_end, options_.pad_radius,
              options_.contact_height, &space);
  return space;
}

bool Replanner::Impl::RemembersStrip(double t) const {
  return memory_.strip_t && t - *memory_.strip_t <= kStripMemory;
}

/// A vehicle that has just lost its pad is still above it: the strip stays for a while.
FreeSpace Replanner::Impl::SpaceWithoutPad(const ReplanInput& input,
                                           const OccupancyMap& map) const {
  FreeSpace space = Space(map);
  if (!RemembersStrip(input.t_start)) return space;
  space.pad_from = memory_.strip_from;
  space.pad_to = memory_.strip_to;
  space.pad_radius = options_.pad_radius;
  space.pad_floor = memory_.strip_floor;
  return space;
}

/// The strip over the pad reaches as far as the committed plan does.
double Replanner::Impl::WatchedUntil(const ReplanInput& input) const {
  return std::max(input.t_start + options_.min_duration, memory_.next.curve.t_end());
}

void Replanner::Impl::Restore(const ReplannerState& state) {
  stands_ = true;
  memory_ = state;
  takes_over_ = memory_.next.curve.t0();
}

void Replanner::Impl::Begin(const ReplanInput& input) {
  resumes_ = std::exchange(memory_.unfinished, std::nullopt);
  margin_ = input.margins.Sum();
  reaction_ = options_.reaction;
  limits_ = LimitsUnder(options_.limits, options_.problem.vehicle, input.pull_W);
  fallback_.SetLimits(limits_);
  end_.Forget();
  if (log_) log_->attempts.clear();
  result_.times = {};
  result_.guide_paths.Clear();
  result_.pairs = result_.solves = result_.rebinds = result_.work = 0;
  result_.from_odometry = result_.map_error = result_.committed = false;
  result_.proven = true;
  result_.ends_in_contact =
      DeckOf(input) && !input.look_from_W && input.endpoint.may_touch(options_.contact_height);
  result_.unseen_W.reset();
  result_.reason = ReplanReason::kNone;
  result_.detail = result_.forbidden_by = {};
  result_.certificate = {};
  result_.solver.status = solvers::SolveStatus::kNumericalFailure;
  result_.solver.iterations = result_.solver.evaluations = 0;
  result_.solver.cost = 0.0;
  for (solvers::TermCost& term : result_.solver.cost_by_term) term.cost = 0.0;
}

/// Without a usable state of the vehicle nothing can be decided: the committed pair goes on, to its stop.
const ReplanResult& Replanner::Impl::RefuseState(const ReplanInput& input, const char* wrong) {
  const double t0 = std::isfinite(input.t_start) ? input.t_start : memory_.next.curve.t0();
  Fallback::FlyStop(memory_.next, t0, HullSpace{}, &result_);
  result_.reason = ReplanReason::kInvalidInput;
  result_.detail = wrong;
  return result_;
}

/// A caller that asks less often than options_.reaction is assumed to continue like that. Otherwise each plan would
/// be flown into its stop.
void Replanner::Impl::NoteAsked(double t_start) {
  const double since = memory_.asked_t ? t_start - *memory_.asked_t : 0.0;
  if (since <= kRestartAfter) reaction_ = std::max(reaction_, since);
  memory_.asked_t = t_start;
}

/// The committed state when the answer takes over, or the vehicle's own where tracking is lost.
SplineState Replanner::Impl::Start(const ReplanInput& input) {
  const FlatState reference = InForce(input.t_now).At(input.t_now);
  const double error = (reference.p_WB - input.vehicle.p_WB).norm();
  result_.from_odometry = error > options_.odometry_threshold;
  if (!result_.from_odometry) return ToSpline(InForce(input.t_start).At(input.t_start));
  const double latency = input.t_start - input.t_now;
  return {input.vehicle.p_WB + latency * input.vehicle.v_WB, input.vehicle.v_WB,
          Eigen::Vector3d::Zero()};
}

/// The last answer must have taken over before the next request: only one is ever pending.
const char* Replanner::Impl::WrongInState(const ReplanInput& input) const {
  if (!stands_) throw std::invalid_argument("Replanner: a step is asked for before CommitHover");
  if (const char* wrong = planning::WrongInState(input)) return wrong;
  const bool in_time = input.t_now >= takes_over_ - kClockRounding;
  return in_time ? nullptr : "an earlier answer has not taken over yet at t_now";
}

HullSpace Replanner::Impl::HullIn(const FreeSpace& space,
                                  const estimation::PadPrediction* pad) const {
  HullSpace hull = HullFor(options_, space, margin_, pad);
  hull.start_proven = !result_.from_odometry && memory_.next.proven && !memory_.next.from_unknown;
  return hull;
}

const ReplanResult& Replanner::Impl::Replan(const ReplanInput& input, const OccupancyMap& map) {
  Begin(input);
  StageTimer total(&result_.times.total);
  if (const char* wrong = WrongInState(input)) return RefuseState(input, wrong);
  NoteAsked(input.t_start);
  const SplineState start = Start(input);
  memory_.climb.reset();
  const char* wrong = WrongInTarget(input, options_.max_duration);
  const bool target_valid = wrong == nullptr;
  if (wrong) result_.detail = wrong;
  if (target_valid) {
    end_.Set(input, start, limits_);
    if (end_.is_on_the_way()) result_.ends_in_contact = false;
  }
  result_.reason = target_valid ? Plan(input, start, map) : ReplanReason::kInvalidInput;
  // Where cells are to be seen first, no term decides.
  if (result_.reason == ReplanReason::kUnobserved) result_.forbidden_by = {};
  const FreeSpace space = target_valid ? SpaceOverPad(input, start, WatchedUntil(input), map)
                                       : SpaceWithoutPad(input, map);
  if (target_valid && DeckOf(input)) {
    memory_.strip_t = input.t_start;
    memory_.strip_from = space.pad_from;
    memory_.strip_to = space.pad_to;
    memory_.strip_floor = space.pad_floor;
  }
  if (result_.reason == ReplanReason::kNone) {
    result_.status = ReplanStatus::kPlanned;
    memory_.planned = true;
    memory_.bound = result_.bound;
    Commit(input.t_start);
    result_.unseen_W = NeededNext(input, HullIn(space, DeckOf(input)));
    return result_;
  }
  const HullSpace hull = HullIn(space, target_valid ? DeckOf(input) : nullptr);
  return Finish(fallback_.StepDown(FactsFor(input, start, hull), &result_), input.t_start);
}

/// The facts point to the committed pair and to `hull`.
FallbackFacts Replanner::Impl::FactsFor(const ReplanInput& input, const SplineState& start,
                                        const HullSpace& hull) const {
  FallbackFacts facts;
  facts.committed = &memory_.next;
  facts.start = start;
  facts.v_WB = input.vehicle.v_WB;
  facts.t0 = input.t_start;
  facts.reaction = reaction_;
  facts.hull = &hull;
  facts.endpoint = end_.is_look() ? end_.target() : input.endpoint;
  if (end_.is_look()) facts.look_from_W = input.look_from_W;
  facts.planned = memory_.planned;
  return facts;
}

/// Commits the ladder's result, if it is new.
const ReplanResult& Replanner::Impl::Finish(const Fallen& fallen, double t0) {
  memory_.planned = fallen.on_plan;
  if (fallen.commits) Commit(t0);
  return result_;
}

/// A cell that a later step's stop needs: the first on the way beyond the pair's first part.
std::optional<Eigen::Vector3d> Replanner::Impl::NeededNext(const ReplanInput& input,
                                                           const HullSpace& hull) const {
  const UniformBspline& curve = memory_.next.curve;
  const double t_from = input.t_start + reaction_;
  if (curve.t_end() <= t_from) return std::nullopt;
  return SweepHull(curve, t_from, curve.t_end(), {curve.Position(t_from), t_from}, hull, kAnyTime)
      .unseen_W;
}

const ReplanResult& Replanner::Impl::Rest(const ReplanInput& input, double climb,
                                          const OccupancyMap& map) {
  Begin(input);
  StageTimer total(&result_.times.total);
  if (const char* wrong = WrongInState(input)) return RefuseState(input, wrong);
  NoteAsked(input.t_start);
  const SplineState start = Start(input);
  const bool remembered =
      RemembersStrip(input.t_start) || WrongInTarget(input, options_.max_duration);
  const FreeSpace space = remembered ? SpaceWithoutPad(input, map)
                                     : SpaceOverPad(input, start, WatchedUntil(input), map);
  const HullSpace hull =
      HullIn(space, WrongInPad(input, options_.max_duration) ? nullptr : DeckOf(input));
  return Finish(fallback_.Rest(FactsFor(input, start, hull), climb, &memory_.climb, &result_),
                input.t_start);
}

/// The committed curve ends about where a landing begins to sink, sooner than a plan of the usual length would.
bool Replanner::Impl::ArrivesSoon(double t_start) const {
  const double t = memory_.next.curve.t_end();
  if (!end_.target().touches() || t - t_start >= options_.min_duration) return false;
  const Eigen::Vector3d end_W = EndStateAt(end_.pad(), end_.target(), t).state.p;
  return (end_W - memory_.next.curve.Position(t)).norm() < kNearEnd;
}

/// The first attempt, and the facts that the ladder of attempts depends on. Out of reach: the fresh guess is longer
/// than a plan may be.
Attempt Replanner::Impl::FirstAttempt(const ReplanInput& input, const SplineState& start,
                                      const FreeSpace& plain, AttemptFacts* facts) {
  StageTimer timer(&result_.times.predict, StageTimer::kWhileLogged);
  const auto guess = [&](double detour) {
    return GuessDuration(start, input.t_start, end_.pad(), end_.target(), limits_, detour);
  };
  facts->fresh = guess(1.0);
  facts->lands_soon =
      !result_.from_odometry &&
      LandsSoon(memory_.next, input.t_start, end_.target(), HullIn(plain, DeckOf(input)));
  facts->at_rest =
      !result_.from_odometry && Fallback::AtRest(memory_.next, input.t_start, memory_.planned);
  facts->arrival = options_.arrival;
  facts->min_duration = options_.min_duration;
  facts->max_duration = options_.max_duration;
  // An arrival once promised is kept: a new guess at every step would postpone it for ever. An arrival that is soon
  // on the straight way need not be on a long way around. An end on the way goes on ahead.
  const double left = memory_.next.curve.t_end() - input.t_start;
  const bool on_plan = memory_.planned && !result_.from_odometry;
  const bool promised =
      on_plan && !end_.is_on_the_way() &&
      guess(DetourOf(memory_.next.curve, input.t_start)) > options_.constants.retime_below * left;
  // A vehicle that follows a pad needs no shorter plans than usual. Only the last ones before a
  // contact are shorter.
  const double shortest =
      end_.target().touches() ? options_.min_contact_duration : options_.min_duration;
  Attempt attempt;
  attempt.duration = std::clamp(promised ? left : facts->fresh, shortest, options_.max_duration);
  // The prepared problems' free arrival has the usual lower bound.
  const bool fixed = attempt.duration < options_.min_duration || facts->lands_soon;
  attempt.arrival = fixed ? ArrivalMode::kFixed : options_.arrival;
  // A plan that led around unseen cells is followed by others that do: they must not alternate.
  const bool closes = memory_.around_unseen && on_plan && !facts->lands_soon;
  attempt.unseen_reach = closes ? options_.constants.unseen_reach : 0.0;
  return attempt;
}

/// The ladder of attempts (attempt_ladder.h), until one gives a plan.
ReplanReason Replanner::Impl::Plan(const ReplanInput& input, const SplineState& start,
                                   const OccupancyMap& map) {
  AttemptFacts facts;
  Attempt attempt = FirstAttempt(input, start, Space(map), &facts);
  if (!(facts.fresh <= options_.max_duration)) return ReplanReason::kPadUnreachable;
  const bool on_plan = memory_.planned && !result_.from_odometry;
  const double first = std::max(attempt.duration, facts.fresh);
  // On a plan, the next step first checks whether it holds.
  if (resumes_ && !on_plan && !facts.lands_soon && !result_.from_odometry) attempt = *resumes_;
  attempt_.BeginStep(facts.at_rest ? WorkBudget::kAtRest * options_.max_work : options_.max_work);
  for (int tried = 1;; ++tried) {
    if (!facts.lands_soon) attempt.duration = end_.FindFree(input.t_start, attempt.duration, map);
    FreeSpace space = SpaceOverPad(input, start, input.t_start + attempt.duration, map);
    const HullSpace hull = HullIn(space, DeckOf(input));
    if (attempt.unseen_reach > 0.0) {
      unseen_.Build(hull, start.p, attempt.unseen_reach);
      space.unseen = &unseen_;
    }
    const ReplanReason reason =
        attempt_.Run(RequestFor(input, start, attempt, facts, first, hull), &result_);
    result_.work = attempt_.work();
    if (reason == ReplanReason::kNone) {
      memory_.around_unseen = attempt.unseen_reach > 0.0 && result_.rebinds > 0;
      return reason;
    }
    if (reason == ReplanReason::kCollisionRemains && fallback_.NoTimeToBrake(start, space))
      return reason;
    // Unseen cells may soon be seen, and a contact that is near is not to be put off: as long as it can, the committed
    // curve goes on.
    const bool waits = reason == ReplanReason::kUnobserved || ArrivesSoon(input.t_start);
    if (waits && attempt.number == 0 && on_plan && !facts.at_rest && !facts.lands_soon &&
        fallback_.GoesOn(FactsFor(input, start, hull), &result_)) {
      return reason;
    }
    facts.lands_well = facts.lands_soon && LandsWell(memory_.next, input.t_start, hull);
    const AttemptDecision decision =
        NextAttempt(attempt, {reason, attempt_.duration()}, facts, options_.constants);
    if (attempt_.spent()) {
      // A later attempt gets a whole budget in the next step. A first one had it, and is given up.
      memory_.unfinished = tried > 1 ? attempt : decision.next;
      return reason;
    }
    if (!decision.next) return decision.reason;
    attempt = *decision.next;
  }
}

/// @param first the first guess of the duration [s].
AttemptRequest Replanner::Impl::RequestFor(const ReplanInput& input, const SplineState& start,
                                           const Attempt& attempt, const AttemptFacts& facts,
                                           double first, const HullSpace& hull) {
  const StepConstants& constants = options_.constants;
  const bool is_first = attempt.number == 0;
  AttemptRequest request;
  request.start = start;
  request.t0 = input.t_start;
  request.reaction = reaction_;
  request.pad = &end_.pad();
  request.target = end_.target();
  request.limits = limits_;
  request.pull_W = input.pull_W;
  request.arrival = attempt.arrival;
  request.duration = attempt.duration;
  request.space = hull.space;
  request.hull = &hull;
  // A stretched plan is slower, not longer: it needs hardly more control points.
  const double longest = std::min(attempt.duration, constants.grid_longest * first);
  request.near_segments =
      SegmentsFor(longest, limits_, constants.fine_segments, options_.segment_length);
  request.segments = is_first ? SegmentsFor(longest, limits_, 1.0, options_.segment_length)
                              : request.near_segments;
  request.pair_end = facts.lands_soon          ? PairEnd::kContact
                     : result_.ends_in_contact ? PairEnd::kRestOrContact
                                               : PairEnd::kRest;
  // The committed side of an obstacle is tried once; if it fails, the map decides anew.
  request.previous = is_first && memory_.planned ? &memory_.next.curve : nullptr;
  request.starts_on_previous = request.previous != nullptr && !result_.from_odometry;
  request.bound = &memory_.bound;
  // Shortly before contact nothing is kept: earlier pairs would push the vehicle there.
  const double left = memory_.next.curve.t_end() - input.t_start;
  request.keeps = request.starts_on_previous &&
                  !(end_.target().leads_to_contact() && left < constants.near_contact);
  request.looks = !request.keeps || input.t_start - memory_.looked_t >= constants.look_every;
  if (request.looks) memory_.looked_t = input.t_start;
  request.log = log_ ? &log_->attempts.emplace_back() : nullptr;
  return request;
}

Replanner::Replanner(const ReplannerOptions& options, const solvers::BackendRegistry& backends) {
  Validate(options);
  impl_ = std::make_unique<Impl>(options, backends);
}
Replanner::~Replanner() = default;

void Replanner::Prepare(const OccupancyMap& map) { impl_->Prepare(map); }

void Replanner::CommitHover(const Eigen::Vector3d& p_W, double t) {
  ControlPoints points(3, 4);
  points.colwise() = p_W;
  ReplannerState hover;
  hover.current.curve = hover.next.curve = UniformBspline(points, 1.0, t);
  impl_->Restore(hover);
}

void Replanner::CommitStop(const FlatState& from, double t) { impl_->CommitStop(from, t); }

const ReplanResult& Replanner::Replan(const ReplanInput& input, const OccupancyMap& map) {
  return impl_->Replan(input, map);
}

const ReplanResult& Replanner::Rest(const ReplanInput& input, double climb,
                                    const OccupancyMap& map) {
  return impl_->Rest(input, climb, map);
}

void Replanner::TakeOverAt(double t) {
  if (std::isnan(t)) throw std::invalid_argument("Replanner: TakeOverAt(NaN), it takes a time");
  impl_->TakeOverAt(t);
}

FlatState Replanner::Reference(double t) const { return impl_->InForce(t).At(t); }

const ReplannerOptions& Replanner::options() const { return impl_->options_; }

const ReplannerState& Replanner::state() const { return impl_->memory_; }

void Replanner::Restore(const ReplannerState& state) { impl_->Restore(state); }

void Replanner::set_log(ReplanLog* log) { impl_->log_ = log; }

}  // namespace touchdown::planning
