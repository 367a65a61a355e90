// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/recorded_trials.h"

#include <exception>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/base/progress.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/work_sharing.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/page/replay_page.h"
#include "evaluation/record/record.h"

namespace touchdown::evaluation {
namespace {

constexpr double kRecordLimit = 600.0;  // wall time of a flight [s]

// Whether the file is a record of this trial, flown by the build of this hash.
bool IsRecordOf(const std::string& path, const SweepTrial& trial, const std::string& build_hash) {
  if (!std::filesystem::exists(path)) return false;
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

// Why there is no record, or no page; empty: they are there.
std::string Record(const RecordedTrial& flight, const Registries& registries) {
  try {
    TrialRecord record;
    const std::string db = flight.path + ".db";
    const Scenario& scenario = flight.trial->scenario;
    const TrialResult result = RunTrial(scenario, flight.trial->seed, registries, &record);
    WriteRecord(db, scenario, result, record);
    WriteReplayPage(flight.path + ".html", {{db, db}}, registries, {});
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

void RecordTrials(const std::vector<RecordedTrial>& trials, int jobs,
                  const Registries& registries) {
  std::vector<RecordedTrial> together, alone;
  const std::string build_hash = BuildHash();
  for (const RecordedTrial& flight : trials) {
    if (IsRecordOf(flight.path + ".db", *flight.trial, build_hash) &&
        std::filesystem::exists(flight.path + ".html")) {
      continue;
    }
    (flight.trial->FliesAlone() ? alone : together).push_back(flight);
  }
  Progress progress({.things = "recorded flights"});
  const int all = static_cast<int>(together.size() + alone.size());
  int done = 0;
  const auto record = [&](const std::vector<RecordedTrial>& flights, int at_a_time) {
    const auto fly = [&](int i) {
      return Record(flights[static_cast<std::size_t>(i)], registries);
    };
    const auto take = [&](const WorkerReply& reply) {
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

Recorded RecordedNamed(const std::string& name) {
  if (name == "none") return Recorded::kNone;
  if (name == "failures") return Recorded::kFailures;
  if (name == "all") return Recorded::kAll;
  throw std::invalid_argument(fmt::format("{} is none of none, failures, all", name));
}

std::vector<const SweepRow*> ToRecord(const std::vector<SweepRow>& rows, Recorded which) {
  std::vector<const SweepRow*> chosen;
  if (which == Recorded::kNone) return chosen;
  for (const SweepRow& row : rows) {
    const bool wanted = which == Recorded::kAll || !row.result.succeeded();
    if (wanted && !IsLost(row.result.outcome)) chosen.push_back(&row);
  }
  return chosen;
}

std::map<int, std::string> RecordFlown(const std::string& page, const std::vector<SweepRow>& rows,
                                       Recorded which, int jobs, const Registries& registries) {
  namespace fs = std::filesystem;
  std::map<int, std::string> pages;
  if (which == Recorded::kNone) return pages;
  const fs::path folder = fs::path(page).replace_extension().concat("_flights");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(fmt::format("{}: {}.", folder.string(), error.message()));
  std::vector<RecordedTrial> trials;
  for (const SweepRow* row : ToRecord(rows, which)) {
    trials.push_back({&row->trial, (folder / std::to_string(row->trial.index)).string()});
  }
  RecordTrials(trials, jobs, registries);
  for (const SweepRow* row : ToRecord(rows, which)) {
    const fs::path shown = folder / fmt::format("{}.html", row->trial.index);
    if (!fs::exists(shown)) continue;
    // Where a flight failed its page opens at that moment.
    pages[row->trial.index] = fmt::format(
        "{}/{}{}", folder.filename().string(), shown.filename().string(),
        row->result.succeeded() ? "" : fmt::format("#t={:.2f}", row->result.simulated_s));
  }
  return pages;
}

}  // namespace touchdown::evaluation
