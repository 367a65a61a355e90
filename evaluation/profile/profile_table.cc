// SPDX-License-Identifier: BSD-3-Clause
// One row per replanning step and stage: every figure of the report can be made again from the file.
#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/profile/profile_report.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kFormat{"touchdown profile", 2};

constexpr char kSchema[] = R"sql(
CREATE TABLE run(run INTEGER PRIMARY KEY, seed INTEGER, outcome TEXT, warm_up INTEGER);
CREATE TABLE replan(run INTEGER, replan INTEGER, t_now REAL, status TEXT, reason TEXT,
  from_odometry INTEGER, pairs INTEGER, solves INTEGER, rebinds INTEGER, iterations INTEGER, work INTEGER,
  deadline_missed INTEGER, PRIMARY KEY(run, replan));
CREATE TABLE stage(run INTEGER, replan INTEGER, stage TEXT, wall_ms REAL, cpu_ms REAL,
  allocations INTEGER, PRIMARY KEY(run, replan, stage));
CREATE TABLE frame(run INTEGER, frame INTEGER, t REAL, stage TEXT, wall_ms REAL, cpu_ms REAL,
  allocations INTEGER, PRIMARY KEY(run, frame, stage));
)sql";

ManifestFacts Facts(const Profile& profile, const MachineState& machine) {
  ManifestFacts facts;
  facts.emplace_back("scenario", profile.scenario.name);
  facts.emplace_back("scenario_yaml", DumpScenario(profile.scenario));
  facts.emplace_back("record", profile.record);
  facts.emplace_back("deadline_ms", std::to_string(profile.deadline_ms));
  AddMachine(machine, &facts);
  return facts;
}

// Allocations are NULL where they were not counted.
std::optional<int> Allocations(const Profile& profile, const planning::StageTimes::Span& span) {
  if (!profile.allocations_counted) return std::nullopt;
  return static_cast<int>(span.allocations);
}

void WriteReplans(SqliteDb& db, const Profile& profile, int run,
                  const std::vector<ReplanSample>& samples) {
  SqliteStatement replan =
      db.Prepare("INSERT INTO replan VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement stage = db.Prepare("INSERT INTO stage VALUES(?, ?, ?, ?, ?, ?)");
  int step = 0;
  for (const ReplanSample& s : samples) {
    const planning::StageTimes::Span& total = s.times.total;
    replan.Run(run, step, s.t_now, planning::ToString(s.status), planning::ToString(s.reason),
               s.from_odometry, s.pairs, s.solves, s.rebinds, s.iterations, s.work,
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
  WriteResultFile(path, kFormat, kSchema, Facts(profile, machine), [&](SqliteDb& db) {
    SqliteStatement insert = db.Prepare("INSERT INTO run VALUES(?, ?, ?, ?)");
    int id = 0;
    for (const ProfileRun& run : profile.runs) {
      insert.Run(id, static_cast<std::int64_t>(run.seed), run.outcome, run.warm_up);
      WriteReplans(db, profile, id, run.samples.replans);
      WriteFrames(db, profile, id, run.samples.frames);
      ++id;
    }
  });
}

}  // namespace touchdown::evaluation
