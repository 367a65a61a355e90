// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/trial_store.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/judge/stand_watch.h"
#include "evaluation/judge/truth_map.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/studies/hostile/hostile_conditions.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_report.h"
#include "evaluation/studies/hostile/hostile_study.h"
#include "evaluation/studies/hostile/hostile_tally.h"
#include "evaluation/studies/hostile/hostile_way.h"
#include "evaluation/studies/hostile/hostile_world.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;

const Registries kRegistries = StandardRegistries();
constexpr int kDraws = 240;  // of all families: 20 of each, more or less

const std::vector<HostileFlight>& Draws() {
  static const std::vector<HostileFlight> flights = [] {
    HostileOptions options;
    options.flights = kDraws;
    options.share_beyond = 0.4;
    return DrawHostileFlights(options, 2, kRegistries);
  }();
  return flights;
}

bool Beyond(const HostileFlight& flight, const std::string& name) {
  return std::count(flight.beyond.begin(), flight.beyond.end(), name) > 0;
}

HostileOptions Of(const std::string& family) {
  HostileOptions options;
  options.families = {family};
  options.share_beyond = 0.0;
  return options;
}

TEST(HostileDraw, RepeatsWhateverTheJobsAndTheNumberOfFlights) {
  HostileOptions options;
  options.flights = 12;
  const auto one = DrawHostileFlights(options, 1, kRegistries);
  const auto three = DrawHostileFlights(options, 3, kRegistries);
  options.flights = 500;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const HostileFlight alone = DrawHostileFlight(options, static_cast<int>(i), kRegistries);
    for (const HostileFlight* other : {&three[i], &alone}) {
      EXPECT_EQ(DumpScenario(one[i].trial.scenario), DumpScenario(other->trial.scenario));
      EXPECT_EQ(one[i].trial.varied, other->trial.varied);
      EXPECT_EQ(one[i].trial.Replay(), other->trial.Replay());
    }
  }
}

TEST(HostileDraw, EveryFamilyAndBothSidesOfTheAssumptionsOccur) {
  std::set<std::string> families;
  int beyond = 0;
  for (const HostileFlight& flight : Draws()) {
    families.insert(flight.family);
    beyond += flight.beyond.empty() ? 0 : 1;
    EXPECT_LE(flight.beyond.size(), 3U);
  }
  EXPECT_EQ(families.size(), HostileFamilies().size());
  EXPECT_NEAR(beyond, 0.4 * kDraws, 0.1 * kDraws);
}

TEST(HostileDraw, ConditionsAreInTheRangeThatTheyAreSaidToBeIn) {
  for (const HostileFlight& flight : Draws()) {
    SCOPED_TRACE(flight.trial.scenario.name);
    const Scenario& s = flight.trial.scenario;
    const auto in = [&](const char* name, double value, const Span& within, const Span& out) {
      const Span& range = Beyond(flight, name) ? out : within;
      EXPECT_GE(value, range.lo) << name;
      EXPECT_LE(value, range.hi) << name;
    };
    in("noise", s.depth.noise, {0.0, 0.02}, {0.02, 0.05});
    in("depth_rate", s.depth_rate, {5.0, 15.0}, {2.0, 5.0});
    in("drop", s.depth.drop, {0.0, 0.95}, {0.95, 0.99});
    in("depth_latency", s.depth.latency_ms, {0.0, 200.0}, {200.0, 400.0});
    in("planning_rate", s.planning.rate, {5.0, 15.0}, {2.0, 5.0});
    in("pixels", s.depth.width, {80.0, 80.0}, {40.0, 40.0});
    in("wind", s.wind.mean, {0.0, 11.0}, {11.0, 14.0});
    in("wind", s.wind.max, {s.wind.mean, 15.0}, {s.wind.mean, 20.0});
    in("pad_gps", s.gps.sigma, {0.01, 1.0}, {1.0, 2.0});
    in("own_sensors", s.own.gps.sigma, {0.02, 0.02}, {0.05, 0.2});
    in("plant", std::abs(s.plant.mass - 1.0), {0.0, 0.2}, {0.2, 0.3});
    EXPECT_LE(s.planning.latency.ms, std::min(200.0, 1e3 / s.planning.rate));
    EXPECT_GE(s.limits.acceleration, 0.5);
    EXPECT_LE(s.limits.acceleration, 6.87);
    const double images = 1.0 - s.depth.drop;
    EXPECT_NEAR(s.stand_limit, std::min(600.0, 15.0 / images), 1e-9);
    if (flight.family == "far") {
      EXPECT_GT(s.timeout, std::min(599.0, 100.0 / images));
    } else {
      EXPECT_NEAR(s.timeout, std::min(600.0, 100.0 / images), 1.0);
    }
  }
}

