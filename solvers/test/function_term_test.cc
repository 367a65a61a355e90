// SPDX-License-Identifier: BSD-3-Clause
// A term sized at run time against the same WindowTerm.

#include "touchdown/solvers/problem/function_term.h"

#include <gtest/gtest.h>

#include "touchdown/solvers/problem/problem.h"
#include "touchdown/solvers/problem/window_term.h"

namespace touchdown::solvers {
namespace {

constexpr auto kFunction = [](int window, const auto* q, auto* u) {
  using std::exp, std::sin;
  u[0] = sin(q[0] * q[3]) + (1.0 + window) * q[2] * q[2] * q[1];
  u[1] = exp(0.3 * q[1]) - q[0] * q[2];
};

struct Map {
  static constexpr int kBlockSize = 2, kWindow = 2, kOutputs = 2;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  int windows() const { return 3; }
  int first_block(int k) const { return k + 1; }
  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    kFunction(k, q, u);
  }
};

const FunctionShape kShape{.block_size = 2, .window = 2, .outputs = 2, .first = 1, .windows = 3};

template <class Loss>
void ExpectTheSame(const Loss& loss, Role role) {
  std::vector<Evaluation> at(2);
  const std::vector<double> multiplier = {0.3, -0.7, 0.2, 1.1, -0.4, 0.9}, weight(6, 0.5);
  const RowWeights rows{multiplier.data(), weight.data()};
  for (int i = 0; i < 2; ++i) {
    Problem problem({.blocks = 5, .block_size = 2});
    if (i == 0) {
      problem.AddTerm(std::make_shared<WindowTerm<Map, Loss>>(TermInfo{"a"}, Map(), loss, 3), role);
    } else {
      problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{"a"}, kShape, loss, kFunction), role);
    }
    problem.Resize(&at[i]);
    const double x[] = {0.1, -0.4, 0.7, 0.2, -0.9, 0.5, 0.3, 0.8, -0.2, 0.6};
    ASSERT_TRUE(problem.Evaluate(x, 1.0, {.gradient = true, .hessian = true, .residual = true},
                                 {.objective_factor = 2.0, .rows = &rows}, &at[i]));
  }
  EXPECT_DOUBLE_EQ(at[0].value, at[1].value);
  EXPECT_DOUBLE_EQ(at[0].max_violation, at[1].max_violation);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(at[0].gradient[i], at[1].gradient[i], 1e-14);
    EXPECT_NEAR(at[0].row_gradient[i], at[1].row_gradient[i], 1e-14);
    for (int j = 0; j < 10; ++j) EXPECT_NEAR(at[0].hessian.At(i, j), at[1].hessian.At(i, j), 1e-13);
  }
  EXPECT_EQ(at[0].terms[0].r, at[1].terms[0].r);
}

TEST(FunctionTerm, IsTheSameAsAWindowTerm) {
  ExpectTheSame(SquareLoss(2.0), Role::kCost);
  ExpectTheSame(HingeLoss(1.0, 0.5), Role::kCost);
  ExpectTheSame(RangeLoss({-0.1, 0.2}, 1.0, 0.5), Role::kCost);
  ExpectTheSame(RangeLoss({-0.1, 0.2}, 1.0, 0.5), Role::kConstraint);
  ExpectTheSame(SquareLoss(1.0), Role::kConstraint);
}

TEST(FunctionTerm, RefusesSizesOutOfRange) {
  const auto make = [](FunctionShape shape) {
    return FunctionTerm(TermInfo{"a"}, shape, SquareLoss(1.0), kFunction);
  };
  EXPECT_NO_THROW(make(kShape));
  EXPECT_THROW(make({.block_size = 33, .outputs = 2}), std::invalid_argument);
  EXPECT_THROW(make({.block_size = 4, .outputs = 0}), std::invalid_argument);
  EXPECT_THROW(make({.block_size = 4, .outputs = 2, .first = -1}), std::invalid_argument);
}

// One output more than there are: behind a sum that holds few, and behind the most there can be.
TEST(FunctionTerm, AFunctionThatWritesMoreThanItsOutputsIsRefused) {
  for (const int outputs : {1, FunctionTerm::kMostOutputs}) {
    Problem problem({.blocks = 2, .block_size = 1});
    problem.AddTerm(std::make_shared<FunctionTerm>(TermInfo{"wide"},
                                                   FunctionShape{.outputs = outputs, .windows = 2},
                                                   SquareLoss(1.0),
                                                   [=](const auto* q, auto* u) {
                                                     for (int c = 0; c <= outputs; ++c) u[c] = q[0];
                                                   }),
                    Role::kCost);
    Evaluation at;
    problem.Resize(&at);
    const double x[] = {0.1, 0.2};
    for (const bool gradient : {false, true}) {
      EXPECT_FALSE(problem.Evaluate(x, 1.0, {.gradient = gradient}, {}, &at));
      const std::string m = std::to_string(outputs);
      EXPECT_EQ(at.failure, "FunctionTerm wide: the function writes u[" + m +
                                "], and FunctionShape::outputs is " + m);
    }
  }
}

}  // namespace
}  // namespace touchdown::solvers
