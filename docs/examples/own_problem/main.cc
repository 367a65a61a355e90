// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include "touchdown/solvers/solvers.h"
using namespace touchdown::solvers;

int main(int argc, char** argv) {
  constexpr int N = 1000;  // numbers in a row, each a block of one
  Problem problem({.blocks = N, .block_size = 1});
  // The cost, a sum of squares over each number and the next: 100 (x_k+1 - x_k^2)^2 + (1 - x_k)^2.
  problem.AddTerm(
      std::make_shared<FunctionTerm>(
          TermInfo{"valley"}, FunctionShape{.window = 2, .outputs = 2, .windows = N - 1},
          SquareLoss(2.0),
          [](const auto* x, auto* u) { u[0] = 10.0 * (x[1] - x[0] * x[0]), u[1] = 1.0 - x[0]; }),
      Role::kCost);
  // A row for each three of them: x_k x_k+1 + x_k+2 <= 1.5.
  problem.AddTerm(
      std::make_shared<FunctionTerm>(TermInfo{"rows"}, FunctionShape{.window = 3, .windows = N - 2},
                                     RangeLoss({-INFINITY, 1.5}, 1.0, 1.0),
                                     [](const auto* x, auto* u) { u[0] = x[0] * x[1] + x[2]; }),
      Role::kConstraint);
  problem.SetBounds(std::vector<double>(N, -2.0), std::vector<double>(N, 0.9));
  const SolverResult found =
      Solve(problem, Eigen::VectorXd::Constant(N, -1.0), argc > 1 ? argv[1] : "banded");
  std::cout << ToString(found.status) << ", cost " << found.cost << ", violation "
            << found.max_violation << "\n";
}
