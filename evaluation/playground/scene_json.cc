// SPDX-License-Identifier: BSD-3-Clause
// A scene's JSON form. Whoever writes it by hand is told of a key that there is not, and of a number out of range.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "evaluation/playground/scene.h"
#include "touchdown/planning/problem/term_registry.h"

namespace touchdown::evaluation {
namespace {

using SceneDocument = nlohmann::ordered_json;

constexpr double kFarthest = 100.0;      // of a coordinate [m]
constexpr std::size_t kMostParts = 500;  // walls, or pillars
constexpr double kMostSeeds = 9e15;      // what a double holds exactly

/// An object of the document, of which each key is asked for.
class Part {
 public:
  Part(const SceneDocument& json, std::string name, std::initializer_list<std::string_view> keys)
      : json_(json), name_(std::move(name)) {
    if (!json.is_object())
      throw std::invalid_argument(name_ + " is " + json.dump() + "; it is an object");
    for (const auto& [key, value] : json.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      std::string known;
      for (const std::string_view k : keys) known.append(known.empty() ? "" : ", ").append(k);
      throw std::invalid_argument(name_ + " has no key " + key + "; there are " + known);
    }
  }

  const SceneDocument* Find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  void Number(const char* key, double lo, double hi, double* value) const {
    if (const SceneDocument* json = Find(key)) *value = Checked(*json, NameOf(key), lo, hi);
  }
  template <int kSize>
  void Point(const char* key, double lo, double hi, Eigen::Matrix<double, kSize, 1>* p) const {
    const SceneDocument* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_array() || json->size() != kSize) {
      throw std::invalid_argument(NameOf(key) + " is " + json->dump() + "; it is a list of " +
                                  std::to_string(kSize) + " numbers");
    }
    for (int i = 0; i < kSize; ++i) {
      (*p)[i] = Checked((*json)[static_cast<std::size_t>(i)], NameOf(key), lo, hi);
    }
  }
  /// The index of a word among those that are allowed.
  template <class Words>
  void Word(const char* key, const Words& words, std::size_t* index) const {
    const SceneDocument* json = Find(key);
    if (json == nullptr) return;
    const auto found =
        std::find(words.begin(), words.end(), json->is_string() ? json->get<std::string>() : "");
    if (found == words.end()) {
      std::string known;
      for (const auto& word : words) known.append(known.empty() ? "" : ", ").append(word);
      throw std::invalid_argument(NameOf(key) + " is " + json->dump() + "; it is one of " + known);
    }
    *index = static_cast<std::size_t>(found - words.begin());
  }
  template <class Visit>
  void Each(const char* key, Visit&& visit) const {
    const SceneDocument* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_array() || json->size() > kMostParts) {
      throw std::invalid_argument(NameOf(key) + ": it is a list of at most " +
                                  std::to_string(kMostParts) + " objects");
    }
    for (std::size_t i = 0; i < json->size(); ++i) {
      visit((*json)[i], NameOf(key) + "[" + std::to_string(i) + "]");
    }
  }

 private:
  std::string NameOf(const char* key) const { return name_ + "." + key; }
  static double Checked(const SceneDocument& json, const std::string& name, double lo, double hi) {
    if (!json.is_number()) {
      throw std::invalid_argument(name + " is " + json.dump() + "; it is a number");
    }
    const double value = json.get<double>();
    estimation::CheckWithin(name, value, lo, hi);
    return value;
  }

  const SceneDocument& json_;
  std::string name_;
};

const std::vector<std::string> kArrivals = {"fixed", "free"};
const std::vector<std::string> kKnown = {"camera", "all"};

// As a person has written it: back and forth without what rounding leaves.
double ToDegrees(double radians) {
  constexpr double kDigits = 1e9;
  return std::round(kDigits * radians * estimation::kDegPerRad) / kDigits;
}

