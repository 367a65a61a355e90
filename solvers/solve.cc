// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/solve.h"

#include "touchdown/solvers/backend_registry.h"

namespace touchdown::solvers {

SolverResult Solve(const Problem& problem, const Eigen::VectorXd& start, const std::string& backend,
                   const Stop& stop) {
  const View view(problem);
  const auto solver = MakeBackend(StandardBackends(), backend);
  solver->Prepare(view);
  SolverResult result;
  solver->Solve(view, WarmStart(start), stop, &result);
  return result;
}

}  // namespace touchdown::solvers
