// SPDX-License-Identifier: BSD-3-Clause
// A study's folder: the trials are a campaign's, beside them stands what the report needs to know.
#include "touchdown/evaluation/study_run.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "touchdown/evaluation/atomic_file.h"
#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/campaign_progress.h"
#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/progress.h"
#include "touchdown/evaluation/record.h"
#include "touchdown/evaluation/work_sharing.h"

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

// The plan, with a line for this flight after those of the flights before it.
void WritePlan(const StudyPlan& plan, const std::string& folder, const Json& flight) {
  const std::string path = folder + "/study.json";
  Json flights = Json::array();
  if (std::ifstream stream(path); stream) {
    const Json before = Json::parse(stream, nullptr, false);
    if (before.is_object() && before.contains(kFlights)) flights = before[kFlights];
  }
  if (flight.at("trials") > 0) flights.push_back(flight);
  Json document = StudyJson(plan);
  document[kFlights] = flights;
  AtomicFile file(path);
  std::ofstream stream(file.working_path());
  stream << document.dump(2) << "\n";
  stream.close();
  if (!stream) throw BadInput(fmt::format("{}: it cannot be written.", path));
  file.Commit();
}

// Every trial can be flown again from its scenario and seed: so are those that are to be drawn.
void RecordFirstTrials(const StudyPlan& plan, const std::string& folder, int jobs,
                       const Registries& registries) {
  struct Flight {
    const SweepTrial* trial;
    std::string path;
  };
  std::vector<Flight> flights;
  for (const StudyPart& part : plan.parts) {
    const std::string path = fmt::format("{}/records/{}-{}.db", folder, plan.CellOf(part).name,
                                         plan.MethodOf(part).name);
    if (!plan.Records(part) || part.trials == 0 || fs::exists(path)) continue;
    flights.push_back({&plan.campaign.trials.at(static_cast<std::size_t>(part.first)), path});
  }
  // Why there is no record; empty: there is one.
  const auto fly = [&](int i) -> std::string {
    const Flight& flight = flights[static_cast<std::size_t>(i)];
    try {
      TrialRecord record;
      const Scenario& scenario = flight.trial->scenario;
      const TrialResult result = RunTrial(scenario, flight.trial->seed, registries, &record);
      WriteRecord(flight.path, scenario, result, record);
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  const int count = static_cast<int>(flights.size());
  Progress progress({.things = "recorded flights"});
  int done = 0;
  const auto take = [&](const WorkerReply& reply) {
    // The study itself is complete: without this record only its picture is missing.
    const Flight& flight = flights[static_cast<std::size_t>(reply.item)];
    if (reply.end == WorkerReply::End::kTimedOut) {
      spdlog::warn("{}: not recorded within {} s", flight.path, kRecordLimit);
    } else if (!reply.text.empty()) {
      spdlog::warn("{}: not recorded: {}", flight.path, reply.text);
    }
    progress(++done, count);
  };
  ShareAll(count, jobs, fly, kRecordLimit, take);
}

}  // namespace

std::string StudyTablePath(const std::string& folder, const Shard& shard) {
  if (shard.of == 1) return folder + "/study.db";
  return fmt::format("{}/shard_{}_of_{}.db", folder, shard.number, shard.of);
}

CampaignResult FlyStudy(const StudyPlan& plan, const std::string& folder, int jobs,
                        const Shard& shard, const Registries& registries) {
  MakeFolder(folder);
  CampaignOptions options;
  options.jobs = jobs;
  options.db = StudyTablePath(folder, shard);
  options.shard = shard;
  const auto begin = std::chrono::steady_clock::now();
  const CampaignResult result = RunCampaign(plan.campaign, options, registries, CampaignProgress());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (!result.reports || shard.of > 1) return result;
  const CampaignState& state = result.state;
  WritePlan(
      plan, folder,
      {{"trials", state.flown - state.resumed}, {"jobs", options.jobs}, {"wall_s", taken.count()}});
  if (state.flown == state.all) RecordFirstTrials(plan, folder, jobs, registries);
  return result;
}

}  // namespace touchdown::evaluation
