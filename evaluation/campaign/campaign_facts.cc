// SPDX-License-Identifier: BSD-3-Clause
// Two hashes decide whether trials belong together: that of the plan and that of the build. All other facts of a
// manifest only serve to describe differences in words.
#include "evaluation/campaign/campaign_facts.h"

#include <algorithm>
#include <initializer_list>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/campaign/trial_columns.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

// The part of a scenario that results depend on, as YAML. A file may be continued under another description.
std::string WhatCounts(Scenario scenario) {
  scenario.description.clear();
  return DumpScenario(scenario);
}

// A hash of the scenario and of the files that it names. Most trials of a campaign share both.
class ScenarioHashes {
 public:
  const std::string& Of(const Scenario& scenario) {
    const std::string text = WhatCounts(scenario);
    const auto [at, fresh] = scenarios_.try_emplace(text);
    if (!fresh) return at->second;
    const OutsideFiles outside = OutsideFilesOf(scenario);
    std::string all = text + '\0' + outside.pad_waypoints + '\0' + outside.vehicle_hash;
    if (outside.world_hash != "none") all += '\0' + outside.world_hash;
    if (scenario.map_prior != "none") all += '\0' + OfMap(scenario.map_prior);
    return at->second = HashOf(all);
  }

 private:
  const std::string& OfMap(const std::string& path) {
    const auto [at, fresh] = maps_.try_emplace(path);
    if (fresh) at->second = HashOf(sim::ReadInputFile(path, sim::kMostInputBytes));
    return at->second;
  }
  std::map<std::string, std::string> scenarios_;
  std::map<std::string, std::string> maps_;
};

std::string HashOfPlan(const Campaign& campaign) {
  std::string text;
  ScenarioHashes hashes;
  for (const SweepTrial& trial : campaign.trials) {
    text += fmt::format("{} {} ", trial.seed, hashes.Of(trial.scenario));
    for (const auto& [key, value] : trial.varied) {
      text.append(key).append(1, '\0').append(value).append(1, '\0');
    }
  }
  return HashOf(text);
}

// Of two texts the first lines that differ.
std::string OtherLine(const std::string& there, const std::string& here) {
  std::istringstream those(there), these(here);
  const auto next = [](std::istringstream& lines) {
    std::string line;
    if (!std::getline(lines, line)) return std::string("nothing");
    return line.substr(std::min(line.size(), line.find_first_not_of(' ')));
  };
  for (;;) {
    const std::string that = next(those), line = next(these);
    if (that != line)
      return fmt::format("its scenario says \"{}\" where this one says \"{}\"", that, line);
  }
}

// The first of `keys` which the two say differently, in words; empty: none.
std::string FirstOther(const Manifest& there, const Manifest& here,
                       std::initializer_list<const char*> keys) {
  constexpr std::size_t kLong = 80;
  for (const std::string key : keys) {
    const std::string that = Fact(there, key), mine = Fact(here, key);
    if (that == mine) continue;
    if (key == "scenario_yaml") return OtherLine(that, mine);
    if (that.size() > kLong || mine.size() > kLong)
      return fmt::format("its {} is another one", key);
    return fmt::format("its {} is {}, not {}", key, that, mine);
  }
  return {};
}

// Trials 0 to n - 1, each in a cell of the plan, or a shard of them.
bool IsWhole(SqliteDb& db, const Manifest& manifest) {
  SqliteStatement plan = db.Prepare(
      "SELECT count(*), min(trial), max(trial) FROM planned "
      "WHERE cell IN (SELECT cell FROM cell)");
  plan.Step();
  const std::int64_t trials = plan.Integer(0);
  if (std::to_string(trials) != Fact(manifest, "trials")) return false;
  if (Fact(manifest, "shard").empty()) return false;
  return trials == 0 || (plan.Integer(1) == 0 && plan.Integer(2) == trials - 1);
}

// With their columns, in SQL. Statistics that SQLite keeps do not count.
std::set<std::string> TablesOf(SqliteDb& db) {
  std::set<std::string> tables;
  SqliteStatement rows =
      db.Prepare("SELECT sql FROM sqlite_master WHERE sql NOT NULL AND name NOT GLOB 'sqlite_*'");
  while (rows.Step()) tables.insert(rows.Text(0));
  return tables;
}

}  // namespace

std::string Fact(const Manifest& manifest, const std::string& key) {
  const auto at = manifest.find(key);
  return at == manifest.end() ? "" : at->second;
}

ManifestFacts FactsOf(const Campaign& campaign, const Shard& shard) {
  ManifestFacts facts = {{"campaign", campaign.name},
                         {"sweep_seed", std::to_string(campaign.seed)},
                         {"trials", std::to_string(campaign.trials.size())},
                         {"shard", shard.ToString()}};
  facts.insert(facts.end(), campaign.facts.begin(), campaign.facts.end());
  if (!campaign.trials.empty()) {
    const Scenario& first = campaign.trials.front().scenario;
    facts.emplace_back("scenario", first.name);
    facts.emplace_back("scenario_yaml", WhatCounts(first));
  }
  facts.emplace_back("plan_hash", HashOfPlan(campaign));
  return facts;
}

std::string CampaignHash(const Campaign& campaign) { return HashOfPlan(campaign) + BuildHash(); }

Manifest ReadManifest(SqliteDb& db, const std::string& path) {
  Manifest manifest;
  try {
    SqliteStatement facts = db.Prepare("SELECT key, value FROM manifest");
    while (facts.Step()) manifest.emplace(facts.Text(0), facts.Text(1));
  } catch (const SqliteError&) {
    manifest.clear();
  }
  if (Fact(manifest, "format") != kTrialFormat.name) {
    throw BadInput(fmt::format("{}: it is no file of trials.", path));
  }
  if (Fact(manifest, "version") != std::to_string(kTrialFormat.version)) {
    throw BadInput(fmt::format("{}: its format has version {}, and this program writes version {}.",
                               path, Fact(manifest, "version"), kTrialFormat.version));
  }
  SqliteDb like(":memory:", SqliteDb::Mode::kCreate);
  FillResultFile(like, kTrialFormat, TrialSchema().c_str(), {}, [](SqliteDb&) {});
  if (TablesOf(db) != TablesOf(like)) {
    throw BadInput(fmt::format("{}: its tables are not those of a file of trials.", path));
  }
  if (!IsWhole(db, manifest)) {
    throw BadInput(
        fmt::format("{}: its plan is not that of {} trials.", path, Fact(manifest, "trials")));
  }
  return manifest;
}

std::string Difference(const Manifest& there, const Manifest& here) {
  std::string words = FirstOther(there, here, {"campaign", "sweep_seed", "trials"});
  if (words.empty() && Fact(there, "plan_hash") != Fact(here, "plan_hash")) {
    words = FirstOther(there, here, {"scenario", "vary", "set", "scenario_yaml"});
    if (words.empty()) words = "its trials are others, or a file that they name has changed";
  }
  if (words.empty() && Fact(there, "build_hash") != Fact(here, "build_hash")) {
    words = FirstOther(there, here,
                       {"touchdown_version", "revision", "build_type", "compiler", "compiler_flags",
                        "instruction_set", "eigen", "ceres", "nlopt", "ipopt", "mujoco", "sqlite",
                        "cpu", "cpu_flags"});
    if (words.empty()) words = "another build of the program wrote it";
  }
  return words;
}

}  // namespace touchdown::evaluation
