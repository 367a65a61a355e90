// SPDX-License-Identifier: BSD-3-Clause
// One row per replanning step and stage: every figure of the report can be made again from the file.
#include "touchdown/evaluation/atomic_file.h"
#include "touchdown/evaluation/build_info.h"
#include "touchdown/evaluation/profile_report.h"
#include "touchdown/evaluation/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

constexpr char kSchema[] = R"sql(
CREATE TABLE manifest(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE run(run INTEGER PRIMARY KEY, seed INTEGER, outcome TEXT, warm_up INTEGER);
CREATE TABLE replan(run INTEGER, replan INTEGER, t_now REAL, status TEXT, reason TEXT,
  from_odometry INTEGER, pairs INTEGER, solves INTEGER, rebinds INTEGER, iterations INTEGER,
  deadline_missed INTEGER, PRIMARY KEY(run, replan));
CREATE TABLE stage(run INTEGER, replan INTEGER, stage TEXT, wall_ms REAL, cpu_ms REAL,
  allocations INTEGER, PRIMARY KEY(run, replan, stage));
CREATE TABLE frame(run INTEGER, frame INTEGER, t REAL, stage TEXT, wall_ms REAL, cpu_ms REAL,
  allocations INTEGER, PRIMARY KEY(run, frame, stage));
)sql";

void WriteManifest(SqliteDb& db, const Profile& profile, const MachineState& machine) {
  SqliteStatement insert = db.Prepare("INSERT INTO manifest VALUES(?, ?)");
  insert.Run("format", "touchdown profile");
  insert.Run("version", "1");
  insert.Run("scenario", profile.scenario.name);
  insert.Run("scenario_yaml", DumpScenario(profile.scenario));
  insert.Run("record", profile.record);
  insert.Run("deadline_ms", std::to_string(profile.deadline_ms));
  insert.Run("pinned_cpu", machine.pinned ? std::to_string(*machine.pinned) : "none");
  insert.Run("load_before", std::to_string(machine.load_before));
  insert.Run("load_after", std::to_string(machine.load_after));
  for (const auto& [key, value] : BuildManifest()) insert.Run(key, value);
}

// Allocations are NULL where nobody counted.
std::optional<int> Allocations(const Profile& profile, const planning::StageTimes::Span& span) {
  if (!profile.allocations_counted) return std::nullopt;
  return static_cast<int>(span.allocations);
}

void WriteReplans(SqliteDb& db, const Profile& profile, int run,
                  const std::vector<ReplanSample>& samples) {
  SqliteStatement replan = db.Prepare("INSERT INTO replan VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement stage = db.Prepare("INSERT INTO stage VALUES(?, ?, ?, ?, ?, ?)");
  int step = 0;
  for (const ReplanSample& s : samples) {
    const planning::StageTimes::Span& total = s.times.total;
    replan.Run(run, step, s.t_now, planning::ToString(s.status), planning::ToString(s.reason),
               s.from_odometry, s.pairs, s.solves, s.rebinds, s.iterations,
               1e3 * total.wall > profile.deadline_ms);
    const auto write = [&](const planning::StageTimes::Span& span) {
      stage.Run(run, step, span.stage, 1e3 * span.wall, 1e3 * span.cpu, Allocations(profile, span));
    };
    for (const planning::StageTimes::Span* span : s.times.Stages()) write(*span);
    write(total);
    ++step;
  }
}

void WriteFrames(SqliteDb& db, const Profile& profile, int run,
                 const std::vector<FrameSample>& samples) {
  SqliteStatement insert = db.Prepare("INSERT INTO frame VALUES(?, ?, ?, ?, ?, ?, ?)");
  int frame = 0;
  for (const FrameSample& s : samples) {
    for (const planning::StageTimes::Span* span : {&s.times.sense, &s.times.map}) {
      insert.Run(run, frame, s.t, span->stage, 1e3 * span->wall, 1e3 * span->cpu,
                 Allocations(profile, *span));
    }
    ++frame;
  }
}

}  // namespace

void WriteProfileTable(const std::string& path, const Profile& profile,
                       const MachineState& machine) {
  AtomicFile file(path);
  {
    SqliteDb db(file.working_path(), SqliteDb::Mode::kCreate);
    db.Execute("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF");
    SqliteTransaction transaction(db);
    db.Execute(kSchema);
    WriteManifest(db, profile, machine);
    SqliteStatement insert = db.Prepare("INSERT INTO run VALUES(?, ?, ?, ?)");
    int id = 0;
    for (const ProfileRun& run : profile.runs) {
      insert.Run(id, static_cast<std::int64_t>(run.seed), run.outcome, run.warm_up);
      WriteReplans(db, profile, id, run.samples.replans);
      WriteFrames(db, profile, id, run.samples.frames);
      ++id;
    }
    transaction.Commit();
  }
  file.Commit();
}

}  // namespace touchdown::evaluation
