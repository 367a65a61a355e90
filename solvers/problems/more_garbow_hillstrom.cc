// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/problems/more_garbow_hillstrom.h"

#include <cmath>

#include "solvers/problems/square.h"

namespace touchdown::solvers {

namespace {

SmallProblem Start(const char* name, std::vector<double> start, double cost) {
  return SmallProblem(name, std::move(start), cost, EqualityForm::kRows);
}

void AddOfTwoVariables(std::vector<ReferenceProblem>* all) {
  all->push_back(Start("rosenbrock", {-1.2, 1.0}, 0.0).Squares(2, [](const auto* x, auto* u) {
    u[0] = 10.0 * (x[1] - x[0] * x[0]);
    u[1] = 1.0 - x[0];
  }));
  all->push_back(Start("freudenstein_roth", {0.5, -2.0}, 0.0)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 13.0 + ((5.0 - x[1]) * x[1] - 2.0) * x[1];
                                u[1] = x[0] - 29.0 + ((x[1] + 1.0) * x[1] - 14.0) * x[1];
                              })
                     .Other(48.98425367924));
  all->push_back(Start("powell_badly_scaled", {0.0, 1.0}, 0.0)
                     .Other(1.040294004)
                     .Squares(2, [](const auto* x, auto* u) {
                       using std::exp;
                       u[0] = 1e4 * x[0] * x[1] - 1.0;
                       u[1] = exp(-x[0]) + exp(-x[1]) - 1.0001;
                     }));
  all->push_back(
      Start("brown_badly_scaled", {1.0, 1.0}, 0.0).Squares(3, [](const auto* x, auto* u) {
        u[0] = x[0] - 1e6;
        u[1] = x[1] - 2e-6;
        u[2] = x[0] * x[1] - 2.0;
      }));
  all->push_back(Start("beale", {1.0, 1.0}, 0.0).Squares(3, [](const auto* x, auto* u) {
    u[0] = 1.5 - x[0] * (1.0 - x[1]);
    u[1] = 2.25 - x[0] * (1.0 - x[1] * x[1]);
    u[2] = 2.625 - x[0] * (1.0 - x[1] * x[1] * x[1]);
  }));
  all->push_back(Start("jennrich_sampson", {0.3, 0.4}, 124.3621823557)
                     .Other(259.58019013)  // one or both at minus infinity: flat to rounding
                     .Other(2020.0)
                     .Squares(10, [](const auto* x, auto* u) {
                       using std::exp;
                       for (int i = 1; i <= 10; ++i) {
                         const double k = i;
                         u[i - 1] = 2.0 + 2.0 * k - exp(k * x[0]) - exp(k * x[1]);
                       }
                     }));
}

void AddOfThreeVariables(std::vector<ReferenceProblem>* all) {
  all->push_back(
      Start("helical_valley", {-1.0, 0.0, 0.0}, 0.0).Squares(3, [](const auto* x, auto* u) {
        using std::atan, std::sqrt;
        const double pi = std::acos(-1.0);
        const auto turn = atan(x[1] / x[0]) / (2.0 * pi) + (x[0] < 0.0 ? 0.5 : 0.0);
        u[0] = 10.0 * (x[2] - 10.0 * turn);
        u[1] = 10.0 * (sqrt(x[0] * x[0] + x[1] * x[1]) - 1.0);
        u[2] = x[2];
      }));
  all->push_back(
      Start("gaussian", {0.4, 1.0, 0.0}, 1.12793276962e-8)
          .Other(0.56422337)
          .Squares(15, [](const auto* x, auto* u) {
            using std::exp;
            constexpr double y[] = {0.0009, 0.0044, 0.0175, 0.0540, 0.1295, 0.2420, 0.3521, 0.3989};
            for (int i = 1; i <= 15; ++i) {
              const double t = 0.5 * (8 - i);
              u[i - 1] = x[0] * exp(-0.5 * x[1] * Square(t - x[2])) - y[std::min(i, 16 - i) - 1];
            }
          }));
  all->push_back(Start("box", {0.0, 10.0, 20.0}, 0.0)
                     .Other(0.07558874)
                     .Squares(10, [](const auto* x, auto* u) {
                       using std::exp;
                       for (int i = 1; i <= 10; ++i) {
                         const double t = 0.1 * i;
                         u[i - 1] = exp(-t * x[0]) - exp(-t * x[1]) -
                                    x[2] * (std::exp(-t) - std::exp(-10.0 * t));
                       }
                     }));
}

