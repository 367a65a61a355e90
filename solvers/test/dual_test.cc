// SPDX-License-Identifier: BSD-3-Clause
// First and second derivatives.

#include "touchdown/solvers/problem/dual.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace touchdown::solvers {
namespace {

template <class T>
T Formula(const T& x, const T& y) {
  using std::atan2, std::cos, std::exp, std::log, std::sin, std::sqrt;
  return sin(x * y) / sqrt(1.0 + x * x) + exp(-y) * cos(x) - log(2.0 + x * x) + atan2(y, x + 3.0);
}

TEST(Dual, FirstAndSecondDerivativesMatchDifferences) {
  using First = Dual<2>;
  using Second = SecondDual<2>;
  const double x = 0.7, y = -0.4, d = 1e-5;
  const First f = Formula(First(x, 0), First(y, 1));
  EXPECT_DOUBLE_EQ(f.v, Formula(x, y));
  EXPECT_NEAR(f.d[0], (Formula(x + d, y) - Formula(x - d, y)) / (2 * d), 1e-9);
  EXPECT_NEAR(f.d[1], (Formula(x, y + d) - Formula(x, y - d)) / (2 * d), 1e-9);
  const Second s = Formula(Second(x, 0), Second(y, 1));
  const First plus = Formula(First(x + d, 0), First(y, 1));
  const First minus = Formula(First(x - d, 0), First(y, 1));
  EXPECT_NEAR(s.curvature(0, 0), (plus.d[0] - minus.d[0]) / (2 * d), 1e-8);
  EXPECT_NEAR(s.curvature(0, 1), (plus.d[1] - minus.d[1]) / (2 * d), 1e-8);
  EXPECT_DOUBLE_EQ(s.curvature(0, 1), s.curvature(1, 0));
}

/// A function of two numbers at a place where each of its parts has derivatives.
struct Case {
  const char* name;
  double x, y;
  double (*value)(double, double);
  Dual<2> (*first)(const Dual<2>&, const Dual<2>&);
  SecondDual<2> (*second)(const SecondDual<2>&, const SecondDual<2>&);
};

template <class Function>
constexpr Case MakeCase(const char* name, double x, double y, Function) {
  using First = Dual<2>;
  using Second = SecondDual<2>;
  return {name,
          x,
          y,
          [](double a, double b) { return Function()(a, b); },
          [](const First& a, const First& b) { return Function()(a, b); },
          [](const Second& a, const Second& b) { return Function()(a, b); }};
}

class DualFunctions : public testing::TestWithParam<Case> {};

TEST_P(DualFunctions, DerivativesMatchDifferences) {
  using First = Dual<2>;
  using Second = SecondDual<2>;
  const Case& c = GetParam();
  const double d = 1e-5;
  const First f = c.first(First(c.x, 0), First(c.y, 1));
  const Second s = c.second(Second(c.x, 0), Second(c.y, 1));
  EXPECT_DOUBLE_EQ(f.v, c.value(c.x, c.y));
  EXPECT_DOUBLE_EQ(s.v, f.v);
  for (int i = 0; i < 2; ++i) {
    const double dx = i == 0 ? d : 0.0, dy = i == 1 ? d : 0.0;
    const double slope = (c.value(c.x + dx, c.y + dy) - c.value(c.x - dx, c.y - dy)) / (2 * d);
    EXPECT_NEAR(f.d[i], slope, 1e-8 * (1.0 + std::abs(slope)));
    EXPECT_NEAR(s.slope(i), f.d[i], 1e-14 * (1.0 + std::abs(slope)));
    const First plus = c.first(First(c.x + dx, 0), First(c.y + dy, 1));
    const First minus = c.first(First(c.x - dx, 0), First(c.y - dy, 1));
    for (int j = 0; j < 2; ++j) {
      const double curve = (plus.d[j] - minus.d[j]) / (2 * d);
      EXPECT_NEAR(s.curvature(i, j), curve, 1e-7 * (1.0 + std::abs(curve)));
    }
  }
}

#define DUAL_CASE(name, x, y, formula)                    \
  MakeCase(name, x, y, [](const auto& a, const auto& b) { \
    (void)b;                                              \
    return formula;                                       \
  })

using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp,
    std::log, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;

INSTANTIATE_TEST_SUITE_P(
    All, DualFunctions,
    testing::Values(
        DUAL_CASE("sum", 0.3, 1.2, a + a * b),
        DUAL_CASE("difference", 0.3, 1.2, a* a - b * b * 3.0),
        DUAL_CASE("minus", 0.7, 1.2, -(a* a* b)),
        DUAL_CASE("quotient", 0.7, -1.3, a* a / (b * a + b)),
        DUAL_CASE("of_number", 0.7, -1.3, 2.0 / (b * a)), DUAL_CASE("sqrt", 0.7, 1.3, sqrt(b* a)),
        DUAL_CASE("sin", 0.7, 1.3, sin(b* a)), DUAL_CASE("cos", 0.7, 1.3, cos(b* a)),
        DUAL_CASE("exp", 0.7, 1.3, exp(b* a)), DUAL_CASE("log", 0.7, 1.3, log(b* a)),
        DUAL_CASE("atan2", 0.7, -1.3, atan2(b* a, a - b * b)),
        DUAL_CASE("tan", 0.4, 0.9, tan(a* b)), DUAL_CASE("asin", 0.3, -0.8, asin(a* b)),
        DUAL_CASE("acos", -0.6, 0.7, acos(a* b)), DUAL_CASE("atan", 2.0, -3.0, atan(a* b)),
        DUAL_CASE("sinh", 1.1, -0.7, sinh(a* b)), DUAL_CASE("cosh", 1.1, -0.7, cosh(a* b)),
        DUAL_CASE("tanh", 0.5, 0.8, tanh(a - b)), DUAL_CASE("abs", -2.0, 1.5, abs(a* b)),
        DUAL_CASE("pow_whole", -1.5, 0.3, pow(a* b, 3.0)),
        DUAL_CASE("pow_broken", 1.5, 0.3, pow(a* b, -0.7)),
        DUAL_CASE("pow_of_both", 1.7, 0.6, pow(a, b* a)),
        DUAL_CASE("pow_of_number", 0.8, -0.6, pow(2.5, a* b))),
    [](const auto& tested) { return std::string(tested.param.name); });

#undef DUAL_CASE

TEST(SecondDual, StoresWhatANumberDependsOn) {
  using Second = SecondDual<3>;
  const Second x(0.4, 0), y(-1.2, 1), z(2.0, 2);
  const auto pairs = [](const Second& number) {
    int count = 0;
    number.ForEachCurvature([&](int i, int j, double) {
      EXPECT_LE(i, j);
      ++count;
    });
    return count;
  };
  EXPECT_EQ(pairs(3.0 * x - y / 2.0 + z), 0);
  EXPECT_EQ(pairs(x * y + z), 3);
  EXPECT_EQ(pairs(sin(y) + z), 1);
  Second sum = x * x;
  sum += y * z;
  sum *= 2.0;
  EXPECT_EQ(sum.curvature(0, 0), 4.0);
  EXPECT_EQ(sum.curvature(2, 1), 2.0);
  EXPECT_EQ(sum.curvature(0, 2), 0.0);
  EXPECT_EQ(ValueOf(sum), sum.v);
}

TEST(Dual, WholePowersOfZeroHaveDerivatives) {
  using Second = SecondDual<1>;
  for (const double exponent : {0.0, 1.0, 2.0, 3.0}) {
    const Second s = pow(Second(0.0, 0), exponent);
    EXPECT_EQ(s.v, exponent == 0.0 ? 1.0 : 0.0) << exponent;
    EXPECT_EQ(s.slope(0), exponent == 1.0 ? 1.0 : 0.0) << exponent;
    EXPECT_EQ(s.curvature(0, 0), exponent == 2.0 ? 2.0 : 0.0) << exponent;
  }
}

TEST(Dual, ComparisonsAreOfValuesAndMixWithNumbers) {
  using First = Dual<1>;
  const First a(1.0, 0), same(1.0), more(2.0, 0);
  EXPECT_TRUE(a == same && a <= same && a >= same && a == 1.0 && 1.0 <= a);
  EXPECT_TRUE(a != more && a < more && a <= more && more > a && more >= a && a < 1.5);
  EXPECT_FALSE(a < same || a > same || a == more || more <= a || a != 1.0);
}

}  // namespace
}  // namespace touchdown::solvers