TEST(HostileDraw, TheStartIsFreeUnlessItIsBeyondAndThePadsLaneIsClear) {
  for (const HostileFlight& flight : Draws()) {
    SCOPED_TRACE(flight.trial.scenario.name);
    const double room = StartRoom(flight.trial.scenario);
    if (Beyond(flight, kNearObstacle)) {
      EXPECT_GE(room, 0.4 - 1e-9);
      EXPECT_LE(room, 0.8 + 1e-9);
    } else {
      EXPECT_GE(room, kTakeOffRoom - 1e-9);
    }
    EXPECT_TRUE(
        LaneIsClear(flight.trial.scenario, StandardRegistries(), flight.trial.scenario.timeout));
  }
}

TEST(HostileDraw, PolesAreAsThinAsThePlannerIsPromisedOrBeyond) {
  HostileOptions options = Of("poles");
  options.share_beyond = 0.5;
  options.flights = 40;
  int thin = 0;
  for (const HostileFlight& flight : DrawHostileFlights(options, 2, kRegistries)) {
    const bool beyond = Beyond(flight, kThinPoles);
    thin += beyond ? 1 : 0;
    const std::size_t poles =
        flight.trial.scenario.cylinders.size() - (Beyond(flight, kNearObstacle) ? 1U : 0U);
    for (std::size_t i = 0; i < poles; ++i) {
      const double diameter = 2.0 * flight.trial.scenario.cylinders[i].radius;
      EXPECT_GE(diameter, (beyond ? kThinnestPole : kPromisedPole) - 1e-12);
      EXPECT_LE(diameter, (beyond ? kPromisedPole : kThickestPole) + 1e-12);
    }
  }
  EXPECT_GT(thin, 0);
}

TEST(HostileDraw, LowWallsAreLowAndBesideTheDeck) {
  HostileOptions options = Of("low_wall");
  options.flights = 20;
  for (const HostileFlight& flight : DrawHostileFlights(options, 2, kRegistries)) {
    for (const NamedObstacle& low : ObstaclesOf(flight.trial.scenario)) {
      EXPECT_GE(sim::BoundsOf(low.obstacle).max.z(), 0.2 - 1e-9);
      EXPECT_LE(sim::BoundsOf(low.obstacle).max.z(), 0.8 + 1e-9);
    }
  }
}

TEST(HostileDraw, WhatIsSetIsTheSameInEveryFlightAndNeverBeyond) {
  HostileOptions options;
  options.flights = 30;
  options.share_beyond = 1.0;
  options.set = {"depth.drop=0.9", "planning.rate=20"};
  for (const HostileFlight& flight : DrawHostileFlights(options, 2, kRegistries)) {
    const Scenario& s = flight.trial.scenario;
    EXPECT_EQ(s.depth.drop, 0.9);
    EXPECT_NEAR(s.timeout, 600.0, 1.0);
    EXPECT_LE(s.planning.latency.ms, 50.0);
    EXPECT_FALSE(Beyond(flight, "drop"));
    EXPECT_FALSE(Beyond(flight, "planning_rate"));
    EXPECT_THAT(flight.trial.Replay(),
                HasSubstr("--set depth.drop=0.9 --set planning.rate=20 --show"));
  }
  for (const char* wrong : {"depth.drp=0.9", "depth.drop", "seed=3", "depth.drop=2",
                            "obstacles.boxes=[]", "obstacles={boxes: []}", "depth={drop: 0.9}"}) {
    options.set = {wrong};
    EXPECT_THROW(DrawHostileFlight(options, 0, kRegistries), BadInput) << wrong;
  }
}

TEST(HostileDraw, AWayExistsInThreeOfFourFlightsWithin) {
  int within = 0, ways = 0;
  for (const HostileFlight& flight : Draws()) {
    if (!flight.beyond.empty()) continue;
    ++within;
    ways += flight.way.exists ? 1 : 0;
  }
  EXPECT_GE(ways, 0.75 * within);
}

