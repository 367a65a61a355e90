// SPDX-License-Identifier: BSD-3-Clause
// First and second derivatives by nested duals.

#include "touchdown/solvers/dual.h"

#include <gtest/gtest.h>

namespace touchdown::solvers {
namespace {

template <class T>
T Formula(const T& x, const T& y) {
  using std::atan2, std::cos, std::exp, std::log, std::sin, std::sqrt;
  return sin(x * y) / sqrt(1.0 + x * x) + exp(-y) * cos(x) - log(2.0 + x * x) + atan2(y, x + 3.0);
}

TEST(Dual, FirstAndSecondDerivativesMatchDifferences) {
  using First = Dual<double, 2>;
  using Second = Dual<First, 2>;
  const double x = 0.7, y = -0.4, d = 1e-5;
  const First f = Formula(First(x, 0), First(y, 1));
  EXPECT_DOUBLE_EQ(f.v, Formula(x, y));
  EXPECT_NEAR(f.d[0], (Formula(x + d, y) - Formula(x - d, y)) / (2 * d), 1e-9);
  EXPECT_NEAR(f.d[1], (Formula(x, y + d) - Formula(x, y - d)) / (2 * d), 1e-9);
  const Second s = Formula(Second(First(x, 0), 0), Second(First(y, 1), 1));
  const First plus = Formula(First(x + d, 0), First(y, 1));
  const First minus = Formula(First(x - d, 0), First(y, 1));
  EXPECT_NEAR(s.d[0].d[0], (plus.d[0] - minus.d[0]) / (2 * d), 1e-8);
  EXPECT_NEAR(s.d[0].d[1], (plus.d[1] - minus.d[1]) / (2 * d), 1e-8);
  EXPECT_DOUBLE_EQ(s.d[0].d[1], s.d[1].d[0]);
}

}  // namespace
}  // namespace touchdown::solvers
