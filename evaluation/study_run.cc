// SPDX-License-Identifier: BSD-3-Clause
// A study's folder. The plan stands in it before the first flight, so that whoever comes back later can
// be told whether it is the same study.
#include "touchdown/evaluation/study_run.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "touchdown/evaluation/atomic_file.h"
#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/on_threads.h"
#include "touchdown/evaluation/progress.h"
#include "touchdown/evaluation/record.h"
#include "touchdown/evaluation/trial_table.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kFlights[] = "flights";

std::string PlanPath(const std::string& folder) { return folder + "/study.json"; }

void WriteJson(const std::string& path, const Json& document) {
  AtomicFile file(path);
  std::ofstream stream(file.working_path());
  stream << document.dump(2) << "\n";
  stream.close();
  if (!stream) throw BadInput(fmt::format("{}: it cannot be written.", path));
  file.Commit();
}

// The study that the folder holds, with what was flown of it, or `plan` if there is none yet.
Json OpenFolder(const std::string& folder, const Json& plan) {
  std::error_code error;
  fs::create_directories(folder + "/records", error);
  if (error) throw BadInput(fmt::format("--out {}: {}.", folder, error.message()));
  std::ifstream stream(PlanPath(folder));
  if (!stream) {
    Json document = plan;
    document[kFlights] = Json::array();
    WriteJson(PlanPath(folder), document);
    return document;
  }
  Json found = Json::parse(stream, nullptr, false);
  Json compared = found;
  if (compared.is_object()) compared.erase(kFlights);
  if (compared != plan) {
    throw BadInput(fmt::format(
        "--out {}: the folder holds another study, or another form of this one.", folder));
  }
  return found;
}

// Trials whose plans take as long as the clock says would slow each other.
std::vector<SweepRow> Fly(const std::vector<SweepTrial>& trials, int jobs,
                          const Registries& registries) {
  std::vector<SweepTrial> together;
  std::vector<SweepTrial> alone;
  for (const SweepTrial& trial : trials) {
    (trial.scenario.planning.latency.measured ? alone : together).push_back(trial);
  }
  std::vector<SweepRow> rows =
      RunSweep(together, jobs, registries, Progress({.things = "trials", .with_rate = true}));
  std::vector<SweepRow> more =
      RunSweep(alone, 1, registries,
               Progress({.things = "trials", .of = "measured latency", .with_rate = true}));
  std::move(more.begin(), more.end(), std::back_inserter(rows));
  std::sort(rows.begin(), rows.end(), [](const SweepRow& one, const SweepRow& other) {
    return one.trial.index < other.trial.index;
  });
  return rows;
}

// Every trial can be flown again from its scenario and seed: so are those that are to be drawn.
void RecordFirstTrials(const StudyPlan& plan, const std::string& folder, int jobs,
                       const Registries& registries) {
  struct Flight {
    const StudyPart* part;
    std::string path;
  };
  std::vector<Flight> flights;
  for (const StudyPart& part : plan.parts) {
    const StudyMethod& method = plan.file.methods[static_cast<std::size_t>(part.method)];
    const StudyCell& cell = plan.file.cells[static_cast<std::size_t>(part.cell)];
    const std::string path = fmt::format("{}/records/{}-{}.db", folder, cell.name, method.name);
    if (method.record && part.refusal.empty() && !fs::exists(path))
      flights.push_back({&part, path});
  }
  const std::uint64_t seed = TrialSeed(plan.seed, 0);
  RunOnThreads(
      static_cast<int>(flights.size()), jobs,
      [&](int i) {
        const Flight& flight = flights[static_cast<std::size_t>(i)];
        TrialRecord record;
        const TrialResult result = RunTrial(flight.part->scenario, seed, registries, &record);
        WriteRecord(flight.path, flight.part->scenario, result, record);
      },
      Progress({.things = "recorded flights"}));
}

}  // namespace

std::string StudyTablePath(const std::string& folder) { return folder + "/study.db"; }

void FlyStudy(const StudyPlan& plan, const std::string& folder, int jobs,
              const Registries& registries) {
  Json document = OpenFolder(folder, StudyJson(plan));
  if (!fs::exists(StudyTablePath(folder))) {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<SweepRow> rows = Fly(plan.trials, jobs, registries);
    SweepOptions options;
    options.trials = static_cast<int>(plan.trials.size());
    options.jobs = jobs;
    options.seed = plan.seed;
    WriteTrialTable(StudyTablePath(folder), options, rows);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    document[kFlights].push_back(
        {{"trials", rows.size()}, {"jobs", jobs}, {"wall_s", taken.count()}});
    WriteJson(PlanPath(folder), document);
  }
  RecordFirstTrials(plan, folder, jobs, registries);
}

}  // namespace touchdown::evaluation
