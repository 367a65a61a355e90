// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/forest_flight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/studies/replan/forest_flight_report.h"

namespace touchdown::evaluation {
namespace {

ForestFlightOptions OfKind(const std::string& kind, bool ego = false) {
  ForestFlightOptions options;
  options.kind = SceneKindNamed(kind);
  options.ego = ego;
  return options;
}

TEST(ForestFlight, ReachesTheGoalWithinTheLimitsAndTwiceAlike) {
  const ForestFlightOptions options = OfKind("B");
  const ForestFlight a = FlyThroughForest(options, solvers::StandardBackends(), 1);
  EXPECT_EQ(a.outcome, FlightOutcome::kReached) << ToString(a.outcome) << " " << a.message;
  // From within kGoalRadius of it, the straight way is 36 m.
  EXPECT_GT(a.length, 35.5);
  EXPECT_LT(a.length, 45.0);
  EXPECT_GT(a.clearance, options.kind.inflation);
  EXPECT_LE(a.max_speed, options.kind.limits.speed + 1e-6);
  EXPECT_LE(a.max_acceleration, options.kind.limits.acceleration + 1e-6);
  EXPECT_GT(a.plans, 100);
  const ForestFlight b = FlyThroughForest(options, solvers::StandardBackends(), 1);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.clearance, b.clearance);
  EXPECT_EQ(a.others, b.others);
  EXPECT_NE(FlyThroughForest(options, solvers::StandardBackends(), 2).length, a.length);
}

TEST(ForestFlight, TheBaselineEndsInANamedWay) {
  ForestFlightPart part{OfKind("B", true), {}};
  for (int index = 0; index < 2; ++index) {
    part.flights.push_back(FlyThroughForest(part.options, solvers::StandardBackends(), index));
    EXPECT_NE(part.flights.back().outcome, FlightOutcome::kCrashed) << part.flights.back().message;
    EXPECT_GT(part.flights.back().plans, 5);
  }
  const FlightSummary summary = Summarise(part.flights);
  EXPECT_EQ(summary.flights, 2);
  EXPECT_GT(summary.steps, 10);
  EXPECT_THAT(ForestFlightText({part}), ::testing::HasSubstr("kind B, ego: reached"));
  EXPECT_EQ(ForestFlightJson({part})["flights"][0]["planner"], "ego");
}

TEST(ForestFlight, OutcomesAreCounted) {
  std::vector<ForestFlight> flights(4);
  flights[0].outcome = FlightOutcome::kReached;
  flights[1].outcome = FlightOutcome::kCollided;
  flights[2].outcome = FlightOutcome::kReached;
  flights[3].others["kept, collision_remains"] = 3;
  FlightSummary summary = Summarise(flights);
  EXPECT_EQ(summary.outcomes[FlightOutcome::kReached], 2);
  EXPECT_EQ(summary.outcomes[FlightOutcome::kCollided], 1);
  EXPECT_EQ(summary.outcomes[FlightOutcome::kStuck], 1);
  EXPECT_EQ(summary.failed, 3);
  EXPECT_LT(summary.reached.hi, 1.0);
}

}  // namespace
}  // namespace touchdown::evaluation
