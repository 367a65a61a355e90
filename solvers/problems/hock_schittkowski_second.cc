// SPDX-License-Identifier: BSD-3-Clause
// Hock-Schittkowski problems 30 to 53.

#include "solvers/problems/hock_schittkowski_parts.h"

namespace touchdown::solvers {

namespace {

/// The cost of HS46 and 49.
constexpr auto kFlat = [](const auto* x, auto* u) {
  u[0] = x[0] - x[1];
  u[1] = x[2] - 1.0;
  u[2] = Square(x[3] - 1.0);
  u[3] = (x[4] - 1.0) * Square(x[4] - 1.0);
};

/// The cost of HS51 and 53.
constexpr auto kNear = [](const auto* x, auto* u) {
  u[0] = x[0] - x[1];
  u[1] = x[1] + x[2] - 2.0;
  u[2] = x[3] - 1.0;
  u[3] = x[4] - 1.0;
};

/// The rows of HS52 and 53.
constexpr auto kPlanes = [](const auto* x, auto* u) {
  u[0] = x[0] + 3.0 * x[1];
  u[1] = x[2] + x[3] - 2.0 * x[4];
  u[2] = x[1] - x[4];
};

}  // namespace

void AddHockSchittkowskiSecond(EqualityForm form, std::vector<ReferenceProblem>* all) {
  all->push_back(
      SmallProblem("HS30", {1.0, 1.0, 1.0}, 1.0, form)
          .Squares(3,
                   [](const auto* x, auto* u) {
                     u[0] = x[0];
                     u[1] = x[1];
                     u[2] = x[2];
                   })
          .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1] - 1.0; })
          .Bound(0, 1.0, 10.0)
          .Bound(1, -10.0, 10.0)
          .Bound(2, -10.0, 10.0));
  all->push_back(SmallProblem("HS31", {1.0, 1.0, 1.0}, 6.0, form)
                     .Squares(3,
                              [](const auto* x, auto* u) {
                                u[0] = 3.0 * x[0];
                                u[1] = x[1];
                                u[2] = 3.0 * x[2];
                              })
                     .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = x[0] * x[1] - 1.0; })
                     .Bound(0, -10.0, 10.0)
                     .Bound(1, 1.0, 10.0)
                     .Bound(2, -10.0, 1.0));
  all->push_back(SmallProblem("HS32", {0.1, 0.7, 0.2}, 1.0, form)
                     .Squares(2,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] + 3.0 * x[1] + x[2];
                                u[1] = 2.0 * (x[0] - x[1]);
                              })
                     .AtLeastZero(1,
                                  [](const auto* x, auto* u) {
                                    u[0] = 6.0 * x[1] + 4.0 * x[2] - x[0] * x[0] * x[0] - 3.0;
                                  })
                     .Zero(1, [](const auto* x, auto* u) { u[0] = 1.0 - x[0] - x[1] - x[2]; })
                     .BoundAll(0.0, kUnbounded));
  all->push_back(SmallProblem("HS33", {0.0, 0.0, 3.0}, std::sqrt(2.0) - 6.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = (x[0] - 1.0) * (x[0] - 2.0) * (x[0] - 3.0) + x[2];
                     })
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = x[2] * x[2] - x[1] * x[1] - x[0] * x[0];
                                    u[1] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 4.0;
                                  })
                     .Bound(0, 0.0, kUnbounded)
                     .Bound(1, 0.0, kUnbounded)
                     .Bound(2, 0.0, 5.0));
  all->push_back(SmallProblem("HS34", {0.0, 1.05, 2.9}, -std::log(std::log(10.0)), form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0]; })
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    using std::exp;
                                    u[0] = x[1] - exp(x[0]);
                                    u[1] = x[2] - exp(x[1]);
                                  })
                     .Bound(0, 0.0, 100.0)
                     .Bound(1, 0.0, 100.0)
                     .Bound(2, 0.0, 10.0));
  all->push_back(
      SmallProblem("HS35", {0.5, 0.5, 0.5}, 1.0 / 9.0, form)
          .Cost([](const auto* x, auto* u) {
            u[0] = 9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2] + 2.0 * x[0] * x[0] +
                   2.0 * x[1] * x[1] + x[2] * x[2] + 2.0 * x[0] * x[1] + 2.0 * x[0] * x[2];
          })
          .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = 3.0 - x[0] - x[1] - 2.0 * x[2]; })
          .BoundAll(0.0, kUnbounded));
  all->push_back(SmallProblem("HS36", {10.0, 10.0, 10.0}, -3300.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[1] * x[2]; })
                     .AtLeastZero(1, [](const auto* x,
                                        auto* u) { u[0] = 72.0 - x[0] - 2.0 * x[1] - 2.0 * x[2]; })
                     .Bound(0, 0.0, 20.0)
                     .Bound(1, 0.0, 11.0)
                     .Bound(2, 0.0, 42.0));
  all->push_back(SmallProblem("HS37", {10.0, 10.0, 10.0}, -3456.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[1] * x[2]; })
                     .AtLeastZero(2,
                                  [](const auto* x, auto* u) {
                                    u[0] = 72.0 - x[0] - 2.0 * x[1] - 2.0 * x[2];
                                    u[1] = x[0] + 2.0 * x[1] + 2.0 * x[2];
                                  })
                     .BoundAll(0.0, 42.0));
  all->push_back(SmallProblem("HS38", {-3.0, -1.0, -3.0, -1.0}, 0.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = 100.0 * Square(x[1] - x[0] * x[0]) + Square(1.0 - x[0]) +
                              90.0 * Square(x[3] - x[2] * x[2]) + Square(1.0 - x[2]) +
                              10.1 * (Square(x[1] - 1.0) + Square(x[3] - 1.0)) +
                              19.8 * (x[1] - 1.0) * (x[3] - 1.0);
                     })
                     .BoundAll(-10.0, 10.0));
  all->push_back(SmallProblem("HS39", {2.0, 2.0, 2.0, 2.0}, -1.0, form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0]; })
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = x[1] - x[0] * x[0] * x[0] - x[2] * x[2];
                       u[1] = x[0] * x[0] - x[1] - x[3] * x[3];
                     }));
  all->push_back(SmallProblem("HS40", {0.8, 0.8, 0.8, 0.8}, -0.25, form)
                     .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[1] * x[2] * x[3]; })
                     .Zero(3, [](const auto* x, auto* u) {
                       u[0] = x[0] * x[0] * x[0] + x[1] * x[1] - 1.0;
                       u[1] = x[0] * x[0] * x[3] - x[2];
                       u[2] = x[3] * x[3] - x[1];
                     }));
  all->push_back(
      SmallProblem("HS41", {2.0, 2.0, 2.0, 2.0}, 52.0 / 27.0, form)
          .Cost([](const auto* x, auto* u) { u[0] = 2.0 - x[0] * x[1] * x[2]; })
          .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] + 2.0 * x[1] + 2.0 * x[2] - x[3]; })
          .Bound(0, 0.0, 1.0)
          .Bound(1, 0.0, 1.0)
          .Bound(2, 0.0, 1.0)
          .Bound(3, 0.0, 2.0));
  all->push_back(SmallProblem("HS42", {1.0, 1.0, 1.0, 1.0}, 28.0 - 10.0 * std::sqrt(2.0), form)
                     .Squares(4,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 1.0;
                                u[1] = x[1] - 2.0;
                                u[2] = x[2] - 3.0;
                                u[3] = x[3] - 4.0;
                              })
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = x[0] - 2.0;
                       u[1] = x[2] * x[2] + x[3] * x[3] - 2.0;
                     }));
  all->push_back(SmallProblem("HS43", {0.0, 0.0, 0.0, 0.0}, -44.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2] + x[3] * x[3] -
                              5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2] + 7.0 * x[3];
                     })
                     .AtLeastZero(3, [](const auto* x, auto* u) {
                       u[0] = 8.0 - x[0] * x[0] - x[1] * x[1] - x[2] * x[2] - x[3] * x[3] - x[0] +
                              x[1] - x[2] + x[3];
                       u[1] = 10.0 - x[0] * x[0] - 2.0 * x[1] * x[1] - x[2] * x[2] -
                              2.0 * x[3] * x[3] + x[0] + x[3];
                       u[2] = 5.0 - 2.0 * x[0] * x[0] - x[1] * x[1] - x[2] * x[2] - 2.0 * x[0] +
                              x[1] + x[3];
                     }));
  all->push_back(SmallProblem("HS44", {0.0, 0.0, 0.0, 0.0}, -15.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = x[0] - x[1] - x[2] - x[0] * x[2] + x[0] * x[3] + x[1] * x[2] -
                              x[1] * x[3];
                     })
                     .AtLeastZero(6,
                                  [](const auto* x, auto* u) {
                                    u[0] = 8.0 - x[0] - 2.0 * x[1];
                                    u[1] = 12.0 - 4.0 * x[0] - x[1];
                                    u[2] = 12.0 - 3.0 * x[0] - 4.0 * x[1];
                                    u[3] = 8.0 - 2.0 * x[2] - x[3];
                                    u[4] = 8.0 - x[2] - 2.0 * x[3];
                                    u[5] = 5.0 - x[2] - x[3];
                                  })
                     .BoundAll(0.0, kUnbounded)
                     .Other(-13.0));
  all->push_back(SmallProblem("HS45", {2.0, 2.0, 2.0, 2.0, 2.0}, 1.0, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = 2.0 - x[0] * x[1] * x[2] * x[3] * x[4] / 120.0;
                     })
                     .Bound(0, 0.0, 1.0)
                     .Bound(1, 0.0, 2.0)
                     .Bound(2, 0.0, 3.0)
                     .Bound(3, 0.0, 4.0)
                     .Bound(4, 0.0, 5.0));
  all->push_back(SmallProblem("HS46", {std::sqrt(0.5), 1.75, 0.5, 2.0, 2.0}, 0.0, form)
                     .Other(0.0210889286)
                     .Other(3.95024704)
                     .Other(105.7193328)
                     .Other(109.0850755)
                     .Squares(4, kFlat)
                     .Zero(2, [](const auto* x, auto* u) {
                       using std::sin;
                       u[0] = x[0] * x[0] * x[3] + sin(x[3] - x[4]) - 1.0;
                       u[1] = x[1] + Square(x[2] * x[2]) * x[3] * x[3] - 2.0;
                     }));
  all->push_back(SmallProblem("HS48", {3.0, 5.0, -3.0, 2.0, -2.0}, 0.0, form)
                     .Squares(3,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 1.0;
                                u[1] = x[1] - x[2];
                                u[2] = x[3] - x[4];
                              })
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = x[0] + x[1] + x[2] + x[3] + x[4] - 5.0;
                       u[1] = x[2] - 2.0 * (x[3] + x[4]) + 3.0;
                     }));
  all->push_back(SmallProblem("HS49", {10.0, 7.0, 2.0, -3.0, 0.8}, 0.0, form)
                     .Squares(4, kFlat)
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = x[0] + x[1] + x[2] + 4.0 * x[3] - 7.0;
                       u[1] = x[2] + 5.0 * x[4] - 6.0;
                     }));
  all->push_back(SmallProblem("HS50", {35.0, -31.0, 11.0, 5.0, -5.0}, 0.0, form)
                     .Squares(4,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - x[1];
                                u[1] = x[1] - x[2];
                                u[2] = Square(x[2] - x[3]);
                                u[3] = x[3] - x[4];
                              })
                     .Zero(3, [](const auto* x, auto* u) {
                       u[0] = x[0] + 2.0 * x[1] + 3.0 * x[2] - 6.0;
                       u[1] = x[1] + 2.0 * x[2] + 3.0 * x[3] - 6.0;
                       u[2] = x[2] + 2.0 * x[3] + 3.0 * x[4] - 6.0;
                     }));
  all->push_back(SmallProblem("HS51", {2.5, 0.5, 2.0, -1.0, 0.5}, 0.0, form)
                     .Squares(4, kNear)
                     .Zero(3, [](const auto* x, auto* u) {
                       u[0] = x[0] + 3.0 * x[1] - 4.0;
                       u[1] = x[2] + x[3] - 2.0 * x[4];
                       u[2] = x[1] - x[4];
                     }));
  all->push_back(SmallProblem("HS52", {2.0, 2.0, 2.0, 2.0, 2.0}, 1859.0 / 349.0, form)
                     .Squares(4,
                              [](const auto* x, auto* u) {
                                u[0] = 4.0 * x[0] - x[1];
                                u[1] = x[1] + x[2] - 2.0;
                                u[2] = x[3] - 1.0;
                                u[3] = x[4] - 1.0;
                              })
                     .Zero(3, kPlanes));
  all->push_back(SmallProblem("HS53", {2.0, 2.0, 2.0, 2.0, 2.0}, 176.0 / 43.0, form)
                     .Squares(4, kNear)
                     .Zero(3, kPlanes)
                     .BoundAll(-10.0, 10.0));
}

}  // namespace touchdown::solvers