sim::PadMotionConfig PadFrom(const SceneDocument& json, sim::PadMotionConfig pad) {
  const Part part(json, "scene.pad",
                  {"motion", "p", "heading_deg", "speed", "turn_rate", "height", "seed"});
  std::vector<std::string> names;
  for (const auto& [name, kind] : PlaygroundMotions()) names.push_back(name);
  std::size_t motion = names.size();
  part.Word("motion", names, &motion);
  if (motion < names.size()) pad.kind = PlaygroundMotions()[motion].second;
  Eigen::Vector2d p = pad.p_start.head<2>();
  part.Point<2>("p", -kFarthest, kFarthest, &p);
  double heading_deg = ToDegrees(pad.heading), seed = static_cast<double>(pad.seed);
  part.Number("heading_deg", -720.0, 720.0, &heading_deg);
  pad.heading = estimation::Radians(heading_deg);
  part.Number("speed", 0.0, 10.0, &pad.speed);
  part.Number("turn_rate", -2.0, 2.0, &pad.turn_rate);
  part.Number("height", 0.1, 3.0, &pad.p_start.z());
  part.Number("seed", 0.0, kMostSeeds, &seed);
  pad.acceleration = BriskAcceleration(pad.speed);
  pad.p_start.head<2>() = p;
  pad.seed = static_cast<std::uint64_t>(seed);
  return pad;
}

sim::Box WallFrom(const SceneDocument& json, const std::string& name) {
  const Part part(json, name, {"center", "size", "yaw_deg"});
  sim::Box wall;
  Eigen::Vector3d size = 2.0 * wall.half_extents;
  double yaw_deg = 0.0;
  part.Point<3>("center", -kFarthest, kFarthest, &wall.center);
  part.Point<3>("size", 0.02, kFarthest, &size);
  part.Number("yaw_deg", -720.0, 720.0, &yaw_deg);
  wall.half_extents = 0.5 * size;
  wall.yaw = estimation::Radians(yaw_deg);
  return wall;
}

sim::Cylinder PillarFrom(const SceneDocument& json, const std::string& name) {
  const Part part(json, name, {"p", "radius", "height"});
  sim::Cylinder pillar;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  part.Point<2>("p", -kFarthest, kFarthest, &p);
  part.Number("radius", 0.02, 10.0, &pillar.radius);
  part.Number("height", 0.1, 20.0, &pillar.height);
  pillar.center << p, 0.5 * pillar.height;
  return pillar;
}

control::Envelope LimitsFrom(const SceneDocument& json, control::Envelope limits) {
  const Part part(json, "scene.limits", {"speed", "acceleration", "tilt_deg"});
  part.Number("speed", 0.2, 15.0, &limits.speed);
  part.Number("acceleration", 0.5, 20.0, &limits.acceleration);
  part.Number("tilt_deg", 5.0, 60.0, &limits.tilt_deg);
  return limits;
}

std::vector<std::pair<std::string, double>> WeightsFrom(const SceneDocument& json) {
  static const planning::TermRegistry kTerms = planning::StandardTerms();
  std::vector<std::pair<std::string, double>> weights;
  if (!json.is_object()) {
    throw std::invalid_argument("scene.terms is " + json.dump() + "; it is an object");
  }
  for (const auto& [name, weight] : json.items()) {
    planning::FindTerm(kTerms, name);
    if (!weight.is_number()) {
      throw std::invalid_argument("scene.terms." + name + " is " + weight.dump() +
                                  "; it is a number");
    }
    weights.emplace_back(name, weight.get<double>());
    estimation::CheckWithin("scene.terms." + name, weights.back().second, 0.0, 1e6);
  }
  return weights;
}

}  // namespace

