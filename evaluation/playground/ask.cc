// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/playground/ask.h"

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "estimation/base/argument_check.h"
#include "evaluation/playground/scene_setup.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/planning/problem/term_registry.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLongestAdvance = 10.0;  // of one question [s]
constexpr double kMostSteps = 1000.0;     // of one question

double NumberIn(const Json& question, const char* key, double lo, double hi) {
  const auto found = question.find(key);
  if (found == question.end() || !found->is_number()) {
    throw std::invalid_argument(std::string(key) + " is missing, or no number");
  }
  const double value = found->get<double>();
  estimation::CheckWithin(key, value, lo, hi);
  return value;
}

/// A question, of no more depth than a scene has: what reads a document calls itself.
Json Parsed(std::string_view text) {
  constexpr int kDeepest = 6;
  return Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw std::invalid_argument("the question has too many levels");
    return true;
  });
}

std::string WordIn(const Json& question, const char* key) {
  const auto found = question.is_object() ? question.find(key) : question.end();
  return found != question.end() && found->is_string() ? found->get<std::string>().substr(0, 40)
                                                       : "";
}

PlaygroundScene SceneIn(const Json& question) {
  const auto found = question.find("scene");
  if (found == question.end()) throw std::invalid_argument("scene is missing");
  return SceneFrom(*found);
}

Json About() {
  const PlaygroundScene first = FirstScene();
  const planning::ReplannerOptions options = PlannerOf(first);
  const estimation::VehicleModel vehicle = PlaygroundVehicle();
  const sim::DepthCameraConfig camera;
  Json json = {{"version", TOUCHDOWN_VERSION},
               {"scene", SceneJson(first)},
               {"backends", PlaygroundBackends()},
               {"hull_radius", control::HullAtEveryTilt(vehicle)},
               {"clearance", OnboardOptionsOf(first).map.inflation_radius},
               {"body_rate", options.limits.body_rate},
               {"foot_depth", vehicle.foot_depth},
               {"deck_size", 2.0 * PlaygroundPad().deck_half_size}};
  json["camera"] = {{"fov_x_deg", camera.fov_x_deg},
                    {"aspect", static_cast<double>(camera.width) / camera.height},
                    {"range", camera.max_range}};
  for (const auto& [name, kind] : PlaygroundMotions()) json["motions"].push_back(name);
  for (const planning::TermEntry& term : planning::StandardTerms()) {
    // What needs other ends, or obstacles that a scene has not, is no choice here.
    if (term.use == planning::TermUse::kExplicitEndpoint ||
        term.use == planning::TermUse::kMovingObstacles) {
      continue;
    }
    double weight = term.default_weight;
    for (const planning::TermSettings& set : options.problem.settings) {
      if (set.name == term.info.name && set.weight) weight = *set.weight;
    }
    json["terms"].push_back({{"name", term.info.name},
                             {"help", term.info.formula},
                             {"weight", weight},
                             {"on", weight > 0.0},
                             {"limit", term.is_limit}});
  }
  return json;
}

}  // namespace

std::string Playground::Ask(std::string_view text) noexcept {
  Json answer;
  try {
    const Json question = Parsed(text);
    const std::string what = WordIn(question, "do");
    if (what == "about") {
      answer = About();
    } else if (what == "plan") {
      const PlaygroundScene scene = SceneIn(question);
      answer = RefusalOf(scene);
      if (answer.is_null()) answer = SceneStep(scene).Explain();
    } else if (what == "time") {
      const PlaygroundScene scene = SceneIn(question);
      const int steps = static_cast<int>(NumberIn(question, "steps", 1.0, kMostSteps));
      Timed& timed = timed_[scene.backend];
      if (const std::string key = SceneJson(scene).dump(); key != timed.scene) {
        timed = {};
        timed.step = std::make_unique<SceneStep>(scene);
        timed.step->Ask();  // makes the room that later steps keep
        timed.scene = key;
      }
      const double mean_ms = timed.step->MeanTime(steps);
      const planning::ReplanResult& result = timed.step->Ask();
      answer = {{"steps", steps},
                {"mean_ms", mean_ms},
                {"status", planning::ToString(result.status)},
                {"iterations", result.solver.iterations},
                {"solves", result.solves},
                {"cost", result.solver.cost}};
    } else if (what == "random") {
      answer =
          SceneJson(RandomScene(static_cast<std::uint64_t>(NumberIn(question, "seed", 0.0, 9e15))));
    } else if (what == "fly") {
      flight_.reset();
      flight_.emplace(SceneIn(question));
      answer = flight_->Report();
    } else if (what == "step" || what == "why" || what == "move") {
      if (!flight_) throw std::invalid_argument(what + ": no flight has begun");
      if (what == "why") {
        answer = flight_->Explain();
      } else {
        if (what == "move") flight_->Move(SceneIn(question));
        if (what == "step") flight_->Advance(NumberIn(question, "seconds", 0.0, kLongestAdvance));
        answer = flight_->Report();
      }
    } else {
      throw std::invalid_argument(
          "do is \"" + what + "\"; it is one of about, plan, time, random, fly, step, why, move");
    }
  } catch (const Json::parse_error&) {
    answer = {{"error", "the question is no JSON text"}};
  } catch (const std::exception& error) {
    answer = {{"error", error.what()}};
  }
  // What is not finite has no JSON: it is null. A message may hold a mangled text.
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace touchdown::evaluation
