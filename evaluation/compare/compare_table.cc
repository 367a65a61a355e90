// SPDX-License-Identifier: BSD-3-Clause
// One row per solve, repeats included: every figure of the report can be drawn again from the file.
// Infinite times of failures are NULL.
#include "evaluation/compare/compare_table.h"

#include <nlohmann/json.hpp>

#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/compare/compare_report.h"
#include "evaluation/compare/compare_summary.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kFormat{"touchdown comparison", 3};

constexpr char kSchema[] = R"sql(
CREATE TABLE flight(flight INTEGER PRIMARY KEY, command TEXT);
CREATE TABLE problem(problem INTEGER PRIMARY KEY, flight INTEGER, solve INTEGER, points INTEGER,
  free_arrival INTEGER, hard_limits INTEGER, explicit_endpoint INTEGER, pairs INTEGER,
  duration_s REAL, start_gap REAL, standing INTEGER, reference_cost REAL, reference_backend TEXT,
  reference_solves INTEGER);
CREATE TABLE solve(problem INTEGER, backend TEXT, phase TEXT, repeat INTEGER,
  status TEXT, reached INTEGER, time_cpu_ms REAL, time_wall_ms REAL, iterations INTEGER,
  evaluations INTEGER, cost REAL, gap REAL, max_violation REAL, best_returned INTEGER,
  evaluation_ms REAL, whitening_ms REAL, native_ms REAL, adapter_ms REAL,
  PRIMARY KEY(problem, backend, phase, repeat));
CREATE TABLE refusal(backend TEXT, reason TEXT);
CREATE TABLE summary(backend TEXT PRIMARY KEY, problems INTEGER, solved INTEGER,
  ran_all INTEGER, solved_lo REAL, solved_hi REAL, cpu_median_ms REAL, cpu_p95_ms REAL, cpu_p99_ms REAL,
  cpu_max_ms REAL, iterations_median REAL, evaluations_median REAL, reported_success INTEGER,
  agreeing INTEGER, tight_gap_median REAL, tight_gap_p95 REAL, max_violation REAL,
  ms_per_iteration REAL);
)sql";

ManifestFacts Facts(const CompareOptions& options, const CompareResult& result,
                    const MachineState& machine) {
  ManifestFacts facts;
  facts.emplace_back("problems", std::to_string(result.problems.size()));
  const nlohmann::ordered_json settings = CompareSettings(options);
  for (const auto& [key, value] : settings.items()) facts.emplace_back(key, value.dump());
  facts.emplace_back("every", std::to_string(result.every));
  facts.emplace_back("solves_asked", std::to_string(result.asked));
  AddMachine(machine, &facts);
  return facts;
}

void WriteProblems(SqliteDb& db, const CompareResult& result) {
  SqliteStatement flight = db.Prepare("INSERT INTO flight VALUES(?, ?)");
  int number = 0;
  for (const std::string& command : result.flights) flight.Run(number++, command);
  SqliteStatement insert =
      db.Prepare("INSERT INTO problem VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  number = 0;
  for (const ProblemRow& row : result.problems) {
    insert.Run(number++, row.flight, row.solve, row.points, row.free_arrival, row.hard_limits,
               row.explicit_endpoint, row.pairs, row.duration_s, row.start_gap, row.standing,
               row.reference_cost, row.reference_backend, row.reference_solves);
  }
}

void WriteSolves(SqliteDb& db, const CompareResult& result) {
  SqliteStatement insert =
      db.Prepare("INSERT INTO solve VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const SolveRow& row : result.solves) {
    insert.Run(row.problem, row.backend, ToString(row.phase), row.repeat, ToString(row.status),
               row.reached, row.cpu_ms, row.wall_ms, row.iterations, row.evaluations, row.cost,
               row.gap, row.max_violation, row.best_returned, 1e3 * row.shares.evaluation_s,
               1e3 * row.shares.whitening_s, 1e3 * row.shares.native_s, 1e3 * row.shares.adapter_s);
  }
}

void WriteSummary(SqliteDb& db, const CompareResult& result) {
  SqliteStatement insert = db.Prepare(
      "INSERT INTO summary VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const BackendSummary& s : Summarise(result)) {
    insert.Run(s.backend, s.problems, s.solved, s.ran_all, s.solved_interval.lo,
               s.solved_interval.hi, s.cpu_ms.median, s.cpu_ms.p95, s.cpu_ms.p99, s.cpu_ms.max,
               s.iterations.median, s.evaluations.median, s.reported_success, s.agreeing,
               s.tight_gap.median, s.tight_gap.p95, s.violation_max, s.ms_per_iteration);
  }
}

}  // namespace

void WriteCompareTable(const std::string& path, const CompareOptions& options,
                       const CompareResult& result, const MachineState& machine) {
  WriteResultFile(path, kFormat, kSchema, Facts(options, result, machine), [&](SqliteDb& db) {
    WriteProblems(db, result);
    WriteSolves(db, result);
    SqliteStatement refusal = db.Prepare("INSERT INTO refusal VALUES(?, ?)");
    for (const Refusal& row : result.refusals) refusal.Run(row.backend, row.reason);
    WriteSummary(db, result);
  });
}

}  // namespace touchdown::evaluation
