// SPDX-License-Identifier: BSD-3-Clause
// The planner in a page, without the page: its answers are those of the program.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "evaluation/playground/ask.h"
#include "evaluation/playground/scene_setup.h"
#include "evaluation/record/plan_case.h"
#include "evaluation/record/step_json.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

Json Ask(const Json& question) { return Json::parse(Playground().Ask(question.dump())); }

Json PlanOf(const PlaygroundScene& scene) {
  return Ask({{"do", "plan"}, {"scene", SceneJson(scene)}});
}

/// Flies until it has ended; the last report.
Json FlyToTheEnd(const PlaygroundScene& scene) {
  Playground playground;
  Json report =
      Json::parse(playground.Ask(Json({{"do", "fly"}, {"scene", SceneJson(scene)}}).dump()));
  while (!report.contains("error") && report["outcome"].is_null()) {
    report = Json::parse(playground.Ask(R"({"do": "step", "seconds": 0.5})"));
  }
  return report;
}

TEST(Playground, VehicleIsTheShippedOne) {
  const estimation::VehicleModel ours = PlaygroundVehicle();
  const estimation::VehicleModel shipped = sim::LoadVehicleModel(sim::DefaultVehicleMjcf());
  EXPECT_EQ(ours.mass_kg, shipped.mass_kg);
  EXPECT_EQ(ours.inertia, shipped.inertia);
  EXPECT_EQ(ours.rotor_lag_s, shipped.rotor_lag_s);
  EXPECT_NEAR(ours.hull_radius, shipped.hull_radius, 1e-12);
  EXPECT_NEAR(ours.hull_top, shipped.hull_top, 1e-12);
  EXPECT_NEAR(ours.foot_depth, shipped.foot_depth, 1e-12);
  EXPECT_NEAR(ours.foot_radius, shipped.foot_radius, 1e-4);
  ASSERT_EQ(ours.actuators.size(), shipped.actuators.size());
  for (std::size_t i = 0; i < ours.actuators.size(); ++i) {
    EXPECT_EQ(ours.actuators[i].p_BR, shipped.actuators[i].p_BR) << i;
    EXPECT_EQ(ours.actuators[i].moment_B, shipped.actuators[i].moment_B) << i;
    EXPECT_EQ(ours.actuators[i].max, shipped.actuators[i].max) << i;
  }
}

// The same scene as a scenario: `touchdown plan` solves the same step, bit for bit.
TEST(Playground, PadIsThatOfScenarios) {
  const Scenario scenario;
  EXPECT_EQ(2.0 * PlaygroundPad().deck_half_size, scenario.pad.deck_size);
}

TEST(Playground, PlansAsTheProgramDoes) {
  for (const bool both_ways : {false, true}) {
    PlaygroundScene scene = FirstScene();
    scene.ways = both_ways ? 2 : 1;
    std::string text = fmt::format(
        "start: {{position: [{}, {}, {}]}}\n"
        "pad: {{motion: line, start: [{}, {}], heading_deg: {}, speed: {}, deck_height: {}}}\n"
        "planning: {{guides: {}}}\n"
        "obstacles:\n  boxes:\n",
        scene.p_WB.x(), scene.p_WB.y(), scene.p_WB.z(), scene.pad.p_start.x(),
        scene.pad.p_start.y(), scene.pad.heading * estimation::kDegPerRad, scene.pad.speed,
        scene.pad.p_start.z(), scene.ways);
    for (const sim::Box& wall : scene.walls) {
      text += fmt::format("    - {{centre: [{}, {}], size: [{}, {}, {}]}}\n", wall.center.x(),
                          wall.center.y(), 2.0 * wall.half_extents.x(), 2.0 * wall.half_extents.y(),
                          2.0 * wall.half_extents.z());
    }
    text += "  cylinders:\n";
    for (const sim::Cylinder& pillar : scene.pillars) {
      text += fmt::format("    - {{centre: [{}, {}], radius: {}, height: {}}}\n", pillar.center.x(),
                          pillar.center.y(), pillar.radius, pillar.height);
    }
    const Registries registries = StandardRegistries();
    const SolvedStep solved = SolveStep(
        StepFromStart(ParseScenario(text, "scene", "scene.yaml", {}, registries), registries), 0,
        registries);
    const Json plan = PlanOf(scene);
    EXPECT_EQ(plan["status"], planning::ToString(solved.outcome.status));
    EXPECT_EQ(plan["attempts"].size(), solved.log.attempts.size());
    EXPECT_EQ(plan["pair"]["curve"].dump(), CurveJson(solved.outcome.curve).dump());
    EXPECT_EQ(plan["pair"]["stop"].dump(), CurveJson(solved.pair.stop).dump());
    EXPECT_EQ(plan["work"], solved.outcome.work);
  }
}

