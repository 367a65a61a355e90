// SPDX-License-Identifier: BSD-3-Clause
// A study's folder: the trials of a campaign, and the data for the report.
#include "evaluation/campaign/study_run.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/campaign_progress.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kFlights[] = "flights";
constexpr std::size_t kMostPlanBytes = 4 << 20;

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder + "/records", error);
  if (error) throw BadInput(fmt::format("--out {}: {}.", folder, error.message()));
}

std::string PlanPath(const std::string& folder) { return folder + "/study.json"; }

// How the trials that are there were flown.
Json FlightsBefore(const std::string& folder) {
  std::error_code unknown;
  if (!fs::exists(PlanPath(folder), unknown)) return Json::array();
  const Json before = ReadStudyPlan(folder);
  return before.contains(kFlights) ? before[kFlights] : Json::array();
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

// The first trial of each part that is recorded, and other requested trials.
void Record(const StudyPlan& plan, const std::string& folder, const std::vector<SweepRow>& rows,
            Recorded which, const CampaignOptions& options, const Registries& registries) {
  std::vector<RecordedTrial> trials;
  std::set<int> firsts;
  for (const StudyPart& part : plan.parts) {
    if (!plan.Records(part) || part.trials == 0) continue;
    firsts.insert(part.first);
    trials.push_back({&plan.campaign.trials.at(static_cast<std::size_t>(part.first)), nullptr,
                      fmt::format("{}/records/{}-{}", folder, plan.CellOf(part).name,
                                  plan.MethodOf(part).name)});
  }
  for (const SweepRow* row : ToRecord(rows, which)) {
    if (firsts.contains(row->trial.index)) continue;
    trials.push_back(
        {&row->trial, &row->result, fmt::format("{}/records/trial_{}", folder, row->trial.index)});
  }
  RecordTrials(trials, options, registries);
}

}  // namespace

Json ReadStudyPlan(const std::string& folder) {
  const std::string path = PlanPath(folder);
  try {
    Json plan = Json::parse(sim::ReadInputFile(path, kMostPlanBytes), nullptr, false);
    if (!plan.is_object() || !plan.contains("parts")) {
      sim::RefuseFile(path, "it is not a study's plan");
    }
    return plan;
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}.", error.what()));
  }
}

std::string StudyTablePath(const std::string& folder, const Shard& shard) {
  if (shard.of == 1) return folder + "/study.db";
  return fmt::format("{}/shard_{}_of_{}.db", folder, shard.number, shard.of);
}

CampaignResult FlyStudy(const StudyPlan& plan, const std::string& folder, CampaignOptions options,
                        Recorded which, const Registries& registries) {
  MakeFolder(folder);
  options.db = StudyTablePath(folder, options.shard);
  const bool whole = options.shard.of == 1;
  Json flights = Json::array();
  // The plan is there from the first trial on, for reports of an unfinished study. It first gets progress when the file
  // of the trials is known to be this study's, and in only one process.
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
    Record(plan, folder, result.rows, which, options, registries);
  }
  return result;
}

}  // namespace touchdown::evaluation
