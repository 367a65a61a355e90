// SPDX-License-Identifier: BSD-3-Clause
// Small problems with known optima, in the form of terms on scalar blocks. HSk are those of
// W. Hock, K. Schittkowski, "Test Examples for Nonlinear Programming Codes", 1981.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "solvers/test/test_terms.h"
#include "touchdown/solvers/problem/problem.h"

namespace touchdown::solvers {

struct StandardProblem {
  std::string name;
  std::unique_ptr<Problem> problem;
  Eigen::VectorXd start;
  Eigen::VectorXd optimum;
  double cost = 0.0;  ///< at the optimum
};

/// A term sum_c rho(u_c(x)) over the whole of x, with any loss.
template <int n, int outputs, class Loss, class Function>
std::shared_ptr<Term> Whole(const std::string& name, Loss loss, Function function) {
  using Map = WholeMap<n, outputs, Function>;
  return std::make_shared<WindowTerm<Map, Loss>>(TermInfo{name, "", "1", "test", true},
                                                 Map(function), loss, 1);
}

/// Rows u(x) <= 0, as a hinge made hard.
template <int n, int outputs, class Function>
std::shared_ptr<Term> AtMostZero(const std::string& name, Function function) {
  return Whole<n, outputs>(name, HingeLoss(1.0, 1.0), function);
}

/// Rows u(x) = 0, as a square made hard.
template <int n, int outputs, class Function>
std::shared_ptr<Term> EqualZero(const std::string& name, Function function) {
  return Whole<n, outputs>(name, SquareLoss(1.0), function);
}

inline StandardProblem Standard(const std::string& name, const std::vector<double>& start,
                                const std::vector<double>& optimum, double cost) {
  const auto vector = [](const std::vector<double>& v) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<int>(v.size())));
  };
  const int n = static_cast<int>(start.size());
  return {name, std::make_unique<Problem>(ProblemShape{.blocks = n, .block_size = 1}),
          vector(start), vector(optimum), cost};
}

inline StandardProblem BoundedLeastSquares() {
  StandardProblem p = Standard("BoundedLeastSquares", {0.5, 0.5}, {1.5, 0.0}, 2.5);
  p.problem->AddTerm(Whole<2, 2>("squares", SquareLoss(2.0),
                                 [](const auto* x, auto* u) {
                                   u[0] = x[0] + x[1] - 1.0;
                                   u[1] = x[0] - x[1] - 3.0;
                                 }),
                     Role::kCost);
  p.problem->AddTerm(AtMostZero<2, 2>("bounds",
                                      [](const auto* x, auto* u) {
                                        u[0] = x[0] - 1.5;
                                        u[1] = -x[1];
                                      }),
                     Role::kConstraint);
  return p;
}

/// The point of {x >= 0, sum x <= 9} nearest to (1, .., 6): x_i = max(0, i - 2.25).
inline StandardProblem Projection() {
  StandardProblem p = Standard("Projection", {1.0, 1.0, 1.0, 1.0, 1.0, 1.0},
                               {0.0, 0.0, 0.75, 1.75, 2.75, 3.75}, 25.25);
  p.problem->AddTerm(Whole<6, 6>("distance", SquareLoss(2.0),
                                 [](const auto* x, auto* u) {
                                   for (int i = 0; i < 6; ++i) u[i] = x[i] - (i + 1.0);
                                 }),
                     Role::kCost);
  p.problem->AddTerm(AtMostZero<6, 7>("rows",
                                      [](const auto* x, auto* u) {
                                        u[6] = x[0] - 9.0;
                                        for (int i = 1; i < 6; ++i) u[6] = u[6] + x[i];
                                        for (int i = 0; i < 6; ++i) u[i] = -x[i];
                                      }),
                     Role::kConstraint);
  return p;
}

inline StandardProblem Hs6() {
  StandardProblem p = Standard("HS6", {-1.2, 1.0}, {1.0, 1.0}, 0.0);
  p.problem->AddTerm(
      Whole<2, 1>("square", SquareLoss(2.0), [](const auto* x, auto* u) { u[0] = 1.0 - x[0]; }),
      Role::kCost);
  p.problem->AddTerm(
      EqualZero<2, 1>("parabola",
                      [](const auto* x, auto* u) { u[0] = 10.0 * (x[1] - x[0] * x[0]); }),
      Role::kConstraint);
  return p;
}

inline StandardProblem Hs7() {
  StandardProblem p = Standard("HS7", {2.0, 2.0}, {0.0, std::sqrt(3.0)}, -std::sqrt(3.0));
  p.problem->AddTerm(Whole<2, 1>("logarithm", LinearLoss(1.0),
                                 [](const auto* x, auto* u) {
                                   using std::log;
                                   u[0] = log(1.0 + x[0] * x[0]) - x[1];
                                 }),
                     Role::kCost);
  p.problem->AddTerm(EqualZero<2, 1>("quartic",
                                     [](const auto* x, auto* u) {
                                       const auto s = 1.0 + x[0] * x[0];
                                       u[0] = s * s + x[1] * x[1] - 4.0;
                                     }),
                     Role::kConstraint);
  return p;
}