// The pad stands 8 m ahead; a room of 6 m x 6 m is around the start, with a door of `opening` ahead.
Scenario Room(double opening) {
  Scenario s;
  StartAt(0.0, 0.0, 2.0, 0.0, &s);
  s.planning.ceiling = kLowCeiling;
  s.pad.motion = "static";
  s.pad.start << 8.0, 0.0;
  AddWall({-3.2, 3.2}, {3.0, 3.2}, &s);
  AddWall({-3.2, 3.2}, {-3.2, -3.0}, &s);
  AddWall({-3.2, -3.0}, {-3.2, 3.2}, &s);
  AddWall({3.0, 3.2}, {0.5 * opening, 3.2}, &s);
  AddWall({3.0, 3.2}, {-3.2, -0.5 * opening}, &s);
  return s;
}

TEST(HostileWayTest, ClearanceGrowsWithWhatTheVehicleDoesNotKnow) {
  Scenario s;
  EXPECT_DOUBLE_EQ(WayClearance(s), 0.55);
  s.wind.mean = 4.0;
  EXPECT_DOUBLE_EQ(WayClearance(s), 0.55);
  s.wind.max = 6.0;
  EXPECT_DOUBLE_EQ(WayClearance(s), 0.70);
  s.own_state = OwnStateKind::kEstimated;
  EXPECT_DOUBLE_EQ(WayClearance(s), 0.85);
  s.wind.max = s.wind.mean = 0.0;
  EXPECT_DOUBLE_EQ(WayClearance(s), 0.70);
}

TEST(HostileWayTest, ADoorIsWideEnoughOrNot) {
  Scenario s = Room(1.4);
  const HostileWay way = FindWay(s, StandardRegistries(), 45.0);
  EXPECT_TRUE(way.exists);
  EXPECT_GT(way.length, 7.5);
  EXPECT_LT(way.length, 10.0);
  s.own_state = OwnStateKind::kEstimated;
  EXPECT_FALSE(FindWay(s, StandardRegistries(), 45.0).exists);
  EXPECT_FALSE(FindWay(Room(0.0), StandardRegistries(), 45.0).exists);
  EXPECT_FALSE(FindWay(Room(0.9), StandardRegistries(), 45.0).exists);
}

TEST(HostileWayTest, ARoofMayBeTooLowAndAPadTooFar) {
  Scenario s = Room(3.0);
  AddBox({6.0, 10.0}, {-2.0, 2.0}, 1.4, 1.6, &s);
  EXPECT_FALSE(FindWay(s, StandardRegistries(), 45.0).exists);
  s.boxes.back().base = 2.6;
  EXPECT_TRUE(FindWay(s, StandardRegistries(), 45.0).exists);
  EXPECT_FALSE(FindWay(s, StandardRegistries(), 10.0).exists);  // no time to fly there and to land
  s.pad.motion = "line";
  s.pad.speed = 3.0;
  EXPECT_FALSE(FindWay(s, StandardRegistries(), 45.0).exists);
}

TEST(HostileWorld, TurningItKeepsWhatBelongsTogether) {
  for (int i = 0; i < 16; ++i) {
    Scenario s = Room(1.8);
    s.pad.motion = "figure_eight";
    s.pad.turn_rate = 0.3;
    const HostileWay before = FindWay(s, StandardRegistries(), 45.0);
    const double room = StartRoom(s);
    const auto lane = PadCourseOf(s, StandardRegistries(), 0.0, 0);
    sim::RandomStream draw(static_cast<std::uint64_t>(i), "turn");
    TurnWorld(draw, &s);
    const auto turned = PadCourseOf(s, StandardRegistries(), 0.0, 0);
    EXPECT_NEAR(StartRoom(s), room, 1e-9);
    EXPECT_EQ(FindWay(s, StandardRegistries(), 45.0).exists, before.exists);
    const auto from_start = [](const sim::PadCourse& course, const Eigen::Vector3d& start) {
      return (course.At(7.0).p_WP - start).head<2>().norm();
    };
    EXPECT_NEAR(from_start(*turned, s.start.position), from_start(*lane, {0.0, 0.0, 0.0}), 1e-9);
  }
}

