// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/compare/source_flights.h"

#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <wordexp.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/words.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/judge/landing_judge.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/record/replay.h"
#include "evaluation/studies/hostile/hostile_study.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {
namespace {

constexpr const char* kForest = "forest";
constexpr const char* kHostile = "study hostile";  // as its files say

// A listener takes time in a step. A flight that depends on the clock would change.
SourceFlight Flown(SweepTrial trial, std::string command,
                   std::function<std::string(const TrialResult&)> judge) {
  if (trial.FliesAlone()) {
    throw BadInput(fmt::format(
        "{}: with planning.latency: measured the flight depends on the clock.", command));
  }
  return {std::move(command),
          [trial = std::move(trial), judge = std::move(judge)](const Registries& registries) {
            return judge(RunTrial(trial.scenario, trial.seed, registries));
          }};
}

using Judge = std::function<std::string(const TrialResult&)>;

std::string NothingKnown(const TrialResult&) { return ""; }

SourceFlight HostileFlightOf(const HostileOptions& options, int index, const Registries& registries,
                             const Judge& judge = NothingKnown) {
  return Flown(DrawHostileFlight(options, index, registries).trial,
               fmt::format("{} --only {}", HostileCommand(options), index), judge);
}

SourceFlight LandingOf(const std::string& scenario, const std::vector<std::string>& overrides,
                       std::uint64_t seed, const Registries& registries,
                       const Judge& judge = NothingKnown) {
  SweepTrial trial = MakeTrial(FindScenario(scenario), overrides, registries);
  trial.seed = seed;
  return Flown(trial, trial.Replay(), judge);
}

// The words of a command line as a shell reads them. Empty if it has more than words.
std::vector<std::string> Words(const std::string& command) {
  wordexp_t expanded;
  std::vector<std::string> words;
  if (wordexp(command.c_str(), &expanded, WRDE_NOCMD | WRDE_UNDEF) != 0) return words;
  words.assign(expanded.we_wordv, expanded.we_wordv + expanded.we_wordc);
  wordfree(&expanded);
  return words;
}

struct FlownTrial {
  int trial = 0;
  std::uint64_t seed = 0;
  std::string replay;
  std::string outcome;
  double simulated_s = 0.0;

  /// With the file's own scenario it has to come to the same again.
  Judge Again() const {
    return [this_trial = *this](const TrialResult& result) -> std::string {
      if (ToString(result.outcome) == this_trial.outcome &&
          result.simulated_s == this_trial.simulated_s)
        return "";
      return fmt::format(
          "trial {} was {} after {:.2f} s and is {} after {:.2f} s now: another build, or its "
          "files have "
          "changed",
          this_trial.trial, this_trial.outcome, this_trial.simulated_s, ToString(result.outcome),
          result.simulated_s);
    };
  }
};

std::vector<FlownTrial> FlownTrials(SqliteDb& db) {
  std::vector<FlownTrial> trials;
  SqliteStatement rows = db.Prepare(
      "SELECT planned.trial, planned.seed, replay, outcome, simulated_s FROM planned "
      "JOIN trial USING(trial) ORDER BY 1");
  while (rows.Step()) {
    const std::optional<Outcome> outcome = OutcomeNamed(rows.Text(3));
    if (outcome && IsLost(*outcome)) continue;
    trials.push_back({static_cast<int>(rows.Integer(0)),
                      static_cast<std::uint64_t>(rows.Integer(1)), rows.Text(2), rows.Text(3),
                      rows.Real(4)});
  }
  return trials;
}

// "touchdown land SCENARIO --set A=B ... --seed N", as MakeTrial writes it.
SourceFlight Again(const FlownTrial& trial, const std::vector<std::string>& overrides,
                   const std::string& path, const Registries& registries) {
  const std::vector<std::string> words = Words(trial.replay);
  if (words.size() < 3 || (words[1] != "land" && words[1] != "fly")) {
    throw BadInput(fmt::format("{}: trial {} cannot be flown again from `{}`.", path, trial.trial,
                               trial.replay));
  }
  std::vector<std::string> set;
  for (std::size_t i = 3; i + 1 < words.size(); ++i) {
    if (words[i] == "--set") set.push_back(words[++i]);
  }
  set.insert(set.end(), overrides.begin(), overrides.end());
  return LandingOf(words[2], set, trial.seed, registries,
                   overrides.empty() ? trial.Again() : NothingKnown);
}

// The options of the study whose file has this manifest. @throws BadInput
HostileOptions HostileOptionsOf(const Manifest& manifest, const std::string& path,
                                const std::vector<std::string>& overrides) {
  HostileOptions options;
  try {
    options.seed = std::stoull(manifest.at("sweep_seed"));
    options.share_beyond = std::stod(manifest.at("share_beyond"));
    if (!manifest.at("families").empty()) options.families = Split(manifest.at("families"), ',');
    options.set = nlohmann::json::parse(manifest.at("set")).get<std::vector<std::string>>();
  } catch (const std::exception&) {
    throw BadInput(fmt::format("{}: its manifest does not say how its flights were drawn.", path));
  }
  options.set.insert(options.set.end(), overrides.begin(), overrides.end());
  return options;
}

FlightSource TrialsOf(SqliteDb& db, const std::string& path,
                      const std::vector<std::string>& overrides, const Registries& registries) {
  const Manifest manifest = ReadManifest(db, path);
  const std::vector<FlownTrial> trials = FlownTrials(db);
  const auto campaign = manifest.find("campaign");
  const bool hostile = campaign != manifest.end() && campaign->second == kHostile;
  const HostileOptions options =
      hostile ? HostileOptionsOf(manifest, path, overrides) : HostileOptions();
  return {static_cast<int>(trials.size()), [=](int index) {
            const FlownTrial& trial = trials[static_cast<std::size_t>(index)];
            const Judge judge = overrides.empty() ? trial.Again() : NothingKnown;
            return hostile ? HostileFlightOf(options, trial.trial, registries, judge)
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
    return std::string();
  };
  return {1, [=](int) {
            return SourceFlight{fmt::format("the replanning steps of {}", flight->path), ask_again};
          }};
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
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw BadInput(
        fmt::format("{}: there is no such file; flights are taken from a record, or from the file "
                    "of a sweep, of a study "
                    "(study.db in its folder) or of hostile worlds.",
                    path));
  }
  std::optional<FlightSource> trials;
  NamingFile(path, "file of flights", [&] {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    if (HasManifest(db)) trials = TrialsOf(db, path, overrides, registries);
  });
  if (trials) return *trials;
  return RecordOf(path, overrides, registries);
}

}  // namespace touchdown::evaluation
