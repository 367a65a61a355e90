// SPDX-License-Identifier: BSD-3-Clause
// Shared by the conformance suites: a test that runs on a named backend, and the names it runs on.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "solvers/test/standard_problems.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::solvers {

class EveryBackend : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<SolverBackend> Make() const {
    return MakeBackend(StandardBackends(), GetParam());
  }

  SolverResult Solve(const Problem& problem, const Eigen::VectorXd& warm, const Stop& stop = {}) {
    const View view(problem);
    auto backend = Make();
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, warm, stop, &result);
    return result;
  }
};

inline Problem Scalars(int n) { return Problem({.blocks = n, .block_size = 1}); }

inline auto Rosenbrock() {
  return SumOfSquares<2, 2>(
      "rosenbrock",
      [](const auto* x, auto* u) {
        u[0] = 10.0 * (x[1] - x[0] * x[0]);
        u[1] = 1.0 - x[0];
      },
      false);
}

/// Names of the compiled backends, of those that take hard rows if `with_rows`.
inline std::vector<std::string> CompiledBackends(bool with_rows = false) {
  std::vector<std::string> names;
  for (const BackendEntry& entry : StandardBackends()) {
    const Capabilities can = entry.make()->capabilities();
    if (can.compiled && (can.hard_rows || !with_rows)) names.push_back(entry.name);
  }
  return names;
}

/// A backend's name as a test's.
inline std::string TestName(const ::testing::TestParamInfo<std::string>& test) {
  std::string name = test.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

}  // namespace touchdown::solvers
