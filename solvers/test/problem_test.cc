// SPDX-License-Identifier: BSD-3-Clause
// Structure checks and constraint rows.

#include "touchdown/solvers/problem/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

TEST(Problem, RefusesTermsThatDoNotFit) {
  Problem problem({.blocks = 2, .block_size = 2});
  const auto wavy = std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
      TermInfo{"wavy", "", "", "", false}, WavyMap(1), SquareLoss(1.0), 1);
  EXPECT_THROW(problem.AddTerm(wavy, Role::kCost), std::invalid_argument);
  EXPECT_THROW(problem.AddTerm(nullptr, Role::kCost), std::invalid_argument);
  EXPECT_THROW(Problem({.blocks = 0}), std::invalid_argument);
  Problem scalars({.blocks = 9, .block_size = 1});
  const auto sum = [](const auto* x, auto* u) { u[0] = x[0] + x[6]; };
  EXPECT_THROW(scalars.AddTerm((SumOfSquares<7, 1>("long", sum, true)), Role::kCost),
               std::invalid_argument);
}

TEST(Problem, RefusesAnIntervalWithoutEnd) {
  const double endless = std::numeric_limits<double>::infinity();
  EXPECT_THROW(
      Problem({.blocks = 1, .block_size = 1, .interval_min = 0.1, .interval_max = endless}),
      std::invalid_argument);
}

TEST(Problem, AWindowThatStraysOutOfTheProblemIsAnEvaluationThatFails) {
  class Stray : public WavyMap {
   public:
    explicit Stray(const int* first) : WavyMap(1), first_(first) {}
    int first_block(int /*k*/) const { return *first_; }

   private:
    const int* first_;
  };
  int first = 8;
  const auto stray = std::make_shared<WindowTerm<Stray, SquareLoss>>(
      TermInfo{"stray", "", "", "", false}, Stray(&first), SquareLoss(1.0), 1);
  Problem problem({.blocks = 10, .block_size = 2});
  EXPECT_THROW(problem.AddTerm(stray, Role::kCost), std::invalid_argument) << "it is outside";
  first = 7;
  problem.AddTerm(stray, Role::kCost);
  first = 8;
  Evaluation e;
  problem.Resize(&e);
  // Room for the stray window's read, but not for its write.
  const std::vector<double> x(24, 0.5);
  EXPECT_FALSE(problem.Evaluate(x.data(), 1.0, {.gradient = true}, {}, &e));
}

TEST(Problem, ConstraintRowsReportTheirViolationAndCurvature) {
  Problem problem({.blocks = 1, .block_size = 1});
  // u = x^2 - 4 <= 0 as a row; its curvature with multiplier 3 is 6.
  const auto map = [](const auto* x, auto* u) { u[0] = x[0] * x[0] - 4.0; };
  using Map = WholeMap<1, 1, decltype(map)>;
  problem.AddTerm(std::make_shared<WindowTerm<Map, HingeLoss>>(TermInfo{"row", "", "", "", true},
                                                               Map(map), HingeLoss(1.0, 1.0), 1),
                  Role::kConstraint);
  Evaluation e;
  problem.Resize(&e);
  const double x = 3.0, multiplier = 3.0;
  const RowWeights rows[] = {{.multiplier = &multiplier}};
  ASSERT_TRUE(problem.Evaluate(&x, 1.0, {.gradient = true, .hessian = true}, {.rows = rows}, &e));
  EXPECT_EQ(e.value, 0.0);
  EXPECT_DOUBLE_EQ(e.max_violation, 5.0);
  EXPECT_DOUBLE_EQ(e.terms[0].du[0], 6.0);
  EXPECT_DOUBLE_EQ(e.hessian.At(0, 0), 6.0);
  EXPECT_EQ(e.gradient[0], 0.0);
}

TEST(Problem, AnEvaluationThatWasSizedBeforeATermSaysSo) {
  Problem problem({.blocks = 9, .block_size = 2});
  const auto wavy = [](int windows) {
    return std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
        TermInfo{"wavy", "", "", "", false}, WavyMap(windows), SquareLoss(1.0), windows);
  };
  const std::vector<double> x(18, 0.1);
  Evaluation e;
  EXPECT_FALSE(problem.Evaluate(x.data(), 1.0, {}, {}, &e)) << "never sized";
  EXPECT_THAT(e.failure, testing::HasSubstr("not resized"));
  problem.Resize(&e);
  EXPECT_TRUE(problem.Evaluate(x.data(), 1.0, {}, {}, &e));
  problem.AddTerm(wavy(7), Role::kCost);
  EXPECT_FALSE(problem.Fits(e));
  EXPECT_FALSE(problem.Evaluate(x.data(), 1.0, {.gradient = true, .hessian = true}, {}, &e));
  EXPECT_THAT(e.failure, testing::HasSubstr("not resized"));
  problem.Resize(&e);
  EXPECT_TRUE(problem.Evaluate(x.data(), 1.0, {.gradient = true, .hessian = true}, {}, &e));
  // As many terms, but larger ones.
  Problem other({.blocks = 9, .block_size = 2});
  other.AddTerm(wavy(5), Role::kCost);
  other.Resize(&e);
  EXPECT_FALSE(problem.Evaluate(x.data(), 1.0, {}, {}, &e));
}

}  // namespace
}  // namespace touchdown::solvers