TEST(StandWatch, NeedsAnImageAPlaceAndNoPlan) {
  const Eigen::Vector3d here(1.0, 2.0, 3.0), there(1.6, 2.0, 3.0);
  StandWatch never(0.0);
  StandWatch watch(5.0);
  never.Image();
  EXPECT_FALSE(never.Stands(100.0, here));
  EXPECT_FALSE(watch.Stands(0.0, here));
  EXPECT_FALSE(watch.Stands(6.0, here));  // nothing was seen meanwhile
  watch.Image();
  EXPECT_TRUE(watch.Stands(6.1, here));
  watch.Planned();
  EXPECT_FALSE(watch.Stands(6.2, here));
  watch.Image();
  EXPECT_FALSE(watch.Stands(11.0, here));
  EXPECT_FALSE(watch.Stands(11.1, there));  // it moved on
  watch.Image();
  EXPECT_FALSE(watch.Stands(16.0, there));
  EXPECT_TRUE(watch.Stands(16.2, there));
}

SweepRow RowOf(Outcome outcome, const std::string& cause) {
  SweepRow row;
  row.trial.varied = {
      {"family", "door"}, {"assumptions", "within"}, {"beyond", "none"}, {"way", "yes"}};
  row.result.outcome = outcome;
  row.result.cause = cause;
  if (outcome == Outcome::kLanded) row.result.touchdown.emplace();
  return row;
}

TEST(HostileTallyTest, TellsWhatStandsFromThePad) {
  const std::vector<SweepRow> rows = {
      RowOf(Outcome::kLanded, ""),          RowOf(Outcome::kCollision, "obstacle 3"),
      RowOf(Outcome::kCollision, "ground"), RowOf(Outcome::kCollision, "hull-deck"),
      RowOf(Outcome::kTipOver, ""),         RowOf(Outcome::kStood, "unobserved"),
      RowOf(Outcome::kInfeasible, ""),      RowOf(Outcome::kHung, "")};
  const HostileTally tally = TallyOf(rows, "door", true);
  EXPECT_EQ(tally.flights, 8);
  EXPECT_EQ(tally.collisions, 2);
  EXPECT_EQ(tally.contacts, (std::map<std::string, int>{{"hull-deck", 1}, {"tip_over", 1}}));
  EXPECT_EQ(tally.stood, (std::map<std::string, int>{{"unobserved", 1}}));
  EXPECT_EQ(tally.seeing_landed, 1);
  EXPECT_EQ(tally.timeouts, 1);
  EXPECT_EQ(tally.lost, 1);
  EXPECT_EQ(TallyOf(rows, "", false).flights, 0);
  EXPECT_EQ(RateText(0, 0), "0 of 0");
}

TEST(HostileReport, PageAndDocumentNameWhatWasFlown) {
  HostileOptions options = Of("roof");
  options.flights = 1;
  const auto flights = DrawHostileFlights(options, 1, kRegistries);
  SweepRow row;
  row.trial = HostileCampaign(options, flights).trials.front();
  row.result.outcome = Outcome::kCollision;
  row.result.cause = "obstacle 0";
  row.result.detail = "It touched <something>.";
  const std::string page =
      HostilePage(options, {row}, {{row.trial.index, "f/3.html"}}, StandardRegistries());
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("<a href='f/3.html'>"));
  EXPECT_THAT(page, HasSubstr("It touched &lt;something&gt;."));
  EXPECT_THAT(page, HasSubstr("--families roof"));
  const auto json = HostileJson(options, {row});
  EXPECT_EQ(json["within"]["collisions"], 1);
  EXPECT_EQ(json["families"].size(), 1U);
  EXPECT_EQ(json["results"][0]["replay"], row.trial.Replay());
  EXPECT_THAT(HostileText(options, {row}), HasSubstr("Collisions with what stands: 1"));
}

