// SPDX-License-Identifier: BSD-3-Clause
// The one table of scenario keys. Files, --set, dumps and the documentation all go through it; the
// defaults are those of a default-constructed Scenario and stand nowhere else.
#include "touchdown/evaluation/scenario_schema.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace touchdown::evaluation {
namespace {

// Each maker takes an accessor `at`: Owner& -> member&, so that nested members need no pointers.
template <typename Owner, typename At>
SchemaKey<Owner> Number(std::string name, ValueRange range, std::string doc, At at) {
  return {
      name,
      "number",
      range.unit,
      range.ToString(),
      std::move(doc),
      [=](Owner& o, const YAML::Node& n, const Where& w) { at(o) = ReadNumber(n, w, name, range); },
      [=](const Owner& o) { return WriteNumber(at(o)); }};
}

template <typename At>
SchemaKey<Scenario> Whole(std::string name, int lowest, int highest, std::string doc, At at) {
  const std::string range = fmt::format("[{}, {}]", lowest, highest);
  return {name,
          "whole number",
          "",
          range,
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) {
            at(s) = ReadWhole(n, w, name, lowest, highest);
          },
          [=](const Scenario& s) { return std::to_string(at(s)); }};
}

template <int kSize, typename Owner, typename At>
SchemaKey<Owner> Vector(std::string name, ValueRange range, std::string doc, At at) {
  return {name,
          fmt::format("list of {} numbers", kSize),
          range.unit,
          range.ToString(),
          std::move(doc),
          [=](Owner& o, const YAML::Node& n, const Where& w) {
            at(o) = ReadVector(n, w, name, kSize, range);
          },
          [=](const Owner& o) { return WriteVector(at(o)); }};
}

template <typename At>
SchemaKey<Scenario> Bool(std::string name, std::string doc, At at) {
  return {name,
          "true or false",
          "",
          "true or false",
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) { at(s) = ReadBool(n, w, name); },
          [=](const Scenario& s) { return std::string(at(s) ? "true" : "false"); }};
}

// The words stand in the order of the enumerators.
template <typename At>
SchemaKey<Scenario> Choice(std::string name, std::vector<std::string> words, std::string doc,
                           At at) {
  return {name,
          "choice",
          "",
          Enumerate(words),
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) {
            using Enum = std::remove_reference_t<decltype(at(s))>;
            at(s) = static_cast<Enum>(ReadChoice(n, w, name, words));
          },
          [=](const Scenario& s) { return words.at(static_cast<std::size_t>(at(s))); }};
}

template <typename At>
SchemaKey<Scenario> Text(std::string name, std::string range, std::string doc, At at) {
  return {name, "text", "", std::move(range), std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) { at(s) = ReadText(n, w, name); },
          // Double-quoted YAML is JSON's notation for what paths hold.
          [=](const Scenario& s) { return fmt::format("\"{}\"", at(s)); }};
}

ValueRange In(double lo, double hi, std::string unit) { return {lo, hi, false, std::move(unit)}; }
ValueRange Above(double lo, double hi, std::string unit) { return {lo, hi, true, std::move(unit)}; }

#define AT(member) \
  [](auto& s) -> auto& { return s.member; }

void AddPadKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(Choice("pad.motion", {"straight_turn", "circle", "line", "static"},
                        "path of the pad vehicle", AT(pad.motion)));
  keys.push_back(Number<Scenario>("pad.speed", In(0.01, 3, "m/s"),
                                  "speed along the path; at most 0.9 limits.speed", AT(pad.speed)));
  keys.push_back(Vector<2, Scenario>("pad.start", In(-100, 100, "m"),
                                     "pad centre at the start of the path, in W", AT(pad.start)));
  keys.push_back(Number<Scenario>("pad.heading_deg", In(-360, 360, "deg"),
                                  "heading at the start of the path", AT(pad.heading_deg)));
  keys.push_back(Number<Scenario>("pad.turn_start", In(0, 200, "m"),
                                  "straight_turn: driven before the turn begins",
                                  AT(pad.turn_start)));
  keys.push_back(Number<Scenario>("pad.turn_deg", In(-180, 180, "deg"),
                                  "straight_turn: angle of the turn, left positive",
                                  AT(pad.turn_deg)));
  keys.push_back(Number<Scenario>("pad.turn_rate", In(-2, 2, "rad/s"),
                                  "circle: turn rate, left positive; straight_turn: its magnitude",
                                  AT(pad.turn_rate)));
  keys.push_back(Number<Scenario>("pad.phase", In(-100, 100, "m"),
                                  "path already travelled at t = 0", AT(pad.phase)));
  keys.push_back(Number<Scenario>("pad.phase_spread", In(0, 100, "m"),
                                  "drawn per seed: uniform in +- this, added to pad.phase",
                                  AT(pad.phase_spread)));
  keys.push_back(Number<Scenario>("pad.deck_size", In(0.6, 5, "m"), "edge of the square deck",
                                  AT(pad.deck_size)));
  keys.push_back(Number<Scenario>("pad.deck_height", In(0.1, 3, "m"),
                                  "upper face of the deck above the ground", AT(pad.deck_height)));
  keys.push_back(
      Choice("pad.prediction", {"paper", "turn_rate", "oracle"},
             "extrapolation of the pad: straight, along an arc (straight if estimator.pad "
             "is paper), or the true future",
             AT(pad.prediction)));
}

void AddVehicleKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(
      Text("vehicle", "default or the path of an MJCF file", "the quadrotor", AT(vehicle)));
  keys.push_back(Vector<3, Scenario>("start.position", In(-100, 100, "m"),
                                     "the vehicle hovers here at t = 0, in W", AT(start.position)));
  keys.push_back(Vector<3, Scenario>("start.position_spread", In(0, 20, "m"),
                                     "drawn per seed: uniform in +- this, per axis",
                                     AT(start.position_spread)));
  keys.push_back(Number<Scenario>("start.yaw_deg", In(-360, 360, "deg"), "heading at t = 0",
                                  AT(start.yaw_deg)));
  keys.push_back(Bool("start.yaw_random", "draw the heading per seed from the whole circle instead",
                      AT(start.yaw_random)));
}

void AddCameraKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(
      Whole("camera.width", 16, 2048, "pixels of the downward camera in a row", AT(camera.width)));
  keys.push_back(
      Whole("camera.height", 16, 2048, "rows of the downward camera", AT(camera.height)));
  keys.push_back(Number<Scenario>("camera.fov_deg", In(10, 150, "deg"),
                                  "vertical field of view of the downward camera",
                                  AT(camera.fov_deg)));
  keys.push_back(Number<Scenario>("camera.noise", In(0, 100, ""),
                                  "sensing rendered: standard deviation of a pixel in grey levels "
                                  "of 255; the model of sensing fast is fitted at 2",
                                  AT(camera.noise)));
  keys.push_back(Number<Scenario>("camera.exposure_ms", In(0, 100, "ms"),
                                  "sensing rendered: exposure, over which motion blurs the image",
                                  AT(camera.exposure_ms)));
  keys.push_back(Number<Scenario>("camera.latency_ms", In(0, 400, "ms"),
                                  "from the middle of the exposure until the pad's pose is known",
                                  AT(camera.latency_ms)));
  keys.push_back(Number<Scenario>("camera.drop", In(0, 1, ""),
                                  "probability of each image of the downward camera to be lost",
                                  AT(camera.drop)));
  keys.push_back(Number<Scenario>("camera.occlusion", In(0, 0.9, ""),
                                  "share of the pad's printed sheet under an opaque plate, from "
                                  "its front edge on",
                                  AT(camera.occlusion)));
}

void AddDepthKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(Whole("depth.width", 8, 1024,
                       "pixels of the depth camera in a row; 160 is recommended for sensing "
                       "rendered",
                       AT(depth.width)));
  keys.push_back(Whole("depth.height", 8, 1024,
                       "rows of the depth camera; 120 is recommended for sensing rendered",
                       AT(depth.height)));
  keys.push_back(Number<Scenario>("depth.noise", In(0, 0.5, ""),
                                  "standard deviation of a range over the range", AT(depth.noise)));
  keys.push_back(Number<Scenario>("depth.latency_ms", In(0, 400, "ms"),
                                  "from the depth image to the map", AT(depth.latency_ms)));
  keys.push_back(Number<Scenario>("depth.drop", In(0, 1, ""),
                                  "probability of each depth image to be lost", AT(depth.drop)));
}

void AddSensorKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(Number<Scenario>("gps.sigma", In(0, 5, "m"),
                                  "standard deviation of the pad's GPS, each axis; the pad filter "
                                  "reckons with 1 mm at least",
                                  AT(gps.sigma)));
  keys.push_back(
      Number<Scenario>("gps.rate", Above(0, 100, "Hz"), "rate of the pad's GPS", AT(gps.rate)));
  keys.push_back(Vector<2, Scenario>("gps.outage", In(0, 600, "s"),
                                     "no fix comes from the first time to the second; none is "
                                     "missing if they are equal",
                                     AT(gps.outage)));
  keys.push_back(Number<Scenario>("gps.outliers", In(0, 1, ""),
                                  "probability of each fix to be off by gps.outlier_size, which it "
                                  "does not tell",
                                  AT(gps.outliers)));
  keys.push_back(Number<Scenario>("gps.outlier_size", In(0, 1000, "m"),
                                  "error of an outlier, in any direction", AT(gps.outlier_size)));
  keys.push_back(Number<Scenario>("tags.rate", Above(0, 100, "Hz"), "rate of the downward camera",
                                  AT(tag_rate)));
  AddCameraKeys(keys);
  keys.push_back(Number<Scenario>("depth.rate", Above(0, 100, "Hz"), "rate of the depth camera",
                                  AT(depth_rate)));
  AddDepthKeys(keys);
  keys.push_back(Text("map.prior", "none or the path of an OctoMap file (.bt or .ot)",
                      "what is known of the obstacles before the flight, in cells of 0.1 m",
                      AT(map_prior)));
  keys.push_back(Choice("sensing", {"fast", "rendered"},
                        "fast: models of both cameras; rendered: images, in which the pad is found",
                        AT(sensing)));
  keys.push_back(
      Choice("own_state", {"true"}, "what the vehicle knows of its own state", AT(own_state)));
  keys.push_back(Choice("estimator.pad", {"paper", "turn_rate"}, "pad filter", AT(pad_estimator)));
}

void AddPlanningKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(Choice("controller", {"geometric", "paper"}, "tracking law", AT(controller)));
  keys.push_back(Choice("descent", {"none", "vertical"},
                        "none follows above the pad, vertical approaches and then sinks over it",
                        AT(descent)));
  keys.push_back(
      Choice("planner", {"landing", "ego", "ego-velocity"},
             "landing: this project's; ego: the EGO-Planner baseline, at rest at the pad; "
             "ego-velocity: the same with the pad's velocity at the end",
             AT(planner)));
  keys.push_back(Number<Scenario>("planning.rate", Above(0, 100, "Hz"), "rate of replanning",
                                  AT(planning.rate)));
  const ValueRange latency = In(0, 1000, "ms");
  keys.push_back({"planning.latency", "number or word", "ms", latency.ToString() + " or measured",
                  "time from the question to the plan that is flown, no more than the period of "
                  "planning.rate; measured: the wall clock's",
                  [latency](Scenario& s, const YAML::Node& n, const Where& w) {
                    s.planning.latency.measured = n.IsScalar() && n.Scalar() == "measured";
                    if (s.planning.latency.measured) return;
                    if (n.IsScalar() && !n.Scalar().empty() && std::isalpha(n.Scalar()[0]) != 0) {
                      RefuseValue(w, "planning.latency",
                                  "a number in " + latency.ToString() + " or measured", n);
                    }
                    s.planning.latency.ms = ReadNumber(n, w, "planning.latency", latency);
                  },
                  [](const Scenario& s) {
                    return s.planning.latency.measured ? "measured"
                                                       : WriteNumber(s.planning.latency.ms);
                  }});
  keys.push_back(Number<Scenario>("planning.clearance", In(0.1, 1, "m"),
                                  "obstacles are grown by this in the map; no less than the "
                                  "radius of the vehicle's hull",
                                  AT(planning.clearance)));
  keys.push_back(Number<Scenario>("planning.ceiling", Above(0, 1000, "m"),
                                  "flight ceiling of the vehicle's centre above the ground; above "
                                  "the start and the height at which the pad is followed",
                                  AT(planning.ceiling)));
  keys.push_back(
      Whole("planning.guides", 1, 8,
            "most ways around the first obstacle that a step of the landing planner tries; "
            "the cheapest plan wins",
            AT(planning.guides)));
  keys.push_back(Text("solver.backend", "a name of `touchdown list backends`",
                      "optimiser of planner landing; the baseline has lbfgs", AT(solver.backend)));
  keys.push_back(Choice("solver.arrival", {"fixed", "free"},
                        "arrival time chosen before the solve or optimised in it",
                        AT(solver.arrival)));
  keys.push_back(Choice("solver.endpoint", {"eliminated", "explicit"},
                        "both ends of a plan eliminated exactly, or equality constraints",
                        AT(solver.endpoint)));
  keys.push_back(Choice("solver.limits", {"soft", "hard"},
                        "limits as penalties, or as constraints at the full limit",
                        AT(solver.limits)));
  keys.push_back(Number<Scenario>("limits.speed", In(0.5, 20, "m/s"), "norm of the velocity",
                                  AT(limits.speed)));
  keys.push_back(Number<Scenario>("limits.acceleration", In(0.5, 20, "m/s^2"),
                                  "norm of the acceleration; plans keep the lesser of this and "
                                  "g tan(limits.tilt_deg)",
                                  AT(limits.acceleration)));
  keys.push_back(Number<Scenario>("limits.tilt_deg", In(5, 60, "deg"),
                                  "plans accelerate no more than this tilt gives in level flight; "
                                  "the controller may tilt 10 deg more",
                                  AT(limits.tilt_deg)));
}

void AddEgoKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(Number<Scenario>("ego.goal_rate", In(0.1, 100, "Hz"),
                                  "planner ego: the pad's position is sent as a new goal so often",
                                  AT(ego.goal_rate)));
  keys.push_back(Number<Scenario>("ego.horizon", In(1, 50, "m"),
                                  "planner ego: distance of the local target", AT(ego.horizon)));
  keys.push_back(Number<Scenario>("ego.control_point_distance", In(0.05, 2, "m"),
                                  "planner ego: nominal spacing of control points",
                                  AT(ego.control_point_distance)));
  keys.push_back(Number<Scenario>("ego.clearance", In(0, 3, "m"),
                                  "planner ego: wanted beyond the grown obstacles",
                                  AT(ego.clearance)));
  keys.push_back(Number<Scenario>("ego.replan_distance", In(0, 50, "m"),
                                  "planner ego: flown before it replans for no other reason",
                                  AT(ego.replan_distance)));
  keys.push_back(Number<Scenario>("ego.no_replan_distance", In(0, 50, "m"),
                                  "planner ego: to the goal, nearer it replans for none",
                                  AT(ego.no_replan_distance)));
  keys.push_back(Number<Scenario>("ego.emergency_time", In(0, 10, "s"),
                                  "planner ego: a collision sooner than this stops the vehicle",
                                  AT(ego.emergency_time)));
}

void AddTrialKeys(std::vector<SchemaKey<Scenario>>& keys) {
  keys.push_back(
      Number<Scenario>("timeout", In(1, 600, "s"), "a trial ends here at the latest", AT(timeout)));
  keys.push_back(
      {"seed", "whole number", "", "[0, 2^53]", "seed of every random stream",
       [](Scenario& s, const YAML::Node& n, const Where& w) { s.seed = ReadSeed(n, w, "seed"); },
       [](const Scenario& s) { return std::to_string(s.seed); }});
}

}  // namespace

const std::vector<SchemaKey<Scenario>>& ScenarioKeys() {
  static const std::vector<SchemaKey<Scenario>> keys = [] {
    std::vector<SchemaKey<Scenario>> list;
    AddPadKeys(list);
    AddVehicleKeys(list);
    AddSensorKeys(list);
    AddPlanningKeys(list);
    AddEgoKeys(list);
    AddTrialKeys(list);
    return list;
  }();
  return keys;
}

const std::vector<SchemaKey<BoxObstacle>>& BoxKeys() {
  static const std::vector<SchemaKey<BoxObstacle>> keys = {
      Vector<2, BoxObstacle>("centre", In(-200, 200, "m"), "centre of the base in W", AT(centre)),
      Vector<3, BoxObstacle>("size", Above(0, 100, "m"), "edges along x, y and z", AT(size)),
  };
  return keys;
}

