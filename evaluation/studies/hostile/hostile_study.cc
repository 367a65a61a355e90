// SPDX-License-Identifier: BSD-3-Clause
// A flight is drawn in this order: family, conditions, what goes beyond, --set, world, and --set again for keys of the
// world. The world may depend on the conditions. A world in which the start is not free or the pad's lane is blocked is
// discarded. The next one is drawn from its own stream.
#include "evaluation/studies/hostile/hostile_study.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/studies/hostile/hostile_conditions.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"
#include "sim/base/random_stream.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {
namespace {

constexpr double kTimeout = 100.0;      // with every image [s]
constexpr double kLongest = 600.0;      // that a scenario may last [s]
constexpr double kCatchTime = 45.0;     // in which the pad must be caught [s]
constexpr double kStandLimit = 15.0;    // a flight that stands is over, with every image [s]
constexpr double kLaneHorizon = 150.0;  // of the first look at the lane: more than a round [s]
constexpr int kWorlds = 300;            // that are drawn until one is free

bool Sets(const HostileOptions& options, const std::string& key) {
  return std::any_of(options.set.begin(), options.set.end(),
                     [&](const std::string& text) { return text.rfind(key + "=", 0) == 0; });
}

// Only single keys and lists, because a fixed condition is identified by its key. Seeds and obstacles are the study's.
void ApplySet(const HostileOptions& options, const Registries& registries, Scenario* scenario) {
  for (const std::string& text : options.set) {
    ApplyOverride(text, registries, scenario);  // says what is wrong with the name or the value
    const std::string name = text.substr(0, text.find('='));
    if (name == "seed" || name.rfind("obstacles", 0) == 0) {
      throw BadInput(fmt::format("--set {}: this study draws it for each flight.", text));
    }
    if (!FindScenarioKey(name, ScenarioKeys(registries)) && !IsList(name)) {
      throw BadInput(
          fmt::format("--set {}: {} is a group of keys; set them one by one.", text, name));
    }
  }
}

// A fixed value may contradict a drawn one.
void SuitConditions(const HostileOptions& options, Scenario* s) {
  if (!Sets(options, "planning.latency")) {
    s->planning.latency.ms = std::min(s->planning.latency.ms, std::floor(1e3 * LongestLatency(*s)));
  }
  if (!Sets(options, "wind.max") && s->wind.max > 0.0)
    s->wind.max = std::max(s->wind.max, s->wind.mean);
  if (Sets(options, "wind.direction_deg")) s->wind.direction_random = false;
  const double longer = 1.0 / std::max(1e-3, 1.0 - s->depth.drop);
  if (!Sets(options, "timeout")) s->timeout = std::min(kLongest, std::ceil(kTimeout * longer));
  if (!Sets(options, "stand_limit")) s->stand_limit = std::min(kLongest, kStandLimit * longer);
}

// The part of a scenario that its world is made of; everything else stays.
void DrawWorld(const HostileFamily& family, const std::vector<std::string>& beyond,
               const HostileOptions& options, const Registries& registries, std::uint64_t seed,
               Scenario* scenario) {
  const auto holds = [&](const char* name) {
    return std::find(beyond.begin(), beyond.end(), name) != beyond.end();
  };
  WorldRequest request;
  request.thin_poles = holds(kThinPoles);
  for (int i = 0; i < kWorlds; ++i) {
    Scenario world = *scenario;
    sim::RandomStream draw(seed, fmt::format("hostile world {}", i));
    family.make(request, draw, &world);
    const bool free = StartRoom(world) >= kTakeOffRoom - 1e-9;
    if (holds(kNearObstacle)) AddNearPost(draw, &world);
    TurnWorld(draw, &world);
    ApplySet(options, registries, &world);
    if (!free || !LaneIsClear(world, registries, std::min(world.timeout, kLaneHorizon))) continue;
    if (world.timeout > kLaneHorizon && !LaneIsClear(world, registries, world.timeout)) continue;
    *scenario = std::move(world);
    return;
  }
  throw BadInput(fmt::format("--set {}: no world of the family {} fits it.",
                             fmt::join(options.set, " --set "), family.name));
}

std::string Listed(const std::vector<std::string>& names, const char* separator) {
  return fmt::format("{}", fmt::join(names, separator));
}

std::string ShellWord(const std::string& text) {
  return text.find_first_of(" []{}'\"$&*?;|<>()") == std::string::npos ? text : "'" + text + "'";
}

}  // namespace

