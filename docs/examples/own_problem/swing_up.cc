// SPDX-License-Identifier: BSD-3-Clause
// A pendulum that swings up within two seconds: states and inputs as blocks, dynamics as rows
// between neighbours.
#include <cmath>
#include <iostream>
#include "touchdown/solvers/solvers.h"
using namespace touchdown::solvers;

int main() {
  constexpr int N = 60;                                         // blocks
  constexpr int kAngle = 0, kRate = 1, kTorque = 2, kSize = 3;  // the numbers of each
  constexpr double kStep = 2.0 / N, kPi = 3.14159265358979, kInf = INFINITY;
  Problem problem({.blocks = N, .block_size = kSize});
  // Rows, of each block q and the next, q + kSize: x_k+1 - x_k - h f(x_k, u_k) = 0. SquareLoss
  // makes u = 0 of them.
  problem.AddTerm(
      std::make_shared<FunctionTerm>(
          TermInfo{"dynamics"},
          FunctionShape{.block_size = kSize, .window = 2, .outputs = 2, .windows = N - 1},
          SquareLoss(1.0),
          [=](const auto* q, auto* u) {
            using std::sin;
            const auto* next = q + kSize;
            u[0] = next[kAngle] - q[kAngle] - kStep * q[kRate];
            u[1] = next[kRate] - q[kRate] - kStep * (q[kTorque] - 9.81 * sin(q[kAngle]));
          }),
      Role::kConstraint);
  problem.AddTerm(std::make_shared<FunctionTerm>(
                      TermInfo{"effort"}, FunctionShape{.block_size = kSize, .windows = N},
                      SquareLoss(2.0 * kStep), [=](const auto* q, auto* u) { u[0] = q[kTorque]; }),
                  Role::kCost);
  // It hangs still at first, and stands still at last; the torque is limited throughout.
  std::vector<double> lower(kSize * N, -kInf), upper(kSize * N, kInf);
  for (int k = 0; k < N; ++k) lower[kSize * k + kTorque] = -8.0, upper[kSize * k + kTorque] = 8.0;
  for (const int state : {kAngle, kRate}) {
    const int last = kSize * (N - 1) + state;
    lower[state] = upper[state] = 0.0;
    lower[last] = upper[last] = state == kAngle ? kPi : 0.0;
  }
  problem.SetBounds(lower, upper);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(kSize * N);
  for (int k = 0; k < N; ++k) start[kSize * k + kAngle] = kPi * k / (N - 1.0);

  const View view(problem);
  const auto backend = MakeBackend(StandardBackends(), "banded");
  backend->options().Set("gap_tolerance", 1e-8);
  backend->Prepare(view);  // all that allocates; then any number of solves of this structure
  SolverResult found;
  backend->Solve(view, start, {.max_iterations = 300}, &found);
  std::cout << ToString(found.status) << " after " << found.iterations << " iterations, effort "
            << found.cost << "\n";
  if (found.status != SolveStatus::kConverged) std::cout << found.message << "\n";
}