TEST(Playground, FirstSceneIsPlannedAndLanded) {
  const Json plan = PlanOf(FirstScene());
  EXPECT_EQ(plan["status"], "planned");
  EXPECT_EQ(plan["passed"], true);
  EXPECT_GE(plan["attempts"].size(), 1u);
  EXPECT_GT(plan["attempts"][0]["rounds"][0]["iterations"], 0);
  EXPECT_GT(plan["pad"].size(), 10u);
  for (const char* known : {"all", "camera"}) {
    PlaygroundScene scene = FirstScene();
    scene.all_known = std::string(known) == "all";
    const Json flown = FlyToTheEnd(scene);
    EXPECT_EQ(flown["outcome"]["name"], "landed") << flown.dump();
    EXPECT_GT(flown["least_clearance"], 0.0);
  }
}

TEST(Playground, EveryBackendIsThere) {
  for (const std::string& backend : PlaygroundBackends()) {
    PlaygroundScene scene = FirstScene();
    scene.backend = backend;
    const Json timed = Ask({{"do", "time"}, {"scene", SceneJson(scene)}, {"steps", 3}});
    EXPECT_EQ(timed["status"], "planned") << backend;
    EXPECT_GT(timed["mean_ms"], 0.0) << backend;
  }
}

TEST(Playground, ImpossibleScenesAreToldInSentences) {
  PlaygroundScene blocked = FirstScene();
  blocked.pad.kind = sim::PadMotionConfig::Kind::kStatic;
  blocked.walls = {{{4.0, -2.0, 1.5}, {0.5, 0.5, 1.5}, 0.0}};
  const Json goal = PlanOf(blocked);
  EXPECT_EQ(goal["reason"], "goal_blocked") << goal["sentences"].dump();
  EXPECT_GE(goal["sentences"].size(), 2u);

  PlaygroundScene inside = FirstScene();
  inside.walls = {{inside.p_WB, {0.5, 0.5, 0.5}, 0.0}};
  for (const bool all_known : {true, false}) {
    inside.all_known = all_known;
    const Json start = PlanOf(inside);
    EXPECT_EQ(start["reason"], "start_in_obstacle") << start.dump();
    EXPECT_EQ(start["passed"], false);
    EXPECT_EQ(FlyToTheEnd(inside)["outcome"]["name"], "touched");
  }

  PlaygroundScene fast = FirstScene();
  fast.pad.speed = 9.0;
  const Json away = PlanOf(fast);
  EXPECT_NE(away["status"], "planned");
  EXPECT_NE(away["reason"], "none");
}

// A wall that is put into a flight's way is flown around, or the vehicle stops before it. It never flies into a wall
// that can be seen in time.
TEST(Playground, AnObstacleMayComeDuringAFlight) {
  Playground playground;
  PlaygroundScene scene = FirstScene();
  scene.all_known = false;
  scene.walls.clear();
  scene.pillars.clear();
  playground.Ask(Json({{"do", "fly"}, {"scene", SceneJson(scene)}}).dump());
  playground.Ask(R"({"do": "step", "seconds": 0.5})");
  scene.walls = {{{0.5, -0.5, 1.5}, {0.15, 1.5, 1.5}, 0.0}};
  Json report =
      Json::parse(playground.Ask(Json({{"do", "move"}, {"scene", SceneJson(scene)}}).dump()));
  EXPECT_FALSE(report.contains("error"));
  double cells = 0.0;
  while (report["outcome"].is_null()) {
    report = Json::parse(playground.Ask(R"({"do": "step", "seconds": 0.1})"));
    ASSERT_FALSE(report.contains("error")) << report.dump();
    cells += static_cast<double>(report["map"]["added"].size()) / 3.0;
  }
  EXPECT_EQ(report["outcome"]["name"], "landed") << report.dump();
  EXPECT_GT(cells, 100.0);
  EXPECT_GT(report["least_clearance"], 0.0);
  const Json why = Json::parse(playground.Ask(R"({"do": "why"})"));
  EXPECT_TRUE(why.contains("attempts")) << why.dump();
}

// The deck is met from above by feet alone; a vehicle under it or beside it touches it with its hull.
TEST(Playground, TheDeckIsNoDoor) {
  PlaygroundScene scene = FirstScene();
  scene.walls.clear();
  scene.pillars.clear();
  scene.pad.kind = sim::PadMotionConfig::Kind::kStatic;
  scene.pad.p_start = {0.0, 0.0, 1.5};
  scene.p_WB = {0.0, 0.0, 0.5};
  const Json under = FlyToTheEnd(scene);
  EXPECT_EQ(under["outcome"]["name"], "touched") << under.dump();
  EXPECT_LT(under["p"][2], 1.5);
  scene.p_WB = {0.9, 0.0, 1.5};
  EXPECT_EQ(FlyToTheEnd(scene)["outcome"]["name"], "touched");
  scene.p_WB = {0.0, 0.0, 2.2};
  EXPECT_EQ(FlyToTheEnd(scene)["outcome"]["name"], "landed");
}

