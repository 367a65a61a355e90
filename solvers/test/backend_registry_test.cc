// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/backend_registry.h"

#include <gtest/gtest.h>

#include "solvers/test/standard_problems.h"

namespace touchdown::solvers {
namespace {

TEST(Overheard, HearsEverySolveOfEveryBackendAndChangesNone) {
  StandardProblem p = Standard("Rosenbrock", {-1.2, 1.0}, {1.0, 1.0}, 0.0);
  p.problem->AddTerm(Whole<2, 2>("squares", SquareLoss(2.0),
                                 [](const auto* x, auto* u) {
                                   u[0] = 10.0 * (x[1] - x[0] * x[0]);
                                   u[1] = 1.0 - x[0];
                                 }),
                     Role::kCost);
  const View view(*p.problem);
  int heard = 0;
  const BackendRegistry overheard = Overheard(StandardBackends(), [&](const SolveRequest& asked) {
    ++heard;
    EXPECT_EQ(&asked.view, &view);
    EXPECT_EQ(asked.start.y, p.start);
    EXPECT_EQ(asked.stop.max_iterations, 7);
  });
  int solved = 0;
  for (const BackendEntry& entry : overheard) {
    const auto backend = entry.make();
    if (!backend->Refusal(view).empty()) continue;
    const auto alone = MakeBackend(StandardBackends(), entry.name);
    SolverResult a, b;
    for (SolverBackend* one : {backend.get(), alone.get()}) one->Prepare(view);
    // Near enough from the start on, too: there the rule ends the solve before the backend begins.
    for (const double gap : {0.0, 0.999}) {
      const Stop stop{.max_iterations = 7, .gap = gap};
      backend->Solve(view, p.start, stop, &a);
      alone->Solve(view, p.start, stop, &b);
      EXPECT_EQ(heard, ++solved) << entry.name;
      EXPECT_EQ(a.x, b.x) << entry.name;
    }
  }
  EXPECT_GT(solved, 1);
}

}  // namespace
}  // namespace touchdown::solvers