void AddOfMoreVariables(std::vector<ReferenceProblem>* all) {
  all->push_back(
      Start("powell_singular", {3.0, -1.0, 0.0, 1.0}, 0.0).Squares(4, [](const auto* x, auto* u) {
        u[0] = x[0] + 10.0 * x[1];
        u[1] = std::sqrt(5.0) * (x[2] - x[3]);
        u[2] = Square(x[1] - 2.0 * x[2]);
        u[3] = std::sqrt(10.0) * Square(x[0] - x[3]);
      }));
  all->push_back(
      Start("wood", {-3.0, -1.0, -3.0, -1.0}, 0.0).Squares(6, [](const auto* x, auto* u) {
        u[0] = 10.0 * (x[1] - x[0] * x[0]);
        u[1] = 1.0 - x[0];
        u[2] = std::sqrt(90.0) * (x[3] - x[2] * x[2]);
        u[3] = 1.0 - x[2];
        u[4] = std::sqrt(10.0) * (x[1] + x[3] - 2.0);
        u[5] = (x[1] - x[3]) / std::sqrt(10.0);
      }));
  all->push_back(Start("brown_dennis", {25.0, 5.0, -5.0, -1.0}, 85822.2016263)
                     .Squares(20, [](const auto* x, auto* u) {
                       for (int i = 1; i <= 20; ++i) {
                         const double t = 0.2 * i;
                         u[i - 1] = Square(x[0] + t * x[1] - std::exp(t)) +
                                    Square(x[2] + x[3] * std::sin(t) - std::cos(t));
                       }
                     }));
  all->push_back(Start("biggs", {1.0, 2.0, 1.0, 1.0, 1.0, 1.0}, 0.0)
                     .Squares(13,
                              [](const auto* x, auto* u) {
                                using std::exp;
                                for (int i = 1; i <= 13; ++i) {
                                  const double t = 0.1 * i;
                                  const double y = std::exp(-t) - 5.0 * std::exp(-10.0 * t) +
                                                   3.0 * std::exp(-4.0 * t);
                                  u[i - 1] = x[2] * exp(-t * x[0]) - x[3] * exp(-t * x[1]) +
                                             x[5] * exp(-t * x[4]) - y;
                                }
                              })
                     .Other(5.65564987e-3)
                     .Other(0.24267883)
                     .Other(0.30636677)
                     .Other(9.86373228));
  all->push_back(Start("watson", {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 2.28767005355e-3)
                     .Squares(31, [](const auto* x, auto* u) {
                       for (int i = 1; i <= 29; ++i) {
                         const double t = i / 29.0;
                         auto slope = x[1], value = x[0] + t * x[1];
                         double power = t;
                         for (int j = 2; j < 6; ++j) {
                           slope += j * power * x[j];
                           power *= t;
                           value += power * x[j];
                         }
                         u[i - 1] = slope - value * value - 1.0;
                       }
                       u[29] = x[0] + 0.0;
                       u[30] = x[1] - x[0] * x[0] - 1.0;
                     }));
}

/// Terms on neighbours, of many variables: a curve between two ends at 0.
ReferenceProblem DiscreteBoundaryValue(int n) {
  const auto problem = std::make_shared<Problem>(ProblemShape{.blocks = n, .block_size = 1});
  const double h = 1.0 / (n + 1);
  Eigen::VectorXd start(n);
  for (int i = 0; i < n; ++i) {
    const double t = h * (i + 1);
    start[i] = t * (t - 1.0);
    const int first = std::max(i - 1, 0), last = std::min(i + 1, n - 1);
    const FunctionShape shape{.window = last - first + 1, .first = first};
    const auto function = [=](const auto* x, auto* u) {
      const auto* here = x + (i - first);
      const auto bend = here[0] + t + 1.0;
      u[0] = 2.0 * here[0] + 0.5 * h * h * bend * bend * bend;
      if (i > 0) u[0] -= here[-1];
      if (i < n - 1) u[0] -= here[1];
    };
    problem->AddTerm(
        std::make_shared<FunctionTerm>(TermInfo{.name = "bend"}, shape, SquareLoss(2.0), function),
        Role::kCost);
  }
  return {"discrete_boundary_value", problem, start, 0.0, {}};
}

}  // namespace

std::vector<ReferenceProblem> MoreGarbowHillstrom() {
  std::vector<ReferenceProblem> all;
  AddOfTwoVariables(&all);
  AddOfThreeVariables(&all);
  AddOfMoreVariables(&all);
  all.push_back(DiscreteBoundaryValue(50));
  return all;
}

}  // namespace touchdown::solvers
