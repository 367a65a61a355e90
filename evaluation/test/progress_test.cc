// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/progress.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(Progress, LineTellsWhatIsLeftAtTheRateSoFar) {
  EXPECT_EQ(ProgressLine({.things = "flights"}, 5, 20, 4.0), "5 of 20 flights, 12 s left");
  EXPECT_EQ(ProgressLine({.things = "scenes", .of = "kind C"}, 20, 20, 4.0),
            "kind C: 20 of 20 scenes, 0 s left");
  EXPECT_EQ(ProgressLine({.things = "trials", .with_rate = true}, 1, 3, 4.0),
            "1 of 3 trials, 0.25 trials/s, 8 s left");
}

}  // namespace
}  // namespace touchdown::evaluation
