// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/reference_table.h"

#include "touchdown/evaluation/result_file.h"
#include "touchdown/evaluation/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kFormat{"touchdown problem set", 1};

constexpr char kSchema[] = R"sql(
CREATE TABLE problem(problem TEXT PRIMARY KEY, optimum REAL);
CREATE TABLE solve(problem TEXT, backend TEXT, start INTEGER, verdict TEXT, status TEXT, cost REAL,
  max_violation REAL, time_cpu_ms REAL, time_wall_ms REAL, iterations INTEGER, evaluations INTEGER,
  check_violation REAL, check_step REAL, check_gain REAL, check_left REAL, check_gap REAL,
  check_evaluations INTEGER, PRIMARY KEY(problem, backend, start));
CREATE TABLE refusal(problem TEXT, backend TEXT, reason TEXT, PRIMARY KEY(problem, backend));
)sql";

ManifestFacts Facts(const ReferenceOptions& options, const ReferenceResult& result,
                    const MachineState& machine) {
  ManifestFacts facts{{"problem_set", options.set},
                      {"starts", std::to_string(options.starts)},
                      {"seed", std::to_string(options.seed)},
                      {"max_iterations", std::to_string(options.max_iterations)},
                      {"published", result.published ? "1" : "0"}};
  AddMachine(machine, &facts);
  return facts;
}

void WriteCells(SqliteDb& db, const ReferenceResult& result) {
  SqliteStatement solve = db.Prepare(
      "INSERT INTO solve VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement refusal = db.Prepare("INSERT INTO refusal VALUES(?, ?, ?)");
  for (const ReferenceCell& cell : result.cells) {
    if (!cell.refusal.empty()) refusal.Run(cell.problem, cell.backend, cell.refusal);
    for (const ReferenceSolve& of_start : cell.solves) {
      const solvers::SolverSummary& s = of_start.summary;
      const solvers::Optimality& check = s.optimality;
      solve.Run(cell.problem, cell.backend, of_start.start, ToString(of_start.verdict),
                ToString(s.status), s.cost, s.max_violation, 1e3 * s.cpu_s, 1e3 * s.wall_s,
                s.iterations, s.evaluations, check.violation, check.step, check.gain, check.left,
                check.gap, check.evaluations);
    }
  }
}

}  // namespace

void WriteReferenceTable(const std::string& path, const ReferenceOptions& options,
                         const ReferenceResult& result, const MachineState& machine) {
  WriteResultFile(path, kFormat, kSchema, Facts(options, result, machine), [&](SqliteDb& db) {
    SqliteStatement problem = db.Prepare("INSERT INTO problem VALUES(?, ?)");
    for (std::size_t i = 0; i < result.problems.size(); ++i) {
      problem.Run(result.problems[i], result.optima[i]);
    }
    WriteCells(db, result);
  });
}

}  // namespace touchdown::evaluation
