// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/replan/attempt_ladder.h"

#include <algorithm>
#include <array>

namespace touchdown::planning {

namespace {

struct Case {
  const Attempt& attempt;
  const Outcome& outcome;
  const AttemptFacts& facts;
  const StepConstants& constants;

  bool first() const { return attempt.number == 0; }
  bool closed() const { return attempt.unseen_reach > 0.0; }
  bool is(ReplanReason reason) const { return outcome.reason == reason; }
  bool free() const { return attempt.arrival == ArrivalMode::kFree; }
  bool slower_helps() const {
    return is(ReplanReason::kLimitsExceeded) || is(ReplanReason::kUnobserved) ||
           is(ReplanReason::kCollisionRemains) || is(ReplanReason::kGoalBlocked) ||
           is(ReplanReason::kBudgetSpent);
  }
};

AttemptDecision Stop(ReplanReason reason) { return {std::nullopt, reason}; }

AttemptDecision Next(const Case& c, void (*change)(const Case& c, Attempt* attempt)) {
  AttemptDecision decision = {c.attempt, ReplanReason::kNone};
  ++decision.next->number;
  change(c, &*decision.next);
  return decision;
}

/// Again a little later: a pad that brakes is not met at the promised arrival.
void LandLater(const Case& c, Attempt* attempt) {
  if (c.facts.arrival == ArrivalMode::kFree && attempt->duration >= c.facts.min_duration) {
    attempt->arrival = ArrivalMode::kFree;
  } else {
    attempt->duration = std::min(c.constants.stretch * attempt->duration, c.facts.max_duration);
  }
}

/// Of a free arrival what it chose, where only limits were exceeded: one that still collides only fled from
/// the pressure of what it hit.
double Tried(const Case& c) {
  const bool fled = c.free() && !c.is(ReplanReason::kLimitsExceeded);
  return fled ? c.attempt.duration : std::max(c.attempt.duration, c.outcome.duration);
}

/// Fixed, and at least as late as a fresh guess: a promise that cannot be kept binds no longer.
void ArriveLater(const Case& c, Attempt* attempt) {
  attempt->arrival = ArrivalMode::kFixed;
  attempt->duration =
      std::min(std::max(c.constants.stretch * Tried(c), c.facts.fresh), c.facts.max_duration);
}

struct Rule {
  bool (*holds)(const Case& c);
  AttemptDecision (*decision)(const Case& c);
};

constexpr std::array kRules = {
    // Before a contact, only one that does not hold is postponed, once: a pad that turns back is never met otherwise.
    Rule{[](const Case& c) { return c.facts.lands_soon && !c.facts.lands_well && c.first(); },
         [](const Case& c) { return Next(c, LandLater); }},
    Rule{[](const Case& c) { return c.facts.lands_soon; },
         [](const Case& c) { return Stop(c.outcome.reason); }},
    // What the last plan led around may be seen by now.
    Rule{[](const Case& c) { return c.first() && c.closed() && !c.is(ReplanReason::kUnobserved); },
         [](const Case& c) {
           return Next(c, [](const Case&, Attempt* r) { r->unseen_reach = 0.0; });
         }},
    // What the stop would have touched unseen is closed, and the same arrival tried again.
    Rule{[](const Case& c) { return !c.closed() && c.is(ReplanReason::kUnobserved); },
         [](const Case& c) {
           return Next(
               c, [](const Case& of, Attempt* r) { r->unseen_reach = of.constants.unseen_reach; });
         }},
    Rule{[](const Case& c) {
           return c.closed() && c.facts.at_rest &&
                  c.attempt.unseen_reach > c.constants.unseen_least;
         },
         [](const Case& c) {
           return Next(
               c, [](const Case& of, Attempt* r) { r->unseen_reach = of.constants.unseen_least; });
         }},
    Rule{[](const Case& c) { return c.closed() && c.facts.at_rest; },
         [](const Case&) { return Stop(ReplanReason::kUnobserved); }},
    // Where the end itself is not seen yet, there is nothing to lead around.
    Rule{[](const Case& c) { return c.closed() && c.is(ReplanReason::kGoalBlocked); },
         [](const Case&) { return Stop(ReplanReason::kUnobserved); }},
    Rule{[](const Case& c) { return c.slower_helps() && Tried(c) < c.facts.max_duration; },
         [](const Case& c) { return Next(c, ArriveLater); }},
    Rule{[](const Case& c) { return !c.slower_helps() && c.free(); },
         [](const Case& c) {
           return Next(c, [](const Case&, Attempt* r) { r->arrival = ArrivalMode::kFixed; });
         }},
};

}  // namespace

AttemptDecision NextAttempt(const Attempt& attempt, const Outcome& outcome,
                            const AttemptFacts& facts, const StepConstants& constants) {
  const Case c = {attempt, outcome, facts, constants};
  const auto rule =
      std::find_if(kRules.begin(), kRules.end(), [&](const Rule& r) { return r.holds(c); });
  if (rule == kRules.end()) return Stop(outcome.reason);
  return rule->decision(c);
}

}  // namespace touchdown::planning