std::string HostileCommand(const HostileOptions& options) {
  std::string command = fmt::format("touchdown study hostile --seed {}", options.seed);
  if (!options.families.empty()) command += " --families " + Listed(options.families, ",");
  if (options.share_beyond != HostileOptions().share_beyond) {
    command += fmt::format(" --share-beyond {}", options.share_beyond);
  }
  for (const std::string& text : options.set) command += " --set " + ShellWord(text);
  return command;
}

HostileFlight DrawHostileFlight(const HostileOptions& options, int index,
                                const Registries& registries) {
  const std::vector<std::string> families =
      options.families.empty() ? HostileFamilyNames() : options.families;
  const std::uint64_t seed = TrialSeed(options.seed, index);
  HostileFlight flight;
  flight.index = index;
  sim::RandomStream kind(seed, "hostile kind");
  flight.family =
      families[static_cast<std::size_t>(DrawOneOf(kind, static_cast<int>(families.size())))];
  const bool goes_beyond = DrawChance(kind, options.share_beyond);

  Scenario scenario;
  scenario.name = fmt::format("{}_{}", flight.family, index);
  scenario.seed = seed;
  sim::RandomStream conditions(seed, "hostile conditions");
  DrawConditions(conditions, &scenario);
  if (goes_beyond) {
    sim::RandomStream beyond(seed, "hostile beyond");
    flight.beyond = ChooseBeyond(beyond, flight.family, options.set);
    DrawBeyond(flight.beyond, beyond, &scenario);
  }
  ApplySet(options, registries, &scenario);
  try {
    SuitConditions(options, &scenario);
    DrawWorld(HostileFamilyNamed(flight.family), flight.beyond, options, registries, seed,
              &scenario);
    flight.trial.scenario = ParseScenario(DumpScenario(scenario), scenario.name,
                                          fmt::format("flight {}", index), {}, registries);
    const Scenario& flown = flight.trial.scenario;
    const bool stands = flown.pad.motion == "static";
    flight.way = FindWay(flown, registries, stands ? flown.timeout : kCatchTime);
  } catch (const std::exception& error) {
    if (options.set.empty()) throw;
    throw BadInput(fmt::format("--set {} cannot be used with what is drawn for flight {} ({}): {}",
                               fmt::join(options.set, " --set "), index, flight.family,
                               error.what()));
  }
  flight.trial.index = index;
  flight.trial.seed = seed;
  flight.trial.command =
      fmt::format("{0} --show {1} > flight_{1}.yaml && touchdown land flight_{1}.yaml",
                  HostileCommand(options), index);
  flight.trial.varied = {
      {"family", flight.family},
      {"assumptions", flight.beyond.empty() ? "within" : "beyond"},
      {"beyond", flight.beyond.empty() ? "none" : Listed(flight.beyond, "+")},
      {"way", flight.way.exists ? "yes" : "no"},
      {"way_clearance_m", fmt::format("{:.2f}", flight.way.clearance)},
      {"way_length_m", fmt::format("{:.1f}", flight.way.length)},
  };
  return flight;
}

std::vector<HostileFlight> DrawHostileFlights(const HostileOptions& options, int jobs,
                                              const Registries& registries) {
  std::vector<HostileFlight> flights(static_cast<std::size_t>(options.flights));
  std::vector<std::exception_ptr> faults(flights.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < flights.size(); i = next++) {
      try {
        flights[i] = DrawHostileFlight(options, static_cast<int>(i), registries);
      } catch (...) {
        faults[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& fault : faults) {
    if (fault) std::rethrow_exception(fault);
  }
  return flights;
}

Campaign HostileCampaign(const HostileOptions& options, const std::vector<HostileFlight>& flights) {
  Campaign campaign;
  campaign.name = "study hostile";
  campaign.seed = options.seed;
  campaign.keys = {{"family", "", false},          {"assumptions", "", false},
                   {"beyond", "", true},           {"way", "", true},
                   {"way_clearance_m", "m", true}, {"way_length_m", "m", true}};
  campaign.facts = {{"set", nlohmann::json(options.set).dump()},
                    {"vary", "[]"},
                    {"families", Listed(options.families, ",")},
                    {"share_beyond", fmt::format("{}", options.share_beyond)}};
  for (const HostileFlight& flight : flights) campaign.trials.push_back(flight.trial);
  return campaign;
}

}  // namespace touchdown::evaluation
