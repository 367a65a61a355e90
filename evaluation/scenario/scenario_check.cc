// SPDX-License-Identifier: BSD-3-Clause
// Checks across keys. The start is a box of positions (its spread): every obstacle must stay
// outside it by the vehicle's hull. The pad's path is sampled every 0.1 s until the time-out, for
// both ends of the drawn phase. Every obstacle must stay outside the deck's circumscribed circle.
#include "evaluation/scenario/scenario_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "estimation/tags/pad_sheet.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/map_file.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/base/words.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/scenario/scenario_world.h"
#include "planning/replan/prepared_problems.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_import.h"
#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/sim/vehicle/plant.h"

namespace touchdown::evaluation {
namespace {

constexpr int kProbeSegments = 64;  // the longest problem of the planner: a backend may mind
constexpr double kPathStep = 0.1;   // [s], and [m] along the drawn phase
constexpr double kHeadroom = 0.4;   // of the pad under a roof [m]

estimation::VehicleModel ReadVehicle(const ScenarioSource& source) {
  try {
    return sim::LoadVehicleModel(VehicleMjcf(source.scenario));
  } catch (const std::invalid_argument& error) {
    std::string why = WithoutStop(error.what());  // MuJoCo's own words may have several lines
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw BadInput(fmt::format("{}: vehicle {}: {}.", source.WhereOf("vehicle").ToString(),
                               source.scenario.vehicle, why));
  }
}

// With the line of the element whose file is at fault.
ObstacleList ReadObstacles(const ScenarioSource& source) {
  try {
    return ObstaclesOf(source.scenario);
  } catch (const BadInput& error) {
    const std::string why = error.what();
    const std::string key = why.substr(0, why.find(':'));
    throw BadInput(fmt::format("{}: {}", source.WhereOf(key).ToString(), why));
  }
}

void CheckCeiling(const ScenarioSource& source, const estimation::VehicleModel& model) {
  const Scenario& s = source.scenario;
  const double followed =
      s.pad.deck_height + control::MissionParameters{}.follow_height + model.foot_depth;
  const std::pair<double, const char*> lowest =
      std::max({std::pair{control::LowestPlan(model), "the floor of plans"},
                std::pair{s.start.position.z() + s.start.position_spread.z(),
                          "start.position with its spread"},
                std::pair{followed, "the height at which the pad is followed"}});
  if (s.planning.ceiling <= lowest.first) {
    throw BadInput(
        fmt::format("{}: planning.ceiling must be in ({:.4g}, 1000] m, above {}, not "
                    "'{}'.",
                    source.WhereOf("planning.ceiling").ToString(), lowest.first, lowest.second,
                    s.planning.ceiling));
  }
}

void CheckPlanning(const ScenarioSource& source, const estimation::VehicleModel& model,
                   const Registries& registries) {
  const Scenario& s = source.scenario;
  const PlanningLatency& latency = s.planning.latency;
  const double longest = 1e3 * LongestLatency(s);
  if (!latency.measured && latency.ms > longest) {
    // If the latency has its default, the fault is a rate that is too high.
    const bool chosen = source.where.count("planning.latency") != 0;
    throw BadInput(fmt::format(
        "{}: planning.latency must be in [0, {:.4g}] ms, the time between two replanning steps at "
        "a planning.rate of {} Hz, not '{}'.",
        source.WhereOf(chosen ? "planning.latency" : "planning.rate").ToString(), longest,
        s.planning.rate, latency.ms));
  }
  const PlannerEntry& planner = PlannerOf(s, registries);
  if (planner.avoids && !planner.proves && s.planning.clearance < model.hull_radius) {
    throw BadInput(fmt::format(
        "{}: planning.clearance must be in [{:.4g}, 1] m, from the radius of the vehicle's hull "
        "on, with planner {}, not '{}'.",
        source.WhereOf("planning.clearance").ToString(), model.hull_radius, s.planner,
        s.planning.clearance));
  }
  const double most = 10.0 * planning::OccupancyMapOptions{}.resolution;
  if (const double kept = PlanClearance(s, model, registries); kept > most) {
    throw BadInput(
        fmt::format("{}: vehicle {}: its hull at every tilt and the margins of the landing planner "
                    "are {:.2f} m, "
                    "they must be at most {:g} m.",
                    source.WhereOf("vehicle").ToString(), s.vehicle, kept, most));
  }
  CheckCeiling(source, model);
}

void CheckStart(const ScenarioSource& source, const ObstacleList& obstacles,
                const estimation::VehicleModel& model) {
  const Scenario& s = source.scenario;
  const Eigen::Vector3d& p = s.start.position;
  const Eigen::Vector3d& spread = s.start.position_spread;
  const double lowest = p.z() - spread.z() - model.foot_depth;
  if (lowest < 0.1) {
    throw BadInput(
        fmt::format("{}: start.position puts the feet at {:.2f} m; they must start at least 0.1 m "
                    "above ground.",
                    source.WhereOf("start.position").ToString(), lowest));
  }
  for (const NamedObstacle& named : obstacles) {
    const double gap = HorizontalGap(named.obstacle, p.head<2>(), spread.head<2>(), lowest,
                                     p.z() + spread.z() + model.hull_top, model.hull_radius);
    if (gap < model.hull_radius) {
      throw BadInput(
          fmt::format("{}: {} stands on the start: it must stay more than {:.2f} m (the hull) from "
                      "start.position "
                      "with its spread, and is at {:.2f} m.",
                      source.WhereOf(named.key).ToString(), named.key, model.hull_radius, gap));
    }
  }
}

void ApplyTermKey(const planning::TermEntry& entry, const std::string& key,
                  const planning::TermSettings& settings) {
  planning::TermSetup setup = planning::DefaultSetup(entry, kProbeSegments + 3);
  try {
    planning::ApplySettings(entry, settings, &setup);
  } catch (const std::invalid_argument& error) {
    std::vector<std::string> keys = {"weight", "hard"};
    for (const planning::TermParameter& parameter : entry.parameters) {
      keys.push_back(parameter.name);
    }
    throw std::invalid_argument(WithSuggestion(error.what(), key, keys));
  }
}

// Each key alone, so that the sentence names the place it came from.
void CheckTerms(const ScenarioSource& source, const planning::TermRegistry& terms) {
  for (const auto& [name, keys] : source.scenario.terms) {
    for (const auto& [key, value] : keys) {
      try {
        const planning::TermEntry& entry = TermNamed(terms, name);
        if (entry.use == planning::TermUse::kMovingObstacles) {
          throw std::invalid_argument(
              "term " + name +
              " does nothing in a flight: a flight has no source of moving obstacles");
        }
        ApplyTermKey(entry, key, TermSettingsOf(name, {{key, value}}));
      } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format(
            "{}: {}.", source.WhereOf("terms." + name + "." + key).ToString(), error.what()));
      }
    }
  }
}