inline StandardProblem Hs14() {
  const double root = std::sqrt(7.0);
  StandardProblem p =
      Standard("HS14", {2.0, 2.0}, {0.5 * (root - 1.0), 0.25 * (root + 1.0)}, 9.0 - 2.875 * root);
  p.problem->AddTerm(Whole<2, 2>("squares", SquareLoss(2.0),
                                 [](const auto* x, auto* u) {
                                   u[0] = x[0] - 2.0;
                                   u[1] = x[1] - 1.0;
                                 }),
                     Role::kCost);
  p.problem->AddTerm(
      AtMostZero<2, 1>(
          "ellipse", [](const auto* x, auto* u) { u[0] = 0.25 * x[0] * x[0] + x[1] * x[1] - 1.0; }),
      Role::kConstraint);
  p.problem->AddTerm(
      EqualZero<2, 1>("line", [](const auto* x, auto* u) { u[0] = x[0] - 2.0 * x[1] + 1.0; }),
      Role::kConstraint);
  return p;
}

inline StandardProblem Hs35() {
  StandardProblem p =
      Standard("HS35", {0.5, 0.5, 0.5}, {4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0}, 1.0 / 9.0);
  p.problem->AddTerm(Whole<3, 1>("quadratic", LinearLoss(1.0),
                                 [](const auto* x, auto* u) {
                                   u[0] = 9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2] +
                                          2.0 * x[0] * x[0] + 2.0 * x[1] * x[1] + x[2] * x[2] +
                                          2.0 * x[0] * x[1] + 2.0 * x[0] * x[2];
                                 }),
                     Role::kCost);
  p.problem->AddTerm(AtMostZero<3, 4>("rows",
                                      [](const auto* x, auto* u) {
                                        u[0] = x[0] + x[1] + 2.0 * x[2] - 3.0;
                                        for (int i = 0; i < 3; ++i) u[i + 1] = -x[i];
                                      }),
                     Role::kConstraint);
  return p;
}

inline StandardProblem Hs40() {
  const auto power = [](double exponent) { return std::pow(2.0, exponent); };
  StandardProblem p =
      Standard("HS40", {0.8, 0.8, 0.8, 0.8},
               {power(-1.0 / 3.0), power(-0.5), power(-11.0 / 12.0), power(-0.25)}, -0.25);
  p.problem->AddTerm(Whole<4, 1>("product", LinearLoss(-1.0),
                                 [](const auto* x, auto* u) { u[0] = x[0] * x[1] * x[2] * x[3]; }),
                     Role::kCost);
  p.problem->AddTerm(EqualZero<4, 3>("surfaces",
                                     [](const auto* x, auto* u) {
                                       u[0] = x[0] * x[0] * x[0] + x[1] * x[1] - 1.0;
                                       u[1] = x[0] * x[0] * x[3] - x[2];
                                       u[2] = x[3] * x[3] - x[1];
                                     }),
                     Role::kConstraint);
  return p;
}

inline StandardProblem Hs71() {
  StandardProblem p =
      Standard("HS71", {1.0, 5.0, 5.0, 1.0}, {1.0, 4.7429996, 3.8211499, 1.3794083}, 17.0140173);
  p.problem->AddTerm(
      Whole<4, 1>("cost", LinearLoss(1.0),
                  [](const auto* x, auto* u) { u[0] = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; }),
      Role::kCost);
  p.problem->AddTerm(AtMostZero<4, 9>("rows",
                                      [](const auto* x, auto* u) {
                                        u[0] = 25.0 - x[0] * x[1] * x[2] * x[3];
                                        for (int i = 0; i < 4; ++i) {
                                          u[1 + i] = 1.0 - x[i];
                                          u[5 + i] = x[i] - 5.0;
                                        }
                                      }),
                     Role::kConstraint);
  p.problem->AddTerm(EqualZero<4, 1>("sphere",
                                     [](const auto* x, auto* u) {
                                       u[0] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] +
                                              x[3] * x[3] - 40.0;
                                     }),
                     Role::kConstraint);
  return p;
}

inline std::vector<StandardProblem> ConstrainedProblems() {
  std::vector<StandardProblem> all;
  all.push_back(BoundedLeastSquares());
  all.push_back(Projection());
  all.push_back(Hs6());
  all.push_back(Hs7());
  all.push_back(Hs14());
  all.push_back(Hs35());
  all.push_back(Hs40());
  all.push_back(Hs71());
  return all;
}

/// x^2 with x <= -1 and x >= 1.
inline StandardProblem Infeasible() {
  StandardProblem p = Standard("Infeasible", {0.5}, {0.0}, 0.0);
  p.problem->AddTerm(
      Whole<1, 1>("square", SquareLoss(2.0), [](const auto* x, auto* u) { u[0] = x[0]; }),
      Role::kCost);
  p.problem->AddTerm(AtMostZero<1, 2>("apart",
                                      [](const auto* x, auto* u) {
                                        u[0] = x[0] + 1.0;
                                        u[1] = 1.0 - x[0];
                                      }),
                     Role::kConstraint);
  return p;
}

}  // namespace touchdown::solvers