// What has ended stays ended, whatever is moved then.
TEST(Playground, AnEndIsAnEnd) {
  Playground playground;
  PlaygroundScene scene = FirstScene();
  Json report =
      Json::parse(playground.Ask(Json({{"do", "fly"}, {"scene", SceneJson(scene)}}).dump()));
  for (int i = 0; i < 100 && report["outcome"].is_null(); ++i) {
    report = Json::parse(playground.Ask(R"({"do": "step", "seconds": 1})"));
  }
  ASSERT_EQ(report["outcome"]["name"], "landed") << report.dump();
  scene.pillars = {{{report["p"][0], report["p"][1], 1.5}, 0.5, 3.0}};
  report = Json::parse(playground.Ask(Json({{"do", "move"}, {"scene", SceneJson(scene)}}).dump()));
  EXPECT_EQ(report["outcome"]["name"], "landed");
}

TEST(Playground, ScenesComeBackFromTheirText) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PlaygroundScene scene = RandomScene(seed);
    scene.weights = {{"smoothness", 2.0}, {"consistency", 0.5}};
    scene.arrival = seed % 2 == 0 ? planning::ArrivalMode::kFixed : planning::ArrivalMode::kFree;
    scene.all_known = seed % 3 == 0;
    scene.limits.speed = 2.5;
    const Json json = SceneJson(scene);
    EXPECT_EQ(SceneJson(SceneFrom(Json::parse(json.dump()))).dump(), json.dump());
  }
}

TEST(Playground, MistakesAreAnsweredWithASentence) {
  const auto sentence = [](const std::string& question) {
    const Json answer = Json::parse(Playground().Ask(question));
    return answer.value("error", "no error");
  };
  EXPECT_THAT(sentence("{"), HasSubstr("no JSON"));
  EXPECT_THAT(sentence(R"({"do": 5})"), HasSubstr("one of about"));
  EXPECT_THAT(sentence(std::string(100000, '[')), HasSubstr("too many levels"));
  EXPECT_THAT(sentence("[]"), HasSubstr("one of about"));
  EXPECT_THAT(sentence(R"({"do": "dance"})"), HasSubstr("one of about"));
  EXPECT_THAT(sentence(R"({"do": "plan"})"), HasSubstr("scene is missing"));
  EXPECT_THAT(sentence(R"({"do": "step", "seconds": 1})"), HasSubstr("no flight has begun"));
  const auto in_scene = [&](const std::string& scene) {
    return sentence(R"({"do": "plan", "scene": )" + scene + "}");
  };
  EXPECT_THAT(in_scene(R"({"padd": {}})"), HasSubstr("no key padd"));
  EXPECT_THAT(in_scene(R"({"pad": {"speed": 99}})"),
              HasSubstr("scene.pad.speed is 99; allowed is [0, 10]"));
  EXPECT_THAT(in_scene(R"({"pad": {"motion": "hop"}})"), HasSubstr("one of static, line"));
  EXPECT_THAT(in_scene(R"({"start": [1, 2]})"), HasSubstr("list of 3 numbers"));
  EXPECT_THAT(in_scene(R"({"start": [1, 2, 50]})"), HasSubstr("height"));
  EXPECT_THAT(in_scene(R"({"walls": [{"size": [1, 1, 0]}]})"), HasSubstr("scene.walls[0].size"));
  EXPECT_THAT(in_scene(R"({"terms": {"smothness": 1}})"), HasSubstr("smoothness"));
  EXPECT_THAT(in_scene(R"({"terms": {"smoothness": -1}})"), HasSubstr("scene.terms.smoothness"));
  EXPECT_THAT(in_scene(R"({"backend": "ceres"})"), HasSubstr("banded, lbfgs"));
  EXPECT_THAT(in_scene(R"({"pad": {"speed": 0}})"), HasSubstr("scene.pad.speed is 0"));
  EXPECT_LT(in_scene(R"({"backend": ")" + std::string(1000000, 'x') + R"("})").size(), 200u);
}

// A number that is not finite is no JSON, and a damaged text is no UTF-8. Neither may end the page.
TEST(Playground, AnswersAreAlwaysJson) {
  EXPECT_NO_THROW(Json::parse(Playground().Ask("\xff\xfe")));
  EXPECT_NO_THROW(Json::parse(Playground().Ask("{\"do\": \"\xff\"}")));
  PlaygroundScene empty = FirstScene();
  empty.walls.clear();
  empty.pillars.clear();
  EXPECT_TRUE(FlyToTheEnd(empty)["clearance"].is_null());
}

}  // namespace
}  // namespace touchdown::evaluation