// The backend is asked about the problem that it will be given.
void CheckSolver(const ScenarioSource& source, const estimation::VehicleModel& model,
                 const Registries& registries) {
  const Scenario& s = source.scenario;
  if (!PlannerOf(s, registries).solver.empty()) return;  // it has no choice
  const auto known = [&](const solvers::BackendEntry& entry) {
    return entry.name == s.solver.backend;
  };
  if (std::none_of(registries.backends.begin(), registries.backends.end(), known)) {
    std::vector<std::string> names;
    for (const solvers::BackendEntry& entry : registries.backends) names.push_back(entry.name);
    throw BadInput(fmt::format("{}: solver.backend must be {}, not '{}'{}.",
                               source.WhereOf("solver.backend").ToString(), Enumerate(names),
                               s.solver.backend, DidYouMean(s.solver.backend, names)));
  }
  const auto backend = solvers::MakeBackend(registries.backends, s.solver.backend);
  for (const auto& [name, value] : s.solver.options) {
    try {
      backend->options().Set(name, value);
    } catch (const std::invalid_argument& error) {
      std::vector<std::string> names;
      for (const solvers::OptionSpec& spec : backend->options().specs()) names.push_back(spec.name);
      throw BadInput(fmt::format("{}: {} (backend {}).",
                                 source.WhereOf("solver.options." + name).ToString(),
                                 WithSuggestion(error.what(), name, names), s.solver.backend));
    }
  }
  const planning::ReplannerOptions options = PlannerOptions(s, model, registries.terms);
  const planning::LandingProblem problem(kProbeSegments,
                                         planning::ProblemOptions(options, options.arrival));
  const std::string refusal = backend->Refusal(problem.view());
  if (refusal.empty()) return;
  std::string key = "solver.backend";
  for (const char* other : {"solver.limits", "solver.endpoint", "solver.arrival"}) {
    if (source.where.count(key) == 0) key = other;
  }
  throw BadInput(fmt::format("{}: {}.", source.WhereOf(key).ToString(), refusal));
}

