// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/replan/attempt_ladder.h"

#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "planning/test/planning_fixtures.h"

namespace touchdown::planning {
namespace {

constexpr ReplanReason kReasons[] = {
    ReplanReason::kStartBlocked,     ReplanReason::kGoalBlocked,    ReplanReason::kSearchFailed,
    ReplanReason::kCollisionRemains, ReplanReason::kLimitsExceeded, ReplanReason::kSolverFailed,
    ReplanReason::kEndTooFast,       ReplanReason::kUnobserved,     ReplanReason::kBudgetSpent};

AttemptFacts UsualFacts() {
  AttemptFacts facts;
  facts.arrival = ArrivalMode::kFree;
  facts.fresh = 4.0;
  facts.min_duration = 0.8;
  facts.max_duration = 30.0;
  return facts;
}

Attempt UsualRung(ArrivalMode arrival = ArrivalMode::kFree) {
  Attempt attempt;
  attempt.duration = 5.0;
  attempt.arrival = arrival;
  return attempt;
}

// Whatever happens: it ends, nothing is tried twice, arrivals are never earlier nor later than allowed.
TEST(AttemptLadder, EndsAndNeverTriesTheSameTwice) {
  Draw draw(7);
  const StepConstants constants;
  for (int trial = 0; trial < 2000; ++trial) {
    AttemptFacts facts = UsualFacts();
    facts.lands_soon = draw.Uniform(0, 1) < 0.2;
    facts.lands_well = facts.lands_soon && draw.Uniform(0, 1) < 0.5;
    facts.at_rest = !facts.lands_soon && draw.Uniform(0, 1) < 0.5;
    facts.fresh = draw.Uniform(1, 29);
    Attempt attempt =
        UsualRung(draw.Uniform(0, 1) < 0.5 ? ArrivalMode::kFree : ArrivalMode::kFixed);
    attempt.duration = draw.Uniform(0.5, 30.0);
    attempt.unseen_reach =
        !facts.lands_soon && draw.Uniform(0, 1) < 0.3 ? constants.unseen_reach : 0.0;
    int attempts = 1;
    std::set<std::tuple<double, ArrivalMode, double>> tried;
    for (;; ++attempts) {
      ASSERT_LE(attempts, 16);  // 1.4 to the power of 13 is the longest duration over the shortest
      const Outcome outcome = {kReasons[static_cast<int>(draw.Uniform(0, std::size(kReasons)))],
                               draw.Uniform(0.5, 30.0)};
      const AttemptDecision decision = NextAttempt(attempt, outcome, facts, constants);
      if (!decision.next) {
        EXPECT_NE(decision.reason, ReplanReason::kNone);
        break;
      }
      EXPECT_EQ(decision.next->number, attempt.number + 1);
      EXPECT_GE(decision.next->duration, attempt.duration);
      EXPECT_LE(decision.next->duration, facts.max_duration);
      // An attempt that failed with the committed plan may be repeated without it.
      const Attempt& next = *decision.next;
      EXPECT_TRUE(tried.insert({next.duration, next.arrival, next.unseen_reach}).second);
      if (attempt.arrival == ArrivalMode::kFixed && !facts.lands_soon) {
        EXPECT_EQ(decision.next->arrival, ArrivalMode::kFixed);
      }
      attempt = *decision.next;
    }
    if (facts.lands_soon) {
      EXPECT_LE(attempts, facts.lands_well ? 1 : 2);
    }
  }
}

TEST(AttemptLadder, ArrivesLaterAndFixedAfterACollision) {
  const StepConstants constants;
  const AttemptFacts facts = UsualFacts();
  const Outcome outcome = {ReplanReason::kCollisionRemains, 9.0};
  const AttemptDecision free = NextAttempt(UsualRung(), outcome, facts, constants);
  ASSERT_TRUE(free.next);
  EXPECT_EQ(free.next->arrival, ArrivalMode::kFixed);
  EXPECT_DOUBLE_EQ(free.next->duration, 1.4 * 5.0);  // it only fled to 9 s
  const AttemptDecision fixed =
      NextAttempt(UsualRung(ArrivalMode::kFixed), outcome, facts, constants);
  ASSERT_TRUE(fixed.next);
  EXPECT_DOUBLE_EQ(fixed.next->duration, 1.4 * 9.0);  // the way around took so long
  const AttemptDecision limits =
      NextAttempt(UsualRung(), {ReplanReason::kLimitsExceeded, 9.0}, facts, constants);
  ASSERT_TRUE(limits.next);
  EXPECT_DOUBLE_EQ(limits.next->duration, 1.4 * 9.0);
  AttemptFacts late = facts;
  late.fresh = 20.0;
  EXPECT_DOUBLE_EQ(NextAttempt(UsualRung(), outcome, late, constants).next->duration, 20.0);
  Attempt last = UsualRung(ArrivalMode::kFixed);
  last.duration = facts.max_duration;
  EXPECT_FALSE(NextAttempt(last, outcome, facts, constants).next);
}

TEST(AttemptLadder, ClosesWhatWasNotSeenAndOpensItAgain) {
  const StepConstants constants;
  AttemptFacts facts = UsualFacts();
  const Outcome unseen = {ReplanReason::kUnobserved, 5.0};
  const AttemptDecision closed = NextAttempt(UsualRung(), unseen, facts, constants);
  ASSERT_TRUE(closed.next);
  EXPECT_EQ(closed.next->unseen_reach, constants.unseen_reach);
  EXPECT_EQ(closed.next->duration, 5.0);
  EXPECT_EQ(closed.next->arrival, ArrivalMode::kFree);
  // In flight a later arrival is tried then; from rest a smaller zone, and that is all.
  EXPECT_GT(NextAttempt(*closed.next, unseen, facts, constants).next->duration, 5.0);
  facts.at_rest = true;
  const AttemptDecision less = NextAttempt(*closed.next, unseen, facts, constants);
  ASSERT_TRUE(less.next);
  EXPECT_EQ(less.next->unseen_reach, constants.unseen_least);
  const AttemptDecision end =
      NextAttempt(*less.next, {ReplanReason::kCollisionRemains, 5.0}, facts, constants);
  EXPECT_FALSE(end.next);
  EXPECT_EQ(end.reason, ReplanReason::kUnobserved);
  // What the last plan led around may be seen by now.
  Attempt before = UsualRung();
  before.unseen_reach = constants.unseen_reach;
  const AttemptDecision open =
      NextAttempt(before, {ReplanReason::kSearchFailed, 5.0}, facts, constants);
  ASSERT_TRUE(open.next);
  EXPECT_EQ(open.next->unseen_reach, 0.0);
}

TEST(AttemptLadder, BeforeAContactNothingIsPutOffButOnce) {
  const StepConstants constants;
  AttemptFacts facts = UsualFacts();
  facts.lands_soon = true;
  const Outcome outcome = {ReplanReason::kLimitsExceeded, 1.0};
  Attempt attempt = UsualRung(ArrivalMode::kFixed);
  attempt.duration = 1.0;
  const AttemptDecision free = NextAttempt(attempt, outcome, facts, constants);
  ASSERT_TRUE(free.next);
  EXPECT_EQ(free.next->arrival, ArrivalMode::kFree);
  EXPECT_EQ(free.next->duration, 1.0);
  EXPECT_FALSE(NextAttempt(*free.next, outcome, facts, constants).next);
  attempt.duration = 0.5;  // too short for a free one
  const AttemptDecision later = NextAttempt(attempt, outcome, facts, constants);
  ASSERT_TRUE(later.next);
  EXPECT_EQ(later.next->arrival, ArrivalMode::kFixed);
  EXPECT_DOUBLE_EQ(later.next->duration, 0.7);
  facts.lands_well = true;  // what is committed holds
  EXPECT_FALSE(NextAttempt(attempt, outcome, facts, constants).next);
}

}  // namespace
}  // namespace touchdown::planning
