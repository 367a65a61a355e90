// SPDX-License-Identifier: BSD-3-Clause
// Hock-Schittkowski problems 60 to 113.

#include "solvers/problems/hock_schittkowski_parts.h"

namespace touchdown::solvers {

namespace {

/// The rows of HS78, 80 and 81.
constexpr auto kSurfaces = [](const auto* x, auto* u) {
  u[0] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] + x[4] * x[4] - 10.0;
  u[1] = x[1] * x[2] - 5.0 * x[3] * x[4];
  u[2] = x[0] * x[0] * x[0] + x[1] * x[1] * x[1] + 1.0;
};

}  // namespace

void AddHockSchittkowskiThird(EqualityForm form, std::vector<ReferenceProblem>* all) {
  all->push_back(SmallProblem("HS60", {2.0, 2.0, 2.0}, 0.03256820025, form)
                     .Other(2.18966058)
                     .Squares(3,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 1.0;
                                u[1] = x[0] - x[1];
                                u[2] = Square(x[1] - x[2]);
                              })
                     .Zero(1,
                           [](const auto* x, auto* u) {
                             using std::sqrt;
                             u[0] = x[0] * (1.0 + x[1] * x[1]) + Square(x[2] * x[2]) - 4.0 -
                                    3.0 * std::sqrt(2.0);
                           })
                     .BoundAll(-10.0, 10.0));
  all->push_back(SmallProblem("HS61", {0.0, 0.0, 0.0}, -143.6461422, form)
                     .Other(-81.9190961)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = 4.0 * x[0] * x[0] + 2.0 * x[1] * x[1] + 2.0 * x[2] * x[2] -
                              33.0 * x[0] + 16.0 * x[1] - 24.0 * x[2];
                     })
                     .Zero(2, [](const auto* x, auto* u) {
                       u[0] = 3.0 * x[0] - 2.0 * x[1] * x[1] - 7.0;
                       u[1] = 4.0 * x[0] - x[2] * x[2] - 11.0;
                     }));
  all->push_back(SmallProblem("HS63", {2.0, 2.0, 2.0}, 961.7151721, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = 1000.0 - x[0] * x[0] - 2.0 * x[1] * x[1] - x[2] * x[2] - x[0] * x[1] -
                              x[0] * x[2];
                     })
                     .Zero(2,
                           [](const auto* x, auto* u) {
                             u[0] = 8.0 * x[0] + 14.0 * x[1] + 7.0 * x[2] - 56.0;
                             u[1] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 25.0;
                           })
                     .BoundAll(0.0, kUnbounded));
  all->push_back(
      SmallProblem("HS64", {1.0, 1.0, 1.0}, 6299.842428, form)
          .Cost([](const auto* x, auto* u) {
            u[0] = 5.0 * x[0] + 50000.0 / x[0] + 20.0 * x[1] + 72000.0 / x[1] + 10.0 * x[2] +
                   144000.0 / x[2];
          })
          .AtLeastZero(1, [](const auto* x,
                             auto* u) { u[0] = 1.0 - 4.0 / x[0] - 32.0 / x[1] - 120.0 / x[2]; })
          .BoundAll(1e-5, kUnbounded));
  all->push_back(
      SmallProblem("HS65", {-5.0, 5.0, 0.0}, 0.9535288567, form)
          .Squares(3,
                   [](const auto* x, auto* u) {
                     u[0] = x[0] - x[1];
                     u[1] = (x[0] + x[1] - 10.0) / 3.0;
                     u[2] = x[2] - 5.0;
                   })
          .AtLeastZero(1, [](const auto* x,
                             auto* u) { u[0] = 48.0 - x[0] * x[0] - x[1] * x[1] - x[2] * x[2]; })
          .Bound(0, -4.5, 4.5)
          .Bound(1, -4.5, 4.5)
          .Bound(2, -5.0, 5.0));
  all->push_back(SmallProblem("HS66", {0.0, 1.05, 2.9}, 0.5181632741, form)
                     .Cost([](const auto* x, auto* u) { u[0] = 0.2 * x[2] - 0.8 * x[0]; })
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
      SmallProblem("HS71", {1.0, 5.0, 5.0, 1.0}, 17.0140173, form)
          .Other(32.9443868)
          .Other(30.6969385)
          .Other(27.1464282)
          .Cost([](const auto* x, auto* u) { u[0] = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; })
          .AtLeastZero(1, [](const auto* x, auto* u) { u[0] = x[0] * x[1] * x[2] * x[3] - 25.0; })
          .Zero(1,
                [](const auto* x, auto* u) {
                  u[0] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] - 40.0;
                })
          .BoundAll(1.0, 5.0));
  all->push_back(
      SmallProblem("HS72", {1.0, 1.0, 1.0, 1.0}, 727.67937, form)
          .Cost([](const auto* x, auto* u) { u[0] = 1.0 + x[0] + x[1] + x[2] + x[3]; })
          .AtLeastZero(2,
                       [](const auto* x, auto* u) {
                         u[0] = 0.0401 - 4.0 / x[0] - 2.25 / x[1] - 1.0 / x[2] - 0.25 / x[3];
                         u[1] = 0.010085 - 0.16 / x[0] - 0.36 / x[1] - 0.64 / x[2] - 0.64 / x[3];
                       })
          .Bound(0, 0.001, 4e5)
          .Bound(1, 0.001, 3e5)
          .Bound(2, 0.001, 2e5)
          .Bound(3, 0.001, 1e5));
  all->push_back(
      SmallProblem("HS73", {1.0, 1.0, 1.0, 1.0}, 29.89437816, form)
          .Cost([](const auto* x, auto* u) {
            u[0] = 24.55 * x[0] + 26.75 * x[1] + 39.0 * x[2] + 40.5 * x[3];
          })
          .AtLeastZero(2,
                       [](const auto* x, auto* u) {
                         using std::sqrt;
                         u[0] = 2.3 * x[0] + 5.6 * x[1] + 11.1 * x[2] + 1.3 * x[3] - 5.0;
                         u[1] = 12.0 * x[0] + 11.9 * x[1] + 41.8 * x[2] + 52.1 * x[3] - 21.0 -
                                1.645 * sqrt(0.28 * x[0] * x[0] + 0.19 * x[1] * x[1] +
                                             20.5 * x[2] * x[2] + 0.62 * x[3] * x[3]);
                       })
          .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] + x[1] + x[2] + x[3] - 1.0; })
          .BoundAll(0.0, kUnbounded));
  all->push_back(SmallProblem("HS76", {0.5, 0.5, 0.5, 0.5}, -4.681818181, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = x[0] * x[0] + 0.5 * x[1] * x[1] + x[2] * x[2] + 0.5 * x[3] * x[3] -
                              x[0] * x[2] + x[2] * x[3] - x[0] - 3.0 * x[1] + x[2] - x[3];
                     })
                     .AtLeastZero(3,
                                  [](const auto* x, auto* u) {
                                    u[0] = 5.0 - x[0] - 2.0 * x[1] - x[2] - x[3];
                                    u[1] = 4.0 - 3.0 * x[0] - x[1] - 2.0 * x[2] + x[3];
                                    u[2] = x[1] + 4.0 * x[2] - 1.5;
                                  })
                     .BoundAll(0.0, kUnbounded));
  all->push_back(SmallProblem("HS77", {2.0, 2.0, 2.0, 2.0, 2.0}, 0.24150513, form)
                     .Other(4.602561512)
                     .Other(5.533357279)
                     .Other(9.908760197)
                     .Squares(5,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 1.0;
                                u[1] = x[0] - x[1];
                                u[2] = x[2] - 1.0;
                                u[3] = Square(x[3] - 1.0);
                                u[4] = (x[4] - 1.0) * Square(x[4] - 1.0);
                              })
                     .Zero(2, [](const auto* x, auto* u) {
                       using std::sin, std::sqrt;
                       u[0] = x[0] * x[0] * x[3] + sin(x[3] - x[4]) - 2.0 * std::sqrt(2.0);
                       u[1] = x[1] + Square(x[2] * x[2]) * x[3] * x[3] - 8.0 - std::sqrt(2.0);
                     }));
  all->push_back(SmallProblem("HS78", {-2.0, 1.5, 2.0, -1.0, -1.0}, -2.91970041, form)
                     .Other(-0.823594835)
                     .Other(0.0)  // with x3 = x5 = 0, where x1 > 0
                     .Cost([](const auto* x, auto* u) { u[0] = x[0] * x[1] * x[2] * x[3] * x[4]; })
                     .Zero(3, kSurfaces));
  all->push_back(SmallProblem("HS79", {2.0, 2.0, 2.0, 2.0, 2.0}, 0.0787768209, form)
                     .Other(13.9668249)
                     .Other(27.45200407)
                     .Other(27.52196145)
                     .Squares(5,
                              [](const auto* x, auto* u) {
                                u[0] = x[0] - 1.0;
                                u[1] = x[0] - x[1];
                                u[2] = x[1] - x[2];
                                u[3] = Square(x[2] - x[3]);
                                u[4] = Square(x[3] - x[4]);
                              })
                     .Zero(3, [](const auto* x, auto* u) {
                       using std::sqrt;
                       u[0] = x[0] + x[1] * x[1] + x[2] * x[2] * x[2] - 2.0 - 3.0 * std::sqrt(2.0);
                       u[1] = x[1] - x[2] * x[2] + x[3] + 2.0 - 2.0 * std::sqrt(2.0);
                       u[2] = x[0] * x[4] - 2.0;
                     }));
  all->push_back(SmallProblem("HS80", {-2.0, 2.0, 2.0, -1.0, -1.0}, 0.0539498478, form)
                     .Other(0.438851220)
                     .Other(1.0)
                     .Cost([](const auto* x, auto* u) {
                       using std::exp;
                       u[0] = exp(x[0] * x[1] * x[2] * x[3] * x[4]);
                     })
                     .Zero(3, kSurfaces)
                     .Bound(0, -2.3, 2.3)
                     .Bound(1, -2.3, 2.3)
                     .Bound(2, -3.2, 3.2)
                     .Bound(3, -3.2, 3.2)
                     .Bound(4, -3.2, 3.2));
  all->push_back(SmallProblem("HS81", {-2.0, 2.0, 2.0, -1.0, -1.0}, 0.0539498478, form)
                     .Other(0.438851220)
                     .Other(1.0)
                     .Cost([](const auto* x, auto* u) {
                       using std::exp;
                       u[0] = exp(x[0] * x[1] * x[2] * x[3] * x[4]) -
                              0.5 * Square(x[0] * x[0] * x[0] + x[1] * x[1] * x[1] + 1.0);
                     })
                     .Zero(3, kSurfaces)
                     .Bound(0, -2.3, 2.3)
                     .Bound(1, -2.3, 2.3)
                     .Bound(2, -3.2, 3.2)
                     .Bound(3, -3.2, 3.2)
                     .Bound(4, -3.2, 3.2));
  all->push_back(SmallProblem("HS100", {1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0}, 680.6300573, form)
                     .Cost([](const auto* x, auto* u) {
                       u[0] = Square(x[0] - 10.0) + 5.0 * Square(x[1] - 12.0) +
                              Square(x[2] * x[2]) + 3.0 * Square(x[3] - 11.0) +
                              10.0 * Square(x[4] * x[4]) * x[4] * x[4] + 7.0 * x[5] * x[5] +
                              Square(x[6] * x[6]) - 4.0 * x[5] * x[6] - 10.0 * x[5] - 8.0 * x[6];
                     })
                     .AtLeastZero(4, [](const auto* x, auto* u) {
                       u[0] = 127.0 - 2.0 * x[0] * x[0] - 3.0 * Square(x[1] * x[1]) - x[2] -
                              4.0 * x[3] * x[3] - 5.0 * x[4];
                       u[1] = 282.0 - 7.0 * x[0] - 3.0 * x[1] - 10.0 * x[2] * x[2] - x[3] + x[4];
                       u[2] = 196.0 - 23.0 * x[0] - x[1] * x[1] - 6.0 * x[5] * x[5] + 8.0 * x[6];
                       u[3] = -4.0 * x[0] * x[0] - x[1] * x[1] + 3.0 * x[0] * x[1] -
                              2.0 * x[2] * x[2] - 5.0 * x[5] + 11.0 * x[6];
                     }));
  all->push_back(
      SmallProblem("HS110", {9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0}, -45.77846971, form)
          .Cost([](const auto* x, auto* u) {
            using std::exp, std::log;
            u[0] = 0.0 * x[0];
            auto logs = log(x[0]);
            for (int i = 1; i < 10; ++i) logs = logs + log(x[i]);
            for (int i = 0; i < 10; ++i)
              u[0] = u[0] + Square(log(x[i] - 2.0)) + Square(log(10.0 - x[i]));
            u[0] = u[0] - exp(0.2 * logs);
          })
          .BoundAll(2.001, 9.999));
  all->push_back(
      SmallProblem("HS113", {2.0, 3.0, 5.0, 5.0, 1.0, 2.0, 7.0, 3.0, 6.0, 10.0}, 24.3062091, form)
          .Cost([](const auto* x, auto* u) {
            u[0] = x[0] * x[0] + x[1] * x[1] + x[0] * x[1] - 14.0 * x[0] - 16.0 * x[1] +
                   Square(x[2] - 10.0) + 4.0 * Square(x[3] - 5.0) + Square(x[4] - 3.0) +
                   2.0 * Square(x[5] - 1.0) + 5.0 * x[6] * x[6] + 7.0 * Square(x[7] - 11.0) +
                   2.0 * Square(x[8] - 10.0) + Square(x[9] - 7.0) + 45.0;
          })
          .AtLeastZero(8, [](const auto* x, auto* u) {
            u[0] = 105.0 - 4.0 * x[0] - 5.0 * x[1] + 3.0 * x[6] - 9.0 * x[7];
            u[1] = -10.0 * x[0] + 8.0 * x[1] + 17.0 * x[6] - 2.0 * x[7];
            u[2] = 8.0 * x[0] - 2.0 * x[1] - 5.0 * x[8] + 2.0 * x[9] + 12.0;
            u[3] = -3.0 * Square(x[0] - 2.0) - 4.0 * Square(x[1] - 3.0) - 2.0 * x[2] * x[2] +
                   7.0 * x[3] + 120.0;
            u[4] = -5.0 * x[0] * x[0] - 8.0 * x[1] - Square(x[2] - 6.0) + 2.0 * x[3] + 40.0;
            u[5] = -0.5 * Square(x[0] - 8.0) - 2.0 * Square(x[1] - 4.0) - 3.0 * x[4] * x[4] + x[5] +
                   30.0;
            u[6] = -x[0] * x[0] - 2.0 * Square(x[1] - 2.0) + 2.0 * x[0] * x[1] - 14.0 * x[4] +
                   6.0 * x[5];
            u[7] = 3.0 * x[0] - 6.0 * x[1] - 12.0 * Square(x[8] - 8.0) + 7.0 * x[9];
          }));
}

}  // namespace touchdown::solvers