void CheckOutage(const ScenarioSource& source, const std::string& key,
                 const Eigen::Vector2d& outage) {
  if (outage[1] >= outage[0]) return;
  throw BadInput(fmt::format("{}: {} must not end before it begins, and is [{}, {}] s.",
                             source.WhereOf(key).ToString(), key, outage[0], outage[1]));
}

void CheckSensors(const ScenarioSource& source) {
  const Scenario& s = source.scenario;
  CheckOutage(source, "gps.outage", s.gps.outage);
  CheckOutage(source, "own.gps.outage", s.own.gps.outage);
  CheckOutage(source, "camera.outage", s.camera.outage);
  CheckOutage(source, "depth.outage", s.depth.outage);
  constexpr std::size_t kMostCameras = 8;
  if (s.depth.cameras.size() > kMostCameras) {
    throw BadInput(fmt::format("{}: depth.cameras lists {} cameras, {} are allowed.",
                               source.WhereOf("depth.cameras[0]").ToString(),
                               s.depth.cameras.size(), kMostCameras));
  }
  if (s.own_state == OwnStateKind::kEstimated && s.own.gps.rate <= 0.0 &&
      s.own.odometry.rate <= 0.0) {
    throw BadInput(fmt::format(
        "{}: own.gps.rate must be in (0, 100] Hz with own_state: estimated, or own.odometry.rate "
        "in (0, 200] Hz: without both the vehicle cannot tell where it is.",
        source.WhereOf("own.gps.rate").ToString()));
  }
  if (s.sensing == SensingKind::kRendered) {
    RequireSheetRoom(s, source.WhereOf("pad.deck_size").ToString(), "sensing: rendered");
  }
}

void CheckDescent(const ScenarioSource& source, const Registries& registries) {
  const Scenario& s = source.scenario;
  if (!PlansContact(s) || PlannerOf(s, registries).lands) return;
  throw BadInput(
      fmt::format("{}: descent must be vertical with planner {}, whose "
                  "plans do not lead to contact, not 'planned'.",
                  source.WhereOf("descent").ToString(), s.planner));
}

// Where no plan can end, in the world as it is.
void CheckGoal(const ScenarioSource& source, const ObstacleList& obstacles,
               const estimation::VehicleModel& model, const Registries& registries) {
  const Scenario& s = source.scenario;
  if (s.task != TaskKind::kGoTo) return;
  const std::string where = source.WhereOf("go_to.goal").ToString();
  const double low = control::LowestPlan(model), z = s.go_to.goal.z();
  if (z < low || z > s.planning.ceiling) {
    throw BadInput(
        fmt::format("{}: go_to.goal must be in [{:.4g}, {:g}] m in z, from the floor of plans to "
                    "planning.ceiling, not '{}'.",
                    where, low, s.planning.ceiling, z));
  }
  // An obstacle fills the cells that it reaches into, and a goal lies in one.
  const double needed =
      PlanClearance(s, model, registries) + 2.0 * planning::OccupancyMapOptions{}.resolution;
  for (const NamedObstacle& named : obstacles) {
    const double gap = sim::SignedDistance(named.obstacle, s.go_to.goal);
    if (gap >= needed) continue;
    throw BadInput(fmt::format("{}: go_to.goal must be {:.2f} m from {}, and is at {:.2f} m.",
                               where, needed, named.key, gap));
  }
}

void CheckPriorMap(const ScenarioSource& source) {
  const std::string& path = source.scenario.map_prior;
  if (path == "none") return;
  try {
    planning::PersistentMap map{planning::OccupancyMapOptions{}};
    ReadMapFile(path, &map);
  } catch (const std::invalid_argument& error) {
    throw BadInput(
        fmt::format("{}: map.prior {}.", source.WhereOf("map.prior").ToString(), error.what()));
  }
}

// What differs from its default without any effect; a dump holds every default.
void RefuseWithout(const ScenarioSource& source, const std::string& prefix,
                   const std::string& why) {
  for (const SchemaKey<Scenario>& key : ScenarioKeys()) {
    if (key.name.rfind(prefix, 0) != 0 || key.get(source.scenario) == key.get(Scenario{})) continue;
    throw BadInput(fmt::format("{}: {} has no effect {}.", source.WhereOf(key.name).ToString(),
                               key.name, why));
  }
}

