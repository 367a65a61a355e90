// SPDX-License-Identifier: BSD-3-Clause
// A study's folder: the trials are a campaign's, beside them stands what the report needs to know.
#include "evaluation/campaign/study_run.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/base/progress.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/work_sharing.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/campaign_progress.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kFlights[] = "flights";
constexpr double kRecordLimit = 600.0;  // wall time of a flight [s]

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder + "/records", error);
  if (error) throw BadInput(fmt::format("--out {}: {}.", folder, error.message()));
}

std::string PlanPath(const std::string& folder) { return folder + "/study.json"; }

// How the trials that are there were flown.
Json FlightsBefore(const std::string& folder) {
  std::ifstream stream(PlanPath(folder));
  if (!stream) return Json::array();
  const Json before = Json::parse(stream, nullptr, false);
  return before.is_object() && before.contains(kFlights) ? before[kFlights] : Json::array();
}

void WritePlan(const StudyPlan& plan, const std::string& folder, const Json& flights) {
  const std::string path = PlanPath(folder);
  Json document = StudyJson(plan);
  document[kFlights] = flights;
  AtomicFile file(path);
  std::ofstream stream(file.working_path());
  stream << document.dump(2) << "\n";
  stream.close();
  if (!stream) throw BadInput(fmt::format("{}: it cannot be written.", path));
  file.Commit();
}

// Whether the file is a record of this trial, flown by the build of this hash.
bool IsRecordOf(const std::string& path, const SweepTrial& trial, const std::string& build_hash) {
  if (!fs::exists(path)) return false;
  try {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    SqliteStatement rows = db.Prepare("SELECT key, value FROM meta");
    Manifest meta;
    while (rows.Step()) meta[rows.Text(0)] = rows.Text(1);
    return meta["build_hash"] == build_hash && meta["seed"] == std::to_string(trial.seed) &&
           meta["scenario_yaml"] == DumpScenario(trial.scenario);
  } catch (const SqliteError&) {
    return false;
  }
}

struct RecordedTrial {
  const SweepTrial* trial;
  std::string path;
};

// Why there is no record; empty: there is one.
std::string Record(const RecordedTrial& flight, const Registries& registries) {
  try {
    TrialRecord record;
    const Scenario& scenario = flight.trial->scenario;
    const TrialResult result = RunTrial(scenario, flight.trial->seed, registries, &record);
    WriteRecord(flight.path, scenario, result, record);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

// Every trial can be flown again from its scenario and seed: so are those that are to be drawn.
void RecordFirstTrials(const StudyPlan& plan, const std::string& folder, int jobs,
                       const Registries& registries) {
  std::vector<RecordedTrial> together, alone;
  const std::string build_hash = BuildHash();
  for (const StudyPart& part : plan.parts) {
    const std::string path = fmt::format("{}/records/{}-{}.db", folder, plan.CellOf(part).name,
                                         plan.MethodOf(part).name);
    if (!plan.Records(part) || part.trials == 0) continue;
    const SweepTrial& first = plan.campaign.trials.at(static_cast<std::size_t>(part.first));
    if (IsRecordOf(path, first, build_hash)) continue;
    (first.FliesAlone() ? alone : together).push_back({&first, path});
  }
  Progress progress({.things = "recorded flights"});
  const int all = static_cast<int>(together.size() + alone.size());
  int done = 0;
  const auto record = [&](const std::vector<RecordedTrial>& flights, int at_a_time) {
    const auto fly = [&](int i) {
      return Record(flights[static_cast<std::size_t>(i)], registries);
    };
    const auto take = [&](const WorkerReply& reply) {
      // The study itself is complete: without this record only its picture is missing.
      const std::string& path = flights[static_cast<std::size_t>(reply.item)].path;
      if (reply.end == WorkerReply::End::kTimedOut) {
        spdlog::warn("{}: not recorded within {} s", path, kRecordLimit);
      } else if (!reply.text.empty()) {
        spdlog::warn("{}: not recorded: {}", path, reply.text);
      }
      progress(++done, all);
    };
    ShareAll(static_cast<int>(flights.size()), at_a_time, fly, kRecordLimit, take);
  };
  record(together, jobs);
  record(alone, 1);
}

}  // namespace

std::string StudyTablePath(const std::string& folder, const Shard& shard) {
  if (shard.of == 1) return folder + "/study.db";
  return fmt::format("{}/shard_{}_of_{}.db", folder, shard.number, shard.of);
}

CampaignResult FlyStudy(const StudyPlan& plan, const std::string& folder, CampaignOptions options,
                        const Registries& registries) {
  MakeFolder(folder);
  options.db = StudyTablePath(folder, options.shard);
  const bool whole = options.shard.of == 1;
  Json flights = Json::array();
  // The plan stands there from the first trial on, for reports of what is there by then. It is first told of
  // progress when the file of the trials is known to be this study's, and in one process of several.
  const auto progress = [&, begun = false,
                         tell = CampaignProgress()](const CampaignState& state) mutable {
    if (!std::exchange(begun, true) && whole) {
      if (state.resumed > 0) flights = FlightsBefore(folder);
      WritePlan(plan, folder, flights);
    }
    tell(state);
  };
  const auto begin = std::chrono::steady_clock::now();
  CampaignResult result = RunCampaign(plan.campaign, options, registries, progress);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (!result.reports || !whole) return result;
  if (const int flown = result.state.flown - result.state.resumed; flown > 0) {
    flights.push_back({{"trials", flown}, {"jobs", result.at_a_time}, {"wall_s", taken.count()}});
    WritePlan(plan, folder, flights);
  }
  if (result.state.flown == result.state.all) {
    RecordFirstTrials(plan, folder, options.jobs, registries);
  }
  return result;
}

}  // namespace touchdown::evaluation
