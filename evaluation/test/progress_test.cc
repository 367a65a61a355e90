// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/progress.h"

#include <gtest/gtest.h>

#include "evaluation/campaign/campaign_progress.h"

namespace touchdown::evaluation {
namespace {

TEST(Progress, LineTellsWhatIsLeftAtTheRateSoFar) {
  EXPECT_EQ(ProgressLine({.things = "flights"}, 5, 20, 4.0), "5 of 20 flights, 12 s left");
  EXPECT_EQ(ProgressLine({.things = "scenes", .of = "kind C"}, 20, 20, 4.0),
            "kind C: 20 of 20 scenes, 0 s left");
}

TEST(Progress, ALineOfACampaignCountsItsRateWithoutWhatWasFlownBefore) {
  CampaignState state;
  state.all = 20;
  state.resumed = state.flown = 6;
  state.succeeded = 5;
  EXPECT_EQ(CampaignLine(state, 0.0), "6 of 20 trials, 5 succeeded and 1 failed");
  state.flown = 10;
  state.succeeded = 8;
  EXPECT_EQ(CampaignLine(state, 8.0),
            "10 of 20 trials, 8 succeeded and 2 failed, 0.50 a second, 20 s left");
}

}  // namespace
}  // namespace touchdown::evaluation