void CheckAirframe(const ScenarioSource& source) {
  const std::string& vehicle = source.scenario.vehicle;
  if (vehicle == "default") {
    RefuseWithout(source, "airframe.", "with vehicle: default");
  } else if (sim::IsInOwnForm(vehicle)) {
    RefuseWithout(source, "airframe.", fmt::format("on {}, which says everything itself", vehicle));
  }
}

void CheckAir(const ScenarioSource& source, const estimation::VehicleModel& model) {
  const Scenario& s = source.scenario;
  if (s.wind.direction_random) {
    RefuseWithout(source, "wind.direction_deg", "with wind.direction_random: true");
  }
  if (s.wind.max > 0.0 && s.wind.max < s.wind.mean) {
    throw BadInput(
        fmt::format("{}: wind.max must be 0 or in [{}, 40] m/s, from wind.mean on, not '{}'.",
                    source.WhereOf("wind.max").ToString(), s.wind.mean, s.wind.max));
  }
  const Scenario::Wind::Gust& gust = s.wind.gust;
  if (gust.period > 0.0 && gust.period < gust.duration) {
    throw BadInput(fmt::format(
        "{}: wind.gust.period must be 0 or in [{}, 600] s, from wind.gust.duration on, not '{}'.",
        source.WhereOf("wind.gust.period").ToString(), gust.duration, gust.period));
  }
  if (s.air.ground_effect && !(model.rotor_radius > 0.0)) {
    throw BadInput(
        fmt::format("{}: air.ground_effect needs a vehicle whose rotor sites are cylinders of its "
                    "rotors' radius.",
                    source.WhereOf("air.ground_effect").ToString()));
  }
  try {
    sim::AlteredVehicle(model, s.plant);
  } catch (const std::invalid_argument& error) {
    const char* key = s.plant.mass > 1.0 ? "plant.mass" : "plant.thrust";
    throw BadInput(fmt::format("{}: {}.", source.WhereOf(key).ToString(), error.what()));
  }
}

// The motion's own limits, at the key they come from.
void CheckMotionItself(const ScenarioSource& source, const Registries& registries) {
  const Scenario& s = source.scenario;
  try {
    PadCourseOf(s, registries, s.pad.phase, s.seed);
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    if (text.starts_with("pad.waypoints")) {
      throw BadInput(fmt::format("{}: {}.", source.WhereOf("pad.waypoints").ToString(), text));
    }
    std::string key = "pad.motion";
    for (const char* other : {"pad.speed", "pad.turn_rate", "pad.acceleration", "pad.jerk",
                              "pad.go_time", "pad.stop_time", "pad.phase"}) {
      if (text.find(other) != text.npos) key = other;
    }
    if (text.find("pad.turn_angle") != text.npos) key = "pad.turn_deg";
    throw BadInput(fmt::format("{}: {} does not suit this pad.motion: {}.",
                               source.WhereOf(key).ToString(), key, text));
  }
}

void CheckPadMotion(const ScenarioSource& source, const ObstacleList& obstacles,
                    const Registries& registries) {
  const Scenario& s = source.scenario;
  CheckMotionItself(source, registries);
  const PadMotionEntry& motion = PartNamed(registries.pad_motions, s.pad.motion, "pad motion");
  if (!motion.has_phase && s.pad.phase_spread > 0.0) {
    throw BadInput(fmt::format("{}: pad.phase_spread must be 0 with this pad.motion, not '{}'.",
                               source.WhereOf("pad.phase_spread").ToString(), s.pad.phase_spread));
  }
  // Where it will drive is known for one seed only.
  if (motion.drawn && !obstacles.empty()) {
    throw BadInput(fmt::format("{}: pad.motion: {} is for scenarios without obstacles.",
                               source.WhereOf("pad.motion").ToString(), motion.name));
  }
}

