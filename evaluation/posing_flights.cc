// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/posing_flights.h"

#include <memory>
#include <utility>

#include <fmt/format.h>
#include <wordexp.h>
#include <nlohmann/json.hpp>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/campaign_facts.h"
#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/hostile_study.h"
#include "touchdown/evaluation/record_reader.h"
#include "touchdown/evaluation/replay.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/evaluation/split.h"
#include "touchdown/evaluation/sqlite_db.h"
#include "touchdown/evaluation/sweep.h"

namespace touchdown::evaluation {
namespace {

constexpr const char* kForest = "forest";
constexpr const char* kHostile = "study hostile";  // as its files say

// Who listens takes time in a step: where the clock decides the flight it would be another one.
PosingFlight Flown(SweepTrial trial, std::string command) {
  if (trial.FliesAlone()) {
    throw BadInput(fmt::format(
        "{}: with planning.latency: measured the flight depends on the clock.", command));
  }
  return {std::move(command), [trial = std::move(trial)](const Registries& registries) {
            RunTrial(trial.scenario, trial.seed, registries);
          }};
}

PosingFlight HostileFlightOf(const HostileOptions& options, int index,
                             const Registries& registries) {
  return Flown(DrawHostileFlight(options, index, registries).trial,
               fmt::format("{} --only {}", HostileCommand(options), index));
}

PosingFlight LandingOf(const std::string& scenario, const std::vector<std::string>& overrides,
                       std::uint64_t seed, const Registries& registries) {
  SweepTrial trial = MakeTrial(FindScenario(scenario), overrides, registries);
  trial.seed = seed;
  return Flown(trial, trial.Replay());
}

// The words of a command line as a shell reads them.
std::vector<std::string> Words(const std::string& command) {
  wordexp_t expanded;
  std::vector<std::string> words;
  if (wordexp(command.c_str(), &expanded, WRDE_NOCMD) != 0) return words;
  words.assign(expanded.we_wordv, expanded.we_wordv + expanded.we_wordc);
  wordfree(&expanded);
  return words;
}

struct FlownTrial {
  int trial = 0;
  std::uint64_t seed = 0;
  std::string replay;
};

std::vector<FlownTrial> FlownTrials(SqliteDb& db) {
  std::vector<FlownTrial> trials;
  SqliteStatement rows = db.Prepare(
      "SELECT planned.trial, planned.seed, replay FROM planned JOIN trial USING(trial) ORDER BY 1");
  while (rows.Step()) {
    trials.push_back({static_cast<int>(rows.Integer(0)),
                      static_cast<std::uint64_t>(rows.Integer(1)), rows.Text(2)});
  }
  return trials;
}

// "touchdown land SCENARIO --set A=B ... --seed N", as MakeTrial writes it.
PosingFlight Again(const FlownTrial& trial, const std::vector<std::string>& overrides,
                   const std::string& path, const Registries& registries) {
  const std::vector<std::string> words = Words(trial.replay);
  if (words.size() < 3 || words[1] != "land") {
    throw BadInput(fmt::format("{}: trial {} cannot be flown again from `{}`.", path, trial.trial,
                               trial.replay));
  }
  std::vector<std::string> set;
  for (std::size_t i = 3; i + 1 < words.size(); ++i) {
    if (words[i] == "--set") set.push_back(words[++i]);
  }
  set.insert(set.end(), overrides.begin(), overrides.end());
  return LandingOf(words[2], set, trial.seed, registries);
}

// The options of the study whose file has this manifest.
HostileOptions HostileOptionsOf(const Manifest& manifest,
                                const std::vector<std::string>& overrides) {
  HostileOptions options;
  options.seed = std::stoull(manifest.at("sweep_seed"));
  options.share_beyond = std::stod(manifest.at("share_beyond"));
  if (!manifest.at("families").empty()) options.families = Split(manifest.at("families"), ',');
  options.set = nlohmann::json::parse(manifest.at("set")).get<std::vector<std::string>>();
  options.set.insert(options.set.end(), overrides.begin(), overrides.end());
  return options;
}

FlightSource TrialsOf(SqliteDb& db, const std::string& path,
                      const std::vector<std::string>& overrides, const Registries& registries) {
  const Manifest manifest = ReadManifest(db, path);
  const std::vector<FlownTrial> trials = FlownTrials(db);
  const bool hostile = manifest.at("campaign") == kHostile;
  const HostileOptions options = hostile ? HostileOptionsOf(manifest, overrides) : HostileOptions();
  return {static_cast<int>(trials.size()), [=](int index) {
            const FlownTrial& trial = trials[static_cast<std::size_t>(index)];
            return hostile ? HostileFlightOf(options, trial.trial, registries)
                           : Again(trial, overrides, path, registries);
          }};
}

FlightSource RecordOf(const std::string& path, const std::vector<std::string>& overrides,
                      const Registries& registries) {
  const auto flight =
      std::make_shared<const RecordedFlight>(ReadRecord(path, overrides, registries));
  if (flight->plans.empty()) {
    throw BadInput(fmt::format("{}: it holds no replanning step.", path));
  }
  const auto ask_again = [flight](const Registries& overheard) {
    Replay replay(*flight, overheard);
    for (int step = 0; step < replay.steps(); ++step) {
      replay.Seek(step);
      replay.Solve();
    }
  };
  return {1, [=](int) {
            return PosingFlight{fmt::format("the replanning steps of {}", flight->path), ask_again};
          }};
}

bool HoldsTrials(SqliteDb& db) {
  SqliteStatement found =
      db.Prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'manifest'");
  return found.Step();
}

}  // namespace

FlightSource DrawnFlights(std::uint64_t seed, const std::vector<std::string>& overrides,
                          const Registries& registries) {
  HostileOptions hostile;
  hostile.seed = seed;
  hostile.share_beyond = 0.0;
  hostile.set = overrides;
  return {std::nullopt, [=](int index) {
            return index % 2 == 1
                       ? HostileFlightOf(hostile, index / 2, registries)
                       : LandingOf(kForest, overrides, TrialSeed(seed, index / 2), registries);
          }};
}

FlightSource FlightsOf(const std::string& path, const std::vector<std::string>& overrides,
                       const Registries& registries) {
  try {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    if (HoldsTrials(db)) return TrialsOf(db, path, overrides, registries);
  } catch (const SqliteError& error) {
    throw BadInput(fmt::format("{}.", error.what()));
  }
  return RecordOf(path, overrides, registries);
}

}  // namespace touchdown::evaluation
