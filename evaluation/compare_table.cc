// SPDX-License-Identifier: BSD-3-Clause
// One row per solve, repeats included: every figure of the report can be drawn again from the file.
// Infinite times of failures are NULL.
#include "touchdown/evaluation/compare_table.h"

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/compare_report.h"
#include "touchdown/evaluation/compare_summary.h"
#include "touchdown/evaluation/result_file.h"
#include "touchdown/evaluation/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kFormat{"touchdown comparison", 2};

constexpr char kSchema[] = R"sql(
CREATE TABLE problem(points INTEGER, problem INTEGER, draws INTEGER, not_clear INTEGER,
  unsolved INTEGER, rounds INTEGER, clear INTEGER, pairs INTEGER, duration_s REAL, start_speed_mps REAL, pad_speed_mps REAL, pad_rate_radps REAL,
  distance_m REAL, reference_cost REAL, reference_backend TEXT,
  reference_solves INTEGER, PRIMARY KEY(points, problem));
CREATE TABLE solve(points INTEGER, problem INTEGER, backend TEXT, phase TEXT, repeat INTEGER,
  status TEXT, reached INTEGER, time_cpu_ms REAL, time_wall_ms REAL, iterations INTEGER,
  evaluations INTEGER, cost REAL, gap REAL, end_position_m REAL, end_velocity_mps REAL,
  max_violation REAL, best_returned INTEGER, evaluation_ms REAL, whitening_ms REAL,
  native_ms REAL, adapter_ms REAL, PRIMARY KEY(points, problem, backend, phase, repeat));
CREATE TABLE refusal(points INTEGER, backend TEXT, reason TEXT);
CREATE TABLE summary(points INTEGER, backend TEXT, problems INTEGER, solved INTEGER,
  solved_lo REAL, solved_hi REAL, cpu_median_ms REAL, cpu_p95_ms REAL, cpu_p99_ms REAL,
  cpu_max_ms REAL, iterations_median REAL, evaluations_median REAL, reported_success INTEGER,
  agreeing INTEGER, tight_gap_median REAL, tight_gap_p95 REAL, end_position_max_m REAL,
  end_velocity_max_mps REAL, max_violation REAL, ms_per_iteration REAL,
  PRIMARY KEY(points, backend));
)sql";

ManifestFacts Facts(const CompareOptions& options, const MachineState& machine) {
  ManifestFacts facts;
  facts.emplace_back("problems", std::to_string(options.problems));
  const nlohmann::ordered_json settings = CompareSettings(options);
  for (const auto& [key, value] : settings.items()) facts.emplace_back(key, value.dump());
  AddMachine(machine, &facts);
  return facts;
}

void WriteProblems(SqliteDb& db, const CompareResult& result) {
  SqliteStatement insert =
      db.Prepare("INSERT INTO problem VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const ProblemRow& row : result.problems) {
    const LandingCase& made = row.made;
    const double distance = (made.pad->At(made.t0).p_WP - made.start.p).head<2>().norm();
    insert.Run(row.points, made.index, made.draws, made.not_clear, made.unsolved, made.rounds,
               made.clear, static_cast<int>(made.pairs.size()), made.duration, made.start.v.norm(),
               made.pad_speed, made.pad_rate, distance, row.reference_cost, row.reference_backend,
               row.reference_solves);
  }
}

void WriteSolves(SqliteDb& db, const CompareResult& result) {
  SqliteStatement insert = db.Prepare(
      "INSERT INTO solve VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const SolveRow& row : result.solves) {
    insert.Run(row.points, row.problem, row.backend, ToString(row.phase), row.repeat,
               ToString(row.status), row.reached, row.cpu_ms, row.wall_ms, row.iterations,
               row.evaluations, row.cost, row.gap, row.end_position_m, row.end_velocity_mps,
               row.max_violation, row.best_returned, 1e3 * row.shares.evaluation_s,
               1e3 * row.shares.whitening_s, 1e3 * row.shares.native_s, 1e3 * row.shares.adapter_s);
  }
}

void WriteSummary(SqliteDb& db, const CompareOptions& options, const CompareResult& result) {
  SqliteStatement insert = db.Prepare(
      "INSERT INTO summary VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const int points : options.points) {
    for (const BackendSummary& s : Summarise(result, points)) {
      insert.Run(points, s.backend, s.problems, s.solved, s.solved_interval.lo,
                 s.solved_interval.hi, s.cpu_ms.median, s.cpu_ms.p95, s.cpu_ms.p99, s.cpu_ms.max,
                 s.iterations.median, s.evaluations.median, s.reported_success, s.agreeing,
                 s.tight_gap.median, s.tight_gap.p95, s.end_position_max, s.end_velocity_max,
                 s.violation_max, s.ms_per_iteration);
    }
  }
}

}  // namespace

void WriteCompareTable(const std::string& path, const CompareOptions& options,
                       const CompareResult& result, const MachineState& machine) {
  WriteResultFile(path, kFormat, kSchema, Facts(options, machine), [&](SqliteDb& db) {
    WriteProblems(db, result);
    WriteSolves(db, result);
    SqliteStatement refusal = db.Prepare("INSERT INTO refusal VALUES(?, ?, ?)");
    for (const Refusal& row : result.refusals) refusal.Run(row.points, row.backend, row.reason);
    WriteSummary(db, options, result);
  });
}

}  // namespace touchdown::evaluation