// The pad may begin anywhere in the drawn phase. Its path there is sampled like its later path.
void CheckStartBesidePad(const ScenarioSource& source, const estimation::VehicleModel& model,
                         const Registries& registries) {
  const Scenario& s = source.scenario;
  const Eigen::Vector3d& p = s.start.position;
  const Eigen::Vector3d& spread = s.start.position_spread;
  if (p.z() - spread.z() - model.foot_depth > s.pad.deck_height) return;
  const double needed = s.pad.deck_size * std::sqrt(0.5) + model.hull_radius;
  const int steps = static_cast<int>(std::ceil(2.0 * s.pad.phase_spread / kPathStep));
  for (int i = 0; i <= steps; ++i) {
    const double shift = std::min(i * kPathStep, 2.0 * s.pad.phase_spread) - s.pad.phase_spread;
    const auto course = PadCourseOf(s, registries, s.pad.phase + shift, s.seed);
    const Eigen::Vector2d offset = course->At(0.0).p_WP.head<2>() - p.head<2>();
    const double gap = (offset.cwiseAbs() - spread.head<2>()).cwiseMax(0.0).norm();
    if (gap <= needed) {
      throw BadInput(fmt::format(
          "{}: start.position must be above the deck or more than {:.2f} m from the pad's centre, "
          "and with its spread is at {:.2f} m.",
          source.WhereOf("start.position").ToString(), needed, gap));
    }
  }
}

void CheckPadPath(const ScenarioSource& source, const ObstacleList& obstacles,
                  const Registries& registries) {
  const Scenario& s = source.scenario;
  const double half_diagonal = s.pad.deck_size * std::sqrt(0.5);
  std::vector<sim::Bounds> bounds;
  for (const NamedObstacle& named : obstacles) bounds.push_back(sim::BoundsOf(named.obstacle));
  const sim::BoundsTree tree(bounds);
  const Eigen::Vector3d reach(half_diagonal, half_diagonal, s.pad.deck_height + kHeadroom);
  for (const double shift : {-s.pad.phase_spread, s.pad.phase_spread}) {
    const auto course = PadCourseOf(s, registries, s.pad.phase + shift, s.seed);
    for (int i = 0; i * kPathStep <= s.timeout; ++i) {
      const double t = i * kPathStep;
      const Eigen::Vector2d p_WP = course->At(t).p_WP.head<2>();
      const Eigen::Vector3d base(p_WP.x(), p_WP.y(), 0.0);
      tree.Within({base - reach, base + reach}, [&](int index) {
        const NamedObstacle& named = obstacles[static_cast<std::size_t>(index)];
        const double gap = HorizontalGap(named.obstacle, p_WP, Eigen::Vector2d::Zero(), 0.0,
                                         s.pad.deck_height + kHeadroom, half_diagonal);
        if (gap < half_diagonal) {
          throw BadInput(fmt::format(
              "{}: {} stands on the pad's way: at {:.1f} s its centre passes at {:.3f} m, and the "
              "deck needs {:.3f} m. Move it, or change the pad's start, heading, speed or turn "
              "rate.",
              source.WhereOf(named.key).ToString(), named.key, t, gap, half_diagonal));
        }
      });
    }
  }
}

}  // namespace

Where ScenarioSource::WhereOf(const std::string& key) const {
  const auto found = where.find(key);
  if (found != where.end()) return found->second;
  Where whole;
  whole.file = file;
  return whole;
}

const planning::TermEntry& TermNamed(const planning::TermRegistry& terms, const std::string& name) {
  try {
    return planning::FindTerm(terms, name);
  } catch (const std::invalid_argument& error) {
    std::vector<std::string> names;
    for (const planning::TermEntry& entry : terms) names.push_back(entry.info.name);
    throw std::invalid_argument(WithSuggestion(error.what(), name, names));
  }
}

void RequireSheetRoom(const Scenario& scenario, const std::string& where, const std::string& with) {
  const double size = scenario.pad.deck_size;
  if (size >= estimation::kPadSheetSide) return;
  throw BadInput(
      fmt::format("{}: pad.deck_size must be in [{}, 5] m with {}, which needs room for the pad's "
                  "printed sheet, not '{}'.",
                  where, estimation::kPadSheetSide, with, size));
}

void CheckScenario(const ScenarioSource& source, const Registries& registries) {
  const ObstacleList obstacles = ReadObstacles(source);
  CheckPadMotion(source, obstacles, registries);
  CheckSensors(source);
  const estimation::VehicleModel model = ReadVehicle(source);
  CheckAirframe(source);
  CheckPlanning(source, model, registries);
  CheckDescent(source, registries);
  CheckAir(source, model);
  CheckTerms(source, registries.terms);
  CheckSolver(source, model, registries);
  CheckPriorMap(source);
  CheckGoal(source, obstacles, model, registries);
  CheckStart(source, obstacles, model);
  CheckStartBesidePad(source, model, registries);
  CheckPadPath(source, obstacles, registries);
}

}  // namespace touchdown::evaluation