PlaygroundScene SceneFrom(const nlohmann::ordered_json& json) {
  const Part part(json, "scene",
                  {"start", "pad", "walls", "pillars", "limits", "arrival", "ways", "backend",
                   "known", "terms", "seed"});
  PlaygroundScene scene = FirstScene();
  scene.walls.clear();
  scene.pillars.clear();
  part.Point<3>("start", -kFarthest, kFarthest, &scene.p_WB);
  estimation::CheckWithin("scene.start's height", scene.p_WB.z(), 0.3, scene.limits.ceiling);
  if (const SceneDocument* pad = part.Find("pad")) scene.pad = PadFrom(*pad, scene.pad);
  part.Each("walls", [&](const SceneDocument& wall, const std::string& name) {
    scene.walls.push_back(WallFrom(wall, name));
  });
  part.Each("pillars", [&](const SceneDocument& pillar, const std::string& name) {
    scene.pillars.push_back(PillarFrom(pillar, name));
  });
  if (const SceneDocument* limits = part.Find("limits")) {
    scene.limits = LimitsFrom(*limits, scene.limits);
  }
  std::size_t arrival = scene.arrival == planning::ArrivalMode::kFree, known = scene.all_known;
  part.Word("arrival", kArrivals, &arrival);
  part.Word("known", kKnown, &known);
  scene.arrival = arrival == 1 ? planning::ArrivalMode::kFree : planning::ArrivalMode::kFixed;
  scene.all_known = known == 1;
  std::size_t backend = 0;
  part.Word("backend", PlaygroundBackends(), &backend);
  scene.backend = PlaygroundBackends()[backend];
  double ways = scene.ways, seed = static_cast<double>(scene.seed);
  part.Number("ways", 1.0, 2.0, &ways);
  part.Number("seed", 0.0, kMostSeeds, &seed);
  scene.ways = static_cast<int>(ways);
  scene.seed = static_cast<std::uint64_t>(seed);
  if (const SceneDocument* terms = part.Find("terms")) scene.weights = WeightsFrom(*terms);
  return scene;
}

nlohmann::ordered_json SceneJson(const PlaygroundScene& scene) {
  const auto& motions = PlaygroundMotions();
  const auto motion = std::find_if(motions.begin(), motions.end(), [&](const auto& named) {
    return named.second == scene.pad.kind;
  });
  SceneDocument json = {{"start", {scene.p_WB.x(), scene.p_WB.y(), scene.p_WB.z()}},
                        {"pad",
                         {{"motion", motion->first},
                          {"p", {scene.pad.p_start.x(), scene.pad.p_start.y()}},
                          {"heading_deg", ToDegrees(scene.pad.heading)},
                          {"speed", scene.pad.speed},
                          {"turn_rate", scene.pad.turn_rate},
                          {"height", scene.pad.p_start.z()},
                          {"seed", scene.pad.seed}}}};
  json["walls"] = SceneDocument::array();
  for (const sim::Box& wall : scene.walls) {
    const Eigen::Vector3d size = 2.0 * wall.half_extents;
    json["walls"].push_back({{"center", {wall.center.x(), wall.center.y(), wall.center.z()}},
                             {"size", {size.x(), size.y(), size.z()}},
                             {"yaw_deg", ToDegrees(wall.yaw)}});
  }
  json["pillars"] = SceneDocument::array();
  for (const sim::Cylinder& pillar : scene.pillars) {
    json["pillars"].push_back({{"p", {pillar.center.x(), pillar.center.y()}},
                               {"radius", pillar.radius},
                               {"height", pillar.height}});
  }
  json["limits"] = {{"speed", scene.limits.speed},
                    {"acceleration", scene.limits.acceleration},
                    {"tilt_deg", scene.limits.tilt_deg}};
  json["arrival"] = kArrivals[scene.arrival == planning::ArrivalMode::kFree];
  json["ways"] = scene.ways;
  json["backend"] = scene.backend;
  json["known"] = kKnown[scene.all_known];
  json["terms"] = SceneDocument::object();
  for (const auto& [name, weight] : scene.weights) json["terms"][name] = weight;
  json["seed"] = scene.seed;
  return json;
}

}  // namespace touchdown::evaluation
