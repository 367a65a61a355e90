// SPDX-License-Identifier: BSD-3-Clause
// A smooth curve through noisy numbers that stays between 0 and 1: a cubic B-spline whose control points are bounded.
#include <cmath>
#include <iostream>
#include "touchdown/solvers/solvers.h"
using namespace touchdown::solvers;

int main() {
  constexpr int kPoints = 60;  // control points, each a block of one; knots are 1 apart
  std::vector<double> measured;
  for (int k = 0; k < kPoints - 2; ++k) {
    const double truth = 0.5 - 0.5 * std::cos(0.2 * k);
    measured.push_back(truth + 0.15 * std::sin(9.0 * k * k));
  }

  Problem problem({.blocks = kPoints, .block_size = 1});
  // The curve at knot k is a mean of three control points.
  problem.AddTerm(
      std::make_shared<FunctionTerm>(
          TermInfo{"misfit"}, FunctionShape{.window = 3, .windows = kPoints - 2}, SquareLoss(1.0),
          [=](int k, const auto* q, auto* u) {
            u[0] = (q[0] + 4.0 * q[1] + q[2]) / 6.0 - measured[k];
          }),
      Role::kCost);
  // The third derivative, constant between two knots.
  problem.AddTerm(std::make_shared<FunctionTerm>(
                      TermInfo{"roughness"}, FunctionShape{.window = 4, .windows = kPoints - 3},
                      SquareLoss(1000.0),
                      [](const auto* q, auto* u) { u[0] = q[3] - 3.0 * q[2] + 3.0 * q[1] - q[0]; }),
                  Role::kCost);
  problem.SetBounds(std::vector<double>(kPoints, 0.0), std::vector<double>(kPoints, 1.0));

  const SolverResult found = Solve(problem, Eigen::VectorXd::Constant(kPoints, 0.5));
  double least = 1.0, most = 0.0, squares = 0.0;
  for (int k = 0; k < kPoints - 2; ++k) {
    const double curve = (found.x[k] + 4.0 * found.x[k + 1] + found.x[k + 2]) / 6.0;
    least = std::min(least, curve), most = std::max(most, curve);
    squares += std::pow(curve - 0.5 + 0.5 * std::cos(0.2 * k), 2);
  }
  std::cout << ToString(found.status) << ", cost " << found.cost << ", from " << least << " to "
            << most << ", in the root mean square " << std::sqrt(squares / (kPoints - 2))
            << " from the truth\n";
}