// Flights that did not land are found again. The page has the same safety figures as the text.
TEST(HostileReport, WhatStoodIsListed) {
  const HostileOptions options = Of("roof");
  SweepRow row;
  row.trial = HostileCampaign(options, {DrawHostileFlight(options, 3, kRegistries)}).trials.front();
  row.result.outcome = Outcome::kStood;
  row.result.cause = "search_failed";
  row.result.safety.emplace().uncertified_steps = 7;
  for (const std::string& report :
       {HostileText(options, {row}), HostilePage(options, {row}, {}, StandardRegistries())}) {
    EXPECT_THAT(report, HasSubstr("Stood, or out of time"));
    EXPECT_THAT(report, HasSubstr("--show 3"));
    EXPECT_THAT(report, HasSubstr("uncertified steps"));
  }
  EXPECT_TRUE(ViolatesGuarantee({row}));
  row.result.outcome = Outcome::kDisarmedInAir;
  EXPECT_THAT(HostileText(options, {row}), HasSubstr("Ended otherwise: 1"));
}

TEST(HostileReport, TheDocumentHasTheFamiliesAndTheConditions) {
  std::ifstream file(TOUCHDOWN_SOURCE_DIR "/docs/reference/hostile_worlds.md");
  std::ostringstream text;
  text << file.rdbuf();
  for (const HostileFamily& f : HostileFamilies()) {
    EXPECT_THAT(text.str(),
                HasSubstr(fmt::format("| `{}` | {} | {} |\n", f.name, f.what, f.ranges)));
  }
  for (const HostileCondition& c : HostileConditions()) {
    EXPECT_THAT(text.str(),
                HasSubstr(fmt::format("| `{}` | {} | {} |\n", c.keys, c.within, c.beyond)));
  }
}

// Flights: in the closed-loop tests.

TEST(HostileFlightTest, AVehicleThatIsShutInStandsAndSaysWhy) {
  Scenario s = Room(0.0);
  s.timeout = 90.0;
  s.stand_limit = 4.0;
  // They look around in the room first, some for a while, by plans that they do not complete.
  int soon = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const TrialResult stood = RunTrial(s, seed, kRegistries);
    EXPECT_EQ(stood.outcome, Outcome::kStood) << "seed " << seed << ": " << stood.detail;
    EXPECT_FALSE(stood.cause.empty()) << seed;
    soon += stood.simulated_s < 45.0;
  }
  EXPECT_GE(soon, 4);
  s.stand_limit = 0.0;
  s.timeout = 10.0;
  const TrialResult waited = RunTrial(s, 1, kRegistries);
  EXPECT_TRUE(waited.outcome == Outcome::kInfeasible || waited.outcome == Outcome::kTimeout)
      << waited.detail;
  EXPECT_NEAR(waited.simulated_s, 10.0, 0.01);
}

const std::vector<std::string> kOldFamilies = {"dead_end",     "door",       "zigzag",     "walls",
                                               "blind_corner", "overhang",   "low_wall",   "poles",
                                               "facing_wall",  "near_start", "wide_field", "roof"};
const std::vector<std::string> kNewFamilies = {
    "below", "clearing", "niche", "garage", "limbo", "wide_wall", "far", "two_floors", "skylight"};

TrialResult Flown(const std::vector<std::string>& families, std::uint64_t seed, int number) {
  HostileOptions options;
  options.share_beyond = 0.0;
  options.seed = seed;
  options.families = families;
  const HostileFlight flight = DrawHostileFlight(options, number, kRegistries);
  return RunTrial(flight.trial.scenario, flight.trial.seed, kRegistries);
}

// 4 cm above the deck it leant a little too far, gave up, touched in spite of the climb, and bounced off.
TEST(HostileFlightTest, AClimbThatComesTooLateIsNotBegun) {
  const TrialResult result = Flown(kNewFamilies, 64106, 152);
  EXPECT_TRUE(result.landed()) << result.detail;
}

TEST(HostileFlightTest, NobodyTouchesDownInAGustThatGrows) {
  for (const int number : {1333, 1459}) {
    const TrialResult result = Flown(kNewFamilies, 64113, number);
    EXPECT_TRUE(result.landed()) << number << ": " << result.detail;
  }
}

// In wind a foot points to the low side. But the camera has to see where the pad drives.
TEST(HostileFlightTest, TheCameraTurnsWithAPadThatTurnsInWind) {
  for (const int number : {291, 310}) {
    const TrialResult result = Flown(kOldFamilies, 64113, number);
    EXPECT_TRUE(result.landed()) << number << ": " << result.detail;
    EXPECT_LT(result.simulated_s, 12.0) << number << ": it went around";
  }
}

