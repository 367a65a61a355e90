// SPDX-License-Identifier: BSD-3-Clause
// Everything is drawn for every flight, whether or not it is used. So a value that is fixed on the command line, or
// goes beyond the assumptions, never shifts another draw.
#include "evaluation/studies/hostile/hostile_conditions.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/degrees.h"
#include "evaluation/base/words.h"
#include "evaluation/studies/hostile/hostile_world.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::evaluation {
namespace {

constexpr double kStillShare = 0.25;  // of the flights has no wind at all
constexpr double kMsPerS = 1e3;
constexpr double kMostMs = 200.0;  // of latency that is assumed [ms]

double LongestLatencyMs(const Scenario& s) {
  return std::min(kMostMs, std::floor(kMsPerS / s.planning.rate / 2.0) * 2.0);
}

// 1 +- a deviation, away from 1 by at least `least`.
double Factor(sim::RandomStream& draw, double least, double most) {
  const double size = DrawIn(draw, {least, most});
  return DrawChance(draw, 0.5) ? 1.0 + size : 1.0 - size;
}

bool Fixed(const HostileCondition& condition, const std::vector<std::string>& fixed) {
  for (const std::string& key : Split(condition.keys, ',')) {
    for (const std::string& text : fixed) {
      if (text.rfind(key, 0) == 0) return true;
    }
  }
  return false;
}

bool Holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

const std::vector<HostileCondition>& HostileConditions() {
  static const std::vector<HostileCondition> conditions = {
      {"noise", "depth.noise", "0 to 0.02", "0.02 to 0.05"},
      {"depth_rate", "depth.rate", "5 to 15 Hz", "2 to 5 Hz"},
      {"drop", "depth.drop", "0 to 0.95", "0.95 to 0.99"},
      {"depth_latency", "depth.latency_ms", "0 to 200 ms", "200 to 400 ms"},
      {"pixels", "depth.width,depth.height", "80 x 60", "40 x 30"},
      {"planning_rate", "planning.rate", "5 to 15 Hz", "2 to 5 Hz"},
      {"", "planning.latency", "0 to 200 ms and the period", ""},
      {"own_sensors", "own_state,own.gps.sigma",
       "true, or estimated with the shipped noise: one in two",
       "estimated, own.gps.sigma 0.05 to 0.2 m"},
      {"wind", "wind.", "none in 1 of 4, else mean 0 to 11, greatest from there to 15 m/s",
       "mean 11 to 14, greatest from there to 20 m/s"},
      {"plant", "plant.", "each factor 0.8 to 1.2", "each off by 20 to 30 %"},
      {"pad_gps", "gps.sigma", "0.01 to 1 m, evenly in its logarithm", "1 to 2 m"},
      {"", "limits.acceleration", "0.5 m/s^2 to what a tilt of 35 degrees gives", ""},
      {"", "pad.deck_height", "0.3 to 0.7 m", ""},
      {kThinPoles, "obstacles", "poles of 10 cm on", "poles of 3 to 10 cm (family poles)"},
      {kNearObstacle, "start.", "0.9 m from the body's centre to anything",
       "a post 0.4 to 0.8 m from it"},
  };
  return conditions;
}

void DrawConditions(sim::RandomStream& draw, Scenario* s) {
  s->depth.noise = DrawIn(draw, {0.0, 0.02});
  s->depth_rate = DrawIn(draw, {5.0, 15.0});
  s->depth.drop = DrawIn(draw, {0.0, 0.95});
  s->depth.latency_ms = DrawIn(draw, {0.0, kMostMs});
  s->planning.rate = DrawIn(draw, {5.0, 15.0});
  s->planning.latency.ms = DrawIn(draw, {0.0, 1.0}) * LongestLatencyMs(*s);
  s->own_state = DrawChance(draw, 0.5) ? OwnStateKind::kEstimated : OwnStateKind::kTrue;
  const bool still = DrawChance(draw, kStillShare);
  const double mean = DrawIn(draw, {0.0, 11.0}), most = DrawIn(draw, {mean, 15.0});
  if (!still) {
    s->wind.mean = mean;
    s->wind.max = most;
  }
  for (double* factor :
       {&s->plant.mass, &s->plant.inertia, &s->plant.drag, &s->plant.rotor_lag, &s->plant.thrust}) {
    *factor = DrawIn(draw, {0.8, 1.2});
  }
  s->gps.sigma = std::pow(10.0, DrawIn(draw, {-2.0, 0.0}));
  const double by_tilt =
      estimation::kGravity * std::tan(s->limits.tilt_deg * estimation::kRadPerDeg);
  s->limits.acceleration = DrawIn(draw, {0.5, by_tilt});
  s->pad.deck_height = DrawIn(draw, {0.3, 0.7});
}

std::vector<std::string> ChooseBeyond(sim::RandomStream& draw, const std::string& family,
                                      const std::vector<std::string>& fixed) {
  std::vector<std::string> left;
  for (const HostileCondition& condition : HostileConditions()) {
    const std::string name = condition.name;
    if (name.empty() || Fixed(condition, fixed)) continue;
    if (name == kThinPoles && family != "poles") continue;
    left.push_back(name);
  }
  const int wanted = 1 + DrawOneOf(draw, 3);
  std::vector<std::string> chosen;
  while (!left.empty() && static_cast<int>(chosen.size()) < wanted) {
    const auto at = left.begin() + DrawOneOf(draw, static_cast<int>(left.size()));
    chosen.push_back(*at);
    left.erase(at);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void DrawBeyond(const std::vector<std::string>& beyond, sim::RandomStream& draw, Scenario* s) {
  const auto put = [&](const char* name, double* value, const Span& range) {
    const double drawn = DrawIn(draw, range);
    if (Holds(beyond, name)) *value = drawn;
  };
  put("noise", &s->depth.noise, {0.02, 0.05});
  put("depth_rate", &s->depth_rate, {2.0, 5.0});
  put("drop", &s->depth.drop, {0.95, 0.99});
  put("depth_latency", &s->depth.latency_ms, {200.0, 400.0});
  put("planning_rate", &s->planning.rate, {2.0, 5.0});
  put("own_sensors", &s->own.gps.sigma, {0.05, 0.2});
  if (Holds(beyond, "own_sensors")) s->own_state = OwnStateKind::kEstimated;
  put("wind", &s->wind.mean, {11.0, 14.0});
  put("wind", &s->wind.max, {s->wind.mean, 20.0});
  put("pad_gps", &s->gps.sigma, {1.0, 2.0});
  for (double* factor :
       {&s->plant.mass, &s->plant.inertia, &s->plant.drag, &s->plant.rotor_lag, &s->plant.thrust}) {
    const double drawn = Factor(draw, 0.2, 0.3);
    if (Holds(beyond, "plant")) *factor = drawn;
  }
  if (Holds(beyond, "pixels")) {
    s->depth.width = 40;
    s->depth.height = 30;
  }
}

void AddNearPost(sim::RandomStream& draw, Scenario* scenario) {
  const double room = DrawIn(draw, {0.4, 0.8}), diameter = DrawIn(draw, {0.1, 0.4});
  const double bearing = DrawIn(draw, {0.0, 360.0}) * estimation::kRadPerDeg;
  const Eigen::Vector2d start = scenario->start.position.head<2>();
  const Eigen::Vector2d p =
      start + (room + 0.5 * diameter) * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
  AddPost(p.x(), p.y(), diameter, kTallWall, scenario);
}

}  // namespace touchdown::evaluation
