// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/safety_watch.h"

#include <limits>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

planning::ReplanResult Proven() {
  planning::ReplanResult plan;
  plan.status = planning::ReplanStatus::kPlanned;
  plan.certificate.stops_in_observed_space = true;
  plan.certificate.clear = true;
  return plan;
}

TEST(SafetyWatch, CountsWhatAPairStartsAmong) {
  const sim::ObstacleField nothing;
  SafetyWatch watch(nothing);
  planning::ReplanResult plan = Proven();
  watch.Step(plan, {});
  plan.certificate.start_cells = {true, false, true};
  watch.Step(plan, {});
  plan.certificate.start_cells = {true, true, true};
  watch.Step(plan, {});
  plan.certificate.start_cells = {false, true, true};
  watch.Step(plan, {});
  plan.certificate.start_cells = {false, false, true};
  watch.Step(plan, {});
  plan = Proven();
  plan.status = planning::ReplanStatus::kEscaping;  // out of a zone, among neither
  watch.Step(plan, {});
  plan = Proven();
  plan.certificate.clear = false;  // nearer to an obstacle than plans are
  watch.Step(plan, {});
  const SafetyFigures& figures = watch.figures();
  EXPECT_EQ(figures.escaping_steps, 4);
  EXPECT_EQ(figures.escaping_hit_steps, 2);
  EXPECT_EQ(figures.escaping_unknown_steps, 2);
  EXPECT_EQ(figures.narrow_steps, 2);
  EXPECT_EQ(figures.uncertified_steps, 0);
}

TEST(SafetyWatch, CountsStopsOnceAndEveryStepWithoutAProof) {
  const sim::ObstacleField nothing;
  SafetyWatch watch(nothing);
  planning::ReplanResult stop = Proven();
  stop.status = planning::ReplanStatus::kBraking;
  stop.t_stop = 1.0;
  for (int i = 0; i < 3; ++i) watch.Step(stop, {});
  watch.Step(Proven(), {});
  stop.certificate.stops_in_observed_space = false;
  for (int i = 0; i < 2; ++i) watch.Step(stop, {});
  EXPECT_EQ(watch.figures().stops_flown, 2);
  EXPECT_EQ(watch.figures().uncertified_steps, 2);
  // A stop that is wanted is a new pair; an answer that comes late is none.
  stop = Proven();
  stop.status = planning::ReplanStatus::kBraking;
  stop.t_stop = std::numeric_limits<double>::infinity();
  stop.committed = true;
  watch.Step(Proven(), {});
  watch.Step(stop, {}, true);
  stop.committed = false;  // it goes on
  watch.Step(stop, {});
  EXPECT_EQ(watch.figures().stops_flown, 2);
  EXPECT_EQ(watch.figures().uncertified_steps, 3);
}

// A margin that has grown since does not count for a pair that was proven with a smaller one.
TEST(SafetyWatch, TheErrorCountsAgainstTheMarginsOfThePairThatIsFlown) {
  const sim::ObstacleField nothing;
  SafetyWatch watch(nothing);
  planning::ReplanResult plan = Proven();
  plan.committed = true;
  watch.Step(plan, {0.0, 0.0, 0.05});
  plan.committed = false;
  plan.status = planning::ReplanStatus::kKept;
  watch.Step(plan, {0.0, 0.0, 0.5});
  watch.Tracked({0.1, 0, 0}, {0.1, 0, 0}, {0, 0, 0});
  EXPECT_EQ(watch.figures().tracking_events, 1);
}

}  // namespace
}  // namespace touchdown::evaluation
