// SPDX-License-Identifier: BSD-3-Clause
// Solver backends on problems that are no landings. Each claim is judged by the known optima.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

struct ReferenceOptions {
  std::string set = "hs";             ///< hs, hs-pairs, mgh or shooting
  std::vector<std::string> backends;  ///< none: all
  int starts = 10;                    ///< the published one, and others around it
  std::uint64_t seed = 1;
  int max_iterations = 500;
  double most_seconds = 10.0;  ///< wall time of a solve
};

/// The result of a solve, judged by the known optima. One of them may be local.
enum class Verdict {
  kRight,       ///< converged to one, within 1e-6
  kElsewhere,   ///< converged to another point: a false claim, where all optima are published
  kNotClaimed,  ///< did not say that it had converged
};
const char* ToString(Verdict verdict);

/// One backend on one problem from one start.
struct ReferenceSolve {
  int start = 0;  ///< 0: the published one
  solvers::SolverSummary summary;
  Verdict verdict = Verdict::kNotClaimed;
  bool best = false;  ///< right, and at the best of the optima that are known
};

/// One backend on one problem, from all starts.
struct ReferenceCell {
  std::string problem, backend;
  std::string refusal;  ///< not empty: it was not asked
  std::vector<ReferenceSolve> solves;

  int Count(Verdict verdict) const;
  int AtTheBest() const;
};

struct ReferenceResult {
  bool published = true;  ///< else the best cost of all solves is the optimum
  std::vector<std::string> problems, backends;
  std::vector<double> optima;               ///< [problem], the best known cost
  std::vector<std::vector<double>> others;  ///< [problem], costs at other local optima
  std::vector<ReferenceCell> cells;         ///< [problem][backend]
};

/// Asks the backends of the registry that are compiled in. `report(done, all)` is called after each problem.
ReferenceResult RunReferences(const ReferenceOptions& options,
                              const solvers::BackendRegistry& registry,
                              const std::function<void(int done, int all)>& report);

/// For people: a line for each backend, then problems x backends.
std::string ReferenceText(const ReferenceOptions& options, const ReferenceResult& result);
nlohmann::ordered_json ReferenceJson(const ReferenceOptions& options,
                                     const ReferenceResult& result);

}  // namespace touchdown::evaluation
