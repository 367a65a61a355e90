// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/failure_words.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(FailureWords, TheReasonThatStoodMostIsNamedNotTheLast) {
  TrialResult result;
  result.replans = 300;
  EXPECT_EQ(NoPlanSentence(result, ""), "");
  result.replans_by_reason = {{"goal_blocked", 120}, {"unobserved", 1}};
  EXPECT_EQ(NoPlanSentence(result, "unobserved"),
            " No new plan in 121 of 300 steps, most for goal_blocked, at last for unobserved.");
  EXPECT_EQ(NoPlanSentence(result, ""), " No new plan in 121 of 300 steps, most for goal_blocked.");
  result.replans_by_reason = {{"limits_exceeded", 40}};
  result.replans_forbidden_by = {{"reach", 40}};
  EXPECT_EQ(
      NoPlanSentence(result, "limits_exceeded"),
      " No new plan in 40 of 300 steps, for limits_exceeded; in 40 a plan was forbidden by reach.");
  result.replans_forbidden_by = {{"limits.speed", 3}, {"reach", 37}};
  EXPECT_EQ(NoPlanSentence(result, "limits_exceeded"),
            " No new plan in 40 of 300 steps, for limits_exceeded; in 40 a plan was forbidden, "
            "most by reach.");
}

TEST(FailureWords, NoWayIsSaidWithWhatWasTried) {
  TrialResult result;
  EXPECT_EQ(NoWaySentence(result), "");
  result.no_way = {12.34, 1, {}, 1.1};
  EXPECT_EQ(NoWaySentence(result),
            " From 12.3 s on the vehicle knew no way: after 1 look, what it had seen closed every "
            "way.");
  result.no_way = {12.34, 4, planning::NarrowPlace{{4.0, 0.1, 0.7}, 0.9}, 1.1};
  EXPECT_EQ(
      NoWaySentence(result),
      " From 12.3 s on the vehicle knew no way: after 4 looks, what it had seen closed every "
      "way. The widest passage that may be left is 0.9 m wide, at [4.0, 0.1, 0.7] m; 1.1 m between "
      "seen cells are needed.");
}

TEST(FailureWords, WhatTheLandingConditionLackedMostAndAtTheEnd) {
  TrialResult result;
  EXPECT_EQ(GateSentence(result, "no_pad"), "");
  result.gate_steps = {{"open", 500}};
  EXPECT_EQ(GateSentence(result, "open"), "");
  result.gate_steps = {{"tags_unseen", 800}};
  EXPECT_EQ(GateSentence(result, "tags_unseen"),
            " The landing condition was never open, for tags_unseen.");
  result.gate_steps = {{"no_pad", 100}, {"open", 200}, {"tags_unseen", 700}};
  EXPECT_EQ(GateSentence(result, "no_pad"),
            " The landing condition was closed in 800 of 1000 steps, most for tags_unseen, at the "
            "end for no_pad.");
  EXPECT_EQ(GateSentence(result, "open"),
            " The landing condition was closed in 800 of 1000 steps, most for tags_unseen, and "
            "open at the end.");
}

}  // namespace
}  // namespace touchdown::evaluation
