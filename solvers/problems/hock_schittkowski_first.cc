// SPDX-License-Identifier: BSD-3-Clause
// Hock-Schittkowski problems 1 to 29.

#include "solvers/problems/hock_schittkowski_parts.h"

namespace touchdown::solvers {

namespace {

/// The cost of HS1, 2, 15 to 17 and 20.
constexpr auto kRosenbrock = [](const auto* x, auto* u) {
  u[0] = 10.0 * (x[1] - x[0] * x[0]);
  u[1] = 1.0 - x[0];
};

}  // namespace

void AddHockSchittkowskiFirst(EqualityForm form, std::vector<ReferenceProblem>* all) {
  all->push_back(SmallProblem("HS1", {-2.0, 1.0}, 0.0, form)
                     .Squares(2, kRosenbrock)
                     .Bound(1, -1.5, kUnbounded));
  all->push_back(SmallProblem("HS2", {-2.0, 1.0}, 0.0504261879, form)
                     .Squares(2, kRosenbrock)
                     .Bound(1, 1.5, kUnbounded)
                     .Other(4.9412293));
  all->push_back(SmallProblem("HS3", {10.0, 1.0}, 0.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = x[1] + 1e-5 * Square(x[1] - x[0]); })
                     .Bound(1, 0.0, kUnbounded));
  all->push_back(SmallProblem("HS4", {1.125, 0.125}, 8.0 / 3.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = (x[0] + 1.0) * Square(x[0] + 1.0) / 3.0 + x[1];
                     })
                     .Bound(0, 1.0, kUnbounded)
                     .Bound(1, 0.0, kUnbounded));
  all->push_back(
      SmallProblem("HS5", {0.0, 0.0}, -0.5 * std::sqrt(3.0) - std::acos(-1.0) / 3.0, form)
          .Other(2.0 / 3.0 * std::acos(-1.0) - 0.5 * std::sqrt(3.0))
          .Cost([](const auto* x, auto* u) {
            using std::sin;
            u[0] = sin(x[0] + x[1]) + Square(x[0] - x[1]) - 1.5 * x[0] + 2.5 * x[1] + 1.0;
          })
          .Bound(0, -1.5, 4.0)
          .Bound(1, -3.0, 3.0));
  all->push_back(SmallProblem("HS6", {-1.2, 1.0}, 0.0, form)
                     .Squares(1, [](const auto* x, auto* u) { u[0] = 1.0 - x[0]; })
                     .Zero(1, [](const auto* x, auto* u) { u[0] = 10.0 * (x[1] - x[0] * x[0]); }));
  all->push_back(SmallProblem("HS7", {2.0, 2.0}, -std::sqrt(3.0), form)
                     .Cost([](const auto* x, auto* u) {
                       using std::log;
                       u[0] = log(1.0 + x[0] * x[0]) - x[1];
                     })
                     .Zero(1, [](const auto* x, auto* u) {
                       u[0] = Square(1.0 + x[0] * x[0]) + x[1] * x[1] - 4.0;
                     }));
  all->push_back(SmallProblem("HS8", {2.0, 1.0}, -1.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = 0.0 * x[0] - 1.0; })
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = x[0] * x[0] + x[1] * x[1] - 25.0;
                       u[1] = x[0] * x[1] - 9.0;
                     }));
  all->push_back(SmallProblem("HS9", {0.0, 0.0}, -0.5, form)
                     .Cost([](const auto* x, auto* u) {
                       using std::cos, std::sin;
                       u[0] =
                           sin(std::acos(-1.0) / 12.0 * x[0]) * cos(std::acos(-1.0) / 16.0 * x[1]);
                     })
                     .Zero(1, [](const auto* x, auto* u) { u[0] = 4.0 * x[0] - 3.0 * x[1]; }));
  all->push_back(SmallProblem("HS10", {-10.0, 10.0}, -1.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = x[0] - x[1]; })
                     .AtLeastZero(1, [](const auto* x, auto* u) {
                       u[0] = -3.0 * x[0] * x[0] + 2.0 * x[0] * x[1] - x[1] * x[1] + 1.0;
                     }));
  all->push_back(
      SmallProblem("HS11", {4.9, 0.1}, -8.498464223, form)
          .Cost([](const auto* x, auto* u) { u[0] = Square(x[0] - 5.0) + x[1] * x[1] - 25.0; })
          .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = x[1] - x[0] * x[0]; }));
  all->push_back(SmallProblem("HS12", {0.0, 0.0}, -30.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] =
                           0.5 * x[0] * x[0] + x[1] * x[1] - x[0] * x[1] - 7.0 * x[0] - 7.0 * x[1];
                     })
                     .AtLeastZero(1, [](const auto* x, auto* u) {
                       u[0] = 25.0 - 4.0 * x[0] * x[0] - x[1] * x[1];
                     }));
  all->push_back(SmallProblem("HS14", {2.0, 2.0}, 9.0 - 2.875 * std::sqrt(7.0), form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 2.0;
                                u[1] = x[1] - 1.0;
                              })
                     .AtLeastZero(1, [](const auto* x,
                                        auto* u) { u[0] = 1.0 - 0.25 * x[0] * x[0] - x[1] * x[1]; })
                     .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] - 2.0 * x[1] + 1.0; }));
  all->push_back(SmallProblem("HS15", {-2.0, 1.0}, 306.5, form)
                     .Squares(2, kRosenbrock)
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[0] * x[1] - 1.0;
                                    u[1] = x[0] + x[1] * x[1];
                                  })
                     .Bound(0, -kUnbounded, 0.5)
                     .Other(360.379767));
  all->push_back(SmallProblem("HS16", {-2.0, 1.0}, 0.25, form)
                     .Squares(2, kRosenbrock)
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[0] + x[1] * x[1];
                                    u[1] = x[0] * x[0] + x[1];
                                  })
                     .Bound(0, -0.5, 0.5)
                     .Bound(1, -kUnbounded, 1.0)
                     .Other(3.9820605)
                     .Other(23.1446609));
  all->push_back(SmallProblem("HS17", {-2.0, 1.0}, 1.0, form)
                     .Squares(2, kRosenbrock)
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[1] * x[1] - x[0];
                                    u[1] = x[0] * x[0] - x[1];
                                  })
                     .Bound(0, -0.5, 0.5)
                     .Bound(1, -kUnbounded, 1.0));
  all->push_back(SmallProblem("HS18", {2.0, 2.0}, 5.0, form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = 0.1 * x[0];
                                u[1] = x[1];
                              })
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[0] * x[1] - 25.0;
                                    u[1] = x[0] * x[0] + x[1] * x[1] - 25.0;
                                  })
                     .Bound(0, 2.0, 50.0)
                     .Bound(1, 0.0, 50.0));
  all->push_back(SmallProblem("HS19", {20.1, 5.84}, -6961.81387558, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = (x[0] - 10.0) * Square(x[0] - 10.0) +
                              (x[1] - 20.0) * Square(x[1] - 20.0);
                     })
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = Square(x[0] - 5.0) + Square(x[1] - 5.0) - 100.0;
                                    u[1] = 82.81 - Square(x[1] - 5.0) - Square(x[0] - 6.0);
                                  })
                     .Bound(0, 13.0, 100.0)
                     .Bound(1, 0.0, 100.0));
  all->push_back(SmallProblem("HS20", {-2.0, 1.0}, 81.5 - 25.0 * std::sqrt(3.0), form)
                     .Other(40.1987298)
                     .Squares(2, kRosenbrock)
                     .AtLeastZero(3,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[0] + x[1] * x[1];
                                    u[1] = x[0] * x[0] + x[1];
                                    u[2] = x[0] * x[0] + x[1] * x[1] - 1.0;
                                  })
                     .Bound(0, -0.5, 0.5)
                     .Other(40.1987298));
  all->push_back(
      SmallProblem("HS21", {-1.0, -1.0}, -99.96, form)
          .Cost([](const auto* x, auto* u) { u[0] = 0.01 * x[0] * x[0] + x[1] * x[1] - 100.0; })
          .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = 10.0 * x[0] - x[1] - 10.0; })
          .Bound(0, 2.0, 50.0)
          .Bound(1, -50.0, 50.0));
  all->push_back(SmallProblem("HS22", {2.0, 2.0}, 1.0, form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 2.0;
                                u[1] = x[1] - 1.0;
                              })
                     .AtLeastZero(2, [](const auto* x, auto* u) {
                       u[0] = 2.0 - x[0] - x[1];
                       u[1] = x[1] - x[0] * x[0];
                     }));
  all->push_back(SmallProblem("HS23", {3.0, 1.0}, 2.0, form)
                     .Other(5.0 + 2.0 * std::sqrt(5.0))
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0];
                                u[1] = x[1];
                              })
                     .AtLeastZero(5,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[0] + x[1] - 1.0;
                                    u[1] = x[0] * x[0] + x[1] * x[1] - 1.0;
                                    u[2] = 9.0 * x[0] * x[0] + x[1] * x[1] - 9.0;
                                    u[3] = x[0] * x[0] - x[1];
                                    u[4] = x[1] * x[1] - x[0];
                                  })
                     .BoundAll(-50.0, 50.0));
  all->push_back(SmallProblem("HS24", {1.0, 0.5}, -1.0, form)
                     .Cost([](const auto* x, auto* u) {
                       using std::sqrt;
                       u[0] = (Square(x[0] - 3.0) - 9.0) * x[1] * x[1] * x[1] /
                              (27.0 * std::sqrt(3.0));
                     })
                     .AtLeastZero(3,
                                  [](const auto* x, auto* u) {
                                    using std::sqrt;
                                    u[0] = x[0] / std::sqrt(3.0) - x[1];
                                    u[1] = x[0] + std::sqrt(3.0) * x[1];
                                    u[2] = 6.0 - x[0] - std::sqrt(3.0) * x[1];
                                  })
                     .BoundAll(0.0, kUnbounded));
  all->push_back(SmallProblem("HS26", {-2.6, 2.0, 2.0}, 0.0, form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - x[1];
                                u[1] = Square(x[1] - x[2]);
                              })
                     .Zero(1, [](const auto* x, auto* u) {
                       u[0] = (1.0 + x[1] * x[1]) * x[0] + Square(x[2] * x[2]) - 3.0;
                     }));
  all->push_back(SmallProblem("HS27", {2.0, 2.0, 2.0}, 0.04, form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = 0.1 * (x[0] - 1.0);
                                u[1] = x[1] - x[0] * x[0];
                              })
                     .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] + x[2] * x[2] + 1.0; }));
  all->push_back(
      SmallProblem("HS28", {-4.0, 1.0, 1.0}, 0.0, form)
          .Squares(2,
                   [](const auto* x, auto* u) {
                     u[0] = x[0] + x[1];
                     u[1] = x[1] + x[2];
                   })
          .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] + 2.0 * x[1] + 3.0 * x[2] - 1.0; }));
  all->push_back(SmallProblem("HS29", {1.0, 1.0, 1.0}, -16.0 * std::sqrt(2.0), form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[1] * x[2]; })
                     .AtLeastZero(1, [](const auto* x, auto* u) {
                       u[0] = 48.0 - x[0] * x[0] - 2.0 * x[1] * x[1] - 4.0 * x[2] * x[2];
                     }));
}

}  // namespace touchdown::solvers