class HostileFamilyFlight : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileFamilyFlight, EndsInAnOutcome) {
  const HostileFlight flight = DrawHostileFlight(Of(GetParam()), 0, kRegistries);
  const TrialResult result = RunTrial(flight.trial.scenario, flight.trial.seed, kRegistries);
  EXPECT_FALSE(IsLost(result.outcome)) << result.detail;
  EXPECT_NE(result.outcome, Outcome::kUnstable) << result.detail;
  EXPECT_GT(result.simulated_s, 0.1);
  EXPECT_LE(result.simulated_s, flight.trial.scenario.timeout + 0.01);
  EXPECT_GT(result.replans, 0);
  const bool has_cause = result.outcome == Outcome::kCollision || result.outcome == Outcome::kStood;
  EXPECT_TRUE(!has_cause || !result.cause.empty()) << result.detail;
}

INSTANTIATE_TEST_SUITE_P(Families, HostileFamilyFlight, ::testing::ValuesIn(HostileFamilyNames()),
                         [](const auto& family) { return family.param; });

TEST(HostileFlightTest, AStudyThatIsGoneOnWithIsTheOneThatWasFlownAtOnce) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "hostile";
  std::filesystem::create_directories(folder);
  HostileOptions options;
  options.flights = 4;
  options.set = {"timeout=2"};
  const Campaign campaign = HostileCampaign(options, DrawHostileFlights(options, 1, kRegistries));
  const auto fly = [&](const std::string& name, int jobs) {
    CampaignOptions flight;
    flight.db = (folder / name).string();
    flight.jobs = jobs;
    return RunCampaign(campaign, flight, kRegistries, [](const CampaignState&) {});
  };
  const CampaignResult whole = fly("whole.db", 1);
  {
    TrialStore store((folder / "parts.db").string(), campaign, Shard());
    store.Add(2, whole.rows[2].result);
  }
  const CampaignResult parts = fly("parts.db", 2);
  EXPECT_EQ(parts.state.resumed, 1);
  EXPECT_EQ(HostileJson(options, parts.rows).dump(), HostileJson(options, whole.rows).dump());
  std::filesystem::remove_all(folder);
}

TEST(TruthMap, EveryCellThatNoObstacleReachesIntoIsObservedFree) {
  planning::OccupancyMap map{planning::OccupancyMapOptions()};
  const sim::Obstacle box = sim::Box{{2.03, 0.02, 1.0}, {0.3, 1.0, 1.0}, 0.0};
  const sim::ObstacleField field({box});
  const Eigen::Vector3d drift(0.07, -0.04, 0.0);
  const planning::CellIndex seen = map.CellOf(Eigen::Vector3d(-1, 0, 1));
  map.SetState(seen, planning::CellState::kOccupied);  // by noise: it still blocks
  ObserveTruth(field, drift, &map);
  EXPECT_FALSE(map.IsObservedFree(seen));
  int inside = 0, free = 0;
  planning::ForEachCell({map.CellOf({0, -2, 0.3}), map.CellOf({4, 2, 2.5})},
                        [&](const planning::CellIndex& cell) {
                          const Eigen::Vector3d p = map.CentreOf(cell) - drift;
                          const double distance = sim::SignedDistance(box, p);
                          if (distance < 0.049) {
                            ++inside;
                            EXPECT_FALSE(map.IsObservedFree(cell)) << p.transpose();
                          } else if (distance > 0.09) {
                            ++free;
                            EXPECT_TRUE(map.IsObservedFree(cell)) << p.transpose();
                          }
                        });
  EXPECT_GT(inside, 1000);
  EXPECT_GT(free, 1000);
}

TEST(HostilePairs, TimesAreComparedFlightByFlight) {
  SweepRow row;
  row.trial.seed = 7;
  row.trial.varied = {{"family", "door"}};
  row.result.outcome = Outcome::kLanded;
  row.result.touchdown.emplace().t = 6.0;
  SweepRow other = row;
  other.trial.seed = 8;
  const std::string text = HostilePairsText({row, other}, {{7, 4.0}});
  EXPECT_THAT(text, HasSubstr("door                1    1.500    1.500    1.500"));
  HostileOptions options;
  EXPECT_THROW(ReadHostileTimes(options, "/nowhere/f.db"), BadInput);
}

}  // namespace
}  // namespace touchdown::evaluation