const std::vector<SchemaKey<CylinderObstacle>>& CylinderKeys() {
  static const std::vector<SchemaKey<CylinderObstacle>> keys = {
      Vector<2, CylinderObstacle>("centre", In(-200, 200, "m"), "centre of the base in W",
                                  AT(centre)),
      Number<CylinderObstacle>("radius", Above(0, 50, "m"), "radius", AT(radius)),
      Number<CylinderObstacle>("height", Above(0, 100, "m"), "height above the ground", AT(height)),
  };
  return keys;
}

#undef AT

namespace {

/// `name` behind `prefix`, split at its dots.
std::vector<std::string> Behind(const std::string& prefix, const std::string& name) {
  std::vector<std::string> words;
  if (name.rfind(prefix, 0) != 0) return words;
  for (std::size_t begin = prefix.size(); begin <= name.size();) {
    const std::size_t dot = std::min(name.find('.', begin), name.size());
    words.push_back(name.substr(begin, dot - begin));
    begin = dot + 1;
  }
  return words;
}

// Their ranges are the registries': scenario_check asks them.
const ValueRange kAnyNumber = {-1e300, 1e300, false, ""};

std::optional<SchemaKey<Scenario>> FindOpenKey(const std::string& name) {
  SchemaKey<Scenario> key;
  key.name = name;
  if (const auto words = Behind("solver.options.", name); words.size() == 1) {
    key.set = [=](Scenario& s, const YAML::Node& n, const Where& w) {
      s.solver.options[words[0]] = ReadNumber(n, w, name, kAnyNumber);
    };
    return key;
  }
  const auto words = Behind("terms.", name);
  if (words.size() != 2) return std::nullopt;
  key.set = [=](Scenario& s, const YAML::Node& n, const Where& w) {
    s.terms[words[0]][words[1]] =
        words[1] == "hard" ? ReadBool(n, w, name) : ReadNumber(n, w, name, kAnyNumber);
  };
  return key;
}

}  // namespace

std::optional<SchemaKey<Scenario>> FindScenarioKey(const std::string& name) {
  for (const SchemaKey<Scenario>& key : ScenarioKeys()) {
    if (key.name == name) return key;
  }
  return FindOpenKey(name);
}

bool IsOpenGroup(const std::string& name) {
  return name == "solver.options" || name == "terms" || Behind("terms.", name).size() == 1;
}

std::string DumpOpenKeys(const Scenario& scenario) {
  std::string text;
  for (const auto& [name, value] : scenario.solver.options) {
    text += "solver.options." + name + ": " + WriteNumber(value) + "\n";
  }
  for (const auto& [term, keys] : scenario.terms) {
    for (const auto& [key, value] : keys) {
      const std::string written =
          key != "hard" ? WriteNumber(value) : (value != 0.0 ? "true" : "false");
      text += "terms." + term + "." + key + ": " + written + "\n";
    }
  }
  return text;
}

std::string ScenarioKeysMarkdown() {
  const Scenario defaults;
  std::string text =
      "| key | type | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const SchemaKey<Scenario>& key : ScenarioKeys()) {
    text += fmt::format("| `{}` | {} | {} | {} | `{}` | {} |\n", key.name, key.type, key.unit,
                        key.range, key.get(defaults), key.doc);
  }
  text +=
      "| `solver.options.<name>` | number |  | as `touchdown list backends` says | the backend's | "
      "an option of the backend |\n"
      "| `terms.<term>.weight` | number |  | [0, 1e9] | as `touchdown list terms` says | 0 "
      "switches "
      "the term off, a positive weight on |\n"
      "| `terms.<term>.hard` | true or false |  | true or false | by solver.limits | the term as "
      "constraints instead of a cost |\n"
      "| `terms.<term>.<parameter>` | number |  | as `touchdown list terms --json` says | the "
      "term's | a parameter of the term |\n";
  const auto rows = [&text](const std::string& list, const auto& keys) {
    for (const auto& key : keys) {
      text += fmt::format("| `{}[].{}` | {} | {} | {} | required | {} |\n", list, key.name,
                          key.type, key.unit, key.range, key.doc);
    }
  };
  rows("obstacles.boxes", BoxKeys());
  rows("obstacles.cylinders", CylinderKeys());
  return text;
}

}  // namespace touchdown::evaluation
