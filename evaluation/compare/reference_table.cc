// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/compare/reference_table.h"

#include <optional>

#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kSetFormat{"touchdown problem set", 2};

constexpr char kSetSchema[] = R"sql(
CREATE TABLE problem(problem TEXT PRIMARY KEY, optimum REAL);
CREATE TABLE other_optimum(problem TEXT, cost REAL);
CREATE TABLE solve(problem TEXT, backend TEXT, start INTEGER, verdict TEXT, best INTEGER, status TEXT, cost REAL,
  max_violation REAL, time_cpu_ms REAL, time_wall_ms REAL, iterations INTEGER, evaluations INTEGER,
  check_violation REAL, check_step REAL, check_gain REAL, check_left REAL, check_gap REAL,
  check_gap_left REAL, check_saddle INTEGER, check_evaluations INTEGER, PRIMARY KEY(problem, backend, start));
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
      "INSERT INTO solve VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement refusal = db.Prepare("INSERT INTO refusal VALUES(?, ?, ?)");
  for (const ReferenceCell& cell : result.cells) {
    if (!cell.refusal.empty()) refusal.Run(cell.problem, cell.backend, cell.refusal);
    for (const ReferenceSolve& of_start : cell.solves) {
      const solvers::SolverSummary& s = of_start.summary;
      const solvers::Optimality& check = s.optimality;
      // A solve that was not checked has no figures.
      const auto of_check = [&check](double number) {
        return check.evaluated ? std::optional(number) : std::nullopt;
      };
      solve.Run(cell.problem, cell.backend, of_start.start, ToString(of_start.verdict),
                of_start.best ? 1 : 0, ToString(s.status), s.cost, s.max_violation, 1e3 * s.cpu_s,
                1e3 * s.wall_s, s.iterations, s.evaluations, of_check(check.violation),
                of_check(check.step), of_check(check.gain), of_check(check.left),
                of_check(check.gap), of_check(check.gap_left), of_check(check.saddle ? 1.0 : 0.0),
                check.evaluations);
    }
  }
}

}  // namespace

void WriteReferenceTable(const std::string& path, const ReferenceOptions& options,
                         const ReferenceResult& result, const MachineState& machine) {
  WriteResultFile(path, kSetFormat, kSetSchema, Facts(options, result, machine), [&](SqliteDb& db) {
    SqliteStatement problem = db.Prepare("INSERT INTO problem VALUES(?, ?)");
    SqliteStatement other = db.Prepare("INSERT INTO other_optimum VALUES(?, ?)");
    for (std::size_t i = 0; i < result.problems.size(); ++i) {
      problem.Run(result.problems[i], result.optima[i]);
      for (const double cost : result.others[i]) other.Run(result.problems[i], cost);
    }
    WriteCells(db, result);
  });
}

}  // namespace touchdown::evaluation
