// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/recorded_trials.h"

#include <exception>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/base/html.h"
#include "evaluation/base/progress.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/work_sharing.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/page/replay_page.h"
#include "evaluation/record/record.h"
#include "evaluation/scenario/scenario_world.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr double kPageTime = 600.0;  // wall time in which a page is made of a record [s]

// Whether the file is a record of this trial, flown by the build of this hash, with the current outside files.
bool IsRecordOf(const std::string& path, const SweepTrial& trial, const std::string& build_hash) {
  if (!fs::exists(path)) return false;
  try {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    SqliteStatement rows = db.Prepare("SELECT key, value FROM meta");
    Manifest meta;
    while (rows.Step()) meta[rows.Text(0)] = rows.Text(1);
    const OutsideFiles outside = OutsideFilesOf(trial.scenario);
    return meta["build_hash"] == build_hash && meta["seed"] == std::to_string(trial.seed) &&
           meta["scenario_yaml"] == DumpScenario(trial.scenario) &&
           meta["pad_waypoints"] == outside.pad_waypoints &&
           meta["vehicle_hash"] == outside.vehicle_hash && meta["world_hash"] == outside.world_hash;
  } catch (const SqliteError&) {
    return false;
  }
}

std::string RecordPath(const RecordedTrial& flight) { return flight.path + ".db"; }
std::string PagePath(const RecordedTrial& flight) { return flight.path + ".html"; }

// The page is written after the record, so an existing page belongs to it.
bool IsThere(const RecordedTrial& flight, const std::string& build_hash) {
  return fs::exists(PagePath(flight)) && IsRecordOf(RecordPath(flight), *flight.trial, build_hash);
}

// Its existing files, also those of a stopped worker.
void Remove(const RecordedTrial& flight) {
  const fs::path path(flight.path);
  const std::string name = path.filename().string();
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".")) {
    const std::string other = entry.path().filename().string();
    if (other.starts_with(name + ".db") || other.starts_with(name + ".html"))
      fs::remove(entry.path());
  }
}

// The fault; empty: none.
std::string Record(const RecordedTrial& flight, const Registries& registries) {
  try {
    TrialRecord record;
    const Scenario& scenario = flight.trial->scenario;
    const TrialResult result = RunTrial(scenario, flight.trial->seed, registries, &record);
    WriteRecord(RecordPath(flight), scenario, result, record);
    WriteReplayPage(PagePath(flight), {{RecordPath(flight), RecordPath(flight)}}, registries, {});
    if (flight.flown != nullptr && flight.flown->outcome != result.outcome) {
      return fmt::format("it ended otherwise this time, by {}", ToString(result.outcome));
    }
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

std::vector<RecordedTrial> RecordTrials(const std::vector<RecordedTrial>& trials,
                                        const CampaignOptions& options,
                                        const Registries& registries) {
  std::vector<RecordedTrial> together, alone;
  const std::string build_hash = BuildHash();
  for (const RecordedTrial& flight : trials) {
    if (IsThere(flight, build_hash)) continue;
    Remove(flight);
    (flight.trial->FliesAlone() ? alone : together).push_back(flight);
  }
  Progress progress({.things = "recorded flights"});
  const int all = static_cast<int>(together.size() + alone.size());
  const double limit_s = options.trial_limit_s + kPageTime;
  int done = 0;
  const auto record = [&](const std::vector<RecordedTrial>& flights, int at_a_time) {
    const auto fly = [&](int i) {
      return Record(flights[static_cast<std::size_t>(i)], registries);
    };
    const auto take = [&](const WorkerReply& reply) {
      const RecordedTrial& flight = flights[static_cast<std::size_t>(reply.item)];
      if (reply.end == WorkerReply::End::kTimedOut) {
        spdlog::warn("{}: not recorded within {} s", flight.path, limit_s);
        Remove(flight);
      } else if (!reply.text.empty()) {
        spdlog::warn("{}: {}", flight.path, reply.text);
      }
      progress(++done, all);
    };
    ShareAll(static_cast<int>(flights.size()), at_a_time, fly, limit_s, take);
  };
  record(together, options.jobs);
  record(alone, 1);
  std::vector<RecordedTrial> there;
  for (const RecordedTrial& flight : trials) {
    if (IsThere(flight, build_hash)) there.push_back(flight);
  }
  return there;
}

Recorded RecordedNamed(const std::string& name) {
  if (name == "none") return Recorded::kNone;
  if (name == "failures") return Recorded::kFailures;
  if (name == "all") return Recorded::kAll;
  throw std::invalid_argument(fmt::format("{} must be one of none, failures, all", name));
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
                                       Recorded which, const CampaignOptions& options,
                                       const Registries& registries) {
  std::map<int, std::string> pages;
  if (which == Recorded::kNone) return pages;
  const fs::path folder = fs::path(page).replace_extension().concat("_flights");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(fmt::format("{}: {}.", folder.string(), error.message()));
  std::vector<RecordedTrial> trials;
  for (const SweepRow* row : ToRecord(rows, which)) {
    trials.push_back(
        {&row->trial, &row->result, (folder / std::to_string(row->trial.index)).string()});
  }
  for (const RecordedTrial& flight : RecordTrials(trials, options, registries)) {
    const std::string shown =
        fmt::format("{}/{}.html", folder.filename().string(), flight.trial->index);
    // Where a flight failed its page opens at that moment.
    pages[flight.trial->index] =
        Address(shown) + (flight.flown->succeeded()
                              ? std::string()
                              : fmt::format("#t={:.2f}&view=follow", flight.flown->simulated_s));
  }
  return pages;
}

}  // namespace touchdown::evaluation
