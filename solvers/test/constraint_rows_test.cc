// SPDX-License-Identifier: BSD-3-Clause
// Flat rows against the view's own products with its rows and against central differences; rows on
// eliminated blocks.

#include "touchdown/solvers/backend/constraint_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

/// One row on each of the first `windows` blocks.
struct FirstOfBlock {
  static constexpr int kBlockSize = 2, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  int count;
  int windows() const { return count; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0];
  }
};

constexpr int kBlocks = 9;

Problem WithRows(bool free_interval) {
  Problem problem({.blocks = kBlocks, .block_size = 2, .free_interval = free_interval});
  problem.set_interval(0.8);
  problem.AddTerm(std::make_shared<WindowTerm<FirstOfBlock, SquareLoss>>(
                      TermInfo{"equal", "", "", "", true}, FirstOfBlock{4}, SquareLoss(1.0), 6),
                  Role::kConstraint);
  problem.AddTerm(std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
                      TermInfo{"cost", "", "", "", false}, WavyMap(7), SquareLoss(1.0), 7),
                  Role::kCost);
  problem.AddTerm(std::make_shared<WindowTerm<WavyMap, HingeLoss>>(
                      TermInfo{"below", "", "", "", false}, WavyMap(7), HingeLoss(1.0, 1.0), 7),
                  Role::kConstraint);
  return problem;
}

TEST(ConstraintRows, MatchTheViewsProductsAndDifferences) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const bool free_interval : {false, true}) {
    const Problem problem = WithRows(free_interval);
    for (const View& view : {View(problem, AffineLift::Identity(kBlocks)), FoldedView(problem)}) {
      const int n = view.num_variables();
      Eigen::VectorXd y(n), dy(n);
      for (int i = 0; i < n; ++i) {
        y[i] = 0.7 * normal(random);
        dy[i] = normal(random);
      }
      if (free_interval) y[n - 1] = 0.8;
      ViewEvaluation e;
      view.Resize(&e);
      ConstraintRows rows;
      rows.Prepare(view);
      ASSERT_TRUE(view.Evaluate(y.data(), {.gradient = true}, {}, &e));
      rows.Set(view, e);

      std::vector<double> u(rows.size()), jacobian(rows.nonzeros());
      rows.Values(e, u.data());
      rows.Jacobian(e, jacobian.data());
      ASSERT_EQ(rows.start(rows.size()), rows.nonzeros());
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows.size(), n);
      for (int r = 0; r < rows.size(); ++r) {
        for (int k = rows.start(r); k < rows.start(r + 1); ++k) J(r, rows.column(k)) = jacobian[k];
      }

      std::vector<std::vector<double>> products;
      ConstraintRows::Size(view, &products);
      double* out[] = {products[0].data(), nullptr, products[2].data()};
      view.MultiplyRows(dy.data(), &e, out);
      std::vector<double> flat(rows.size());
      ASSERT_TRUE(rows.Gather(products, flat.data()));
      const Eigen::VectorXd Jdy = J * dy;
      for (int r = 0; r < rows.size(); ++r) EXPECT_NEAR(flat[r], Jdy[r], 1e-12);

      constexpr double kStep = 1e-6;
      for (int i = 0; i < n; ++i) {
        std::vector<double> above(rows.size()), below(rows.size());
        Eigen::VectorXd moved = y;
        moved[i] += kStep;
        ASSERT_TRUE(view.Evaluate(moved.data(), {}, {}, &e));
        rows.Values(e, above.data());
        moved[i] = y[i] - kStep;
        ASSERT_TRUE(view.Evaluate(moved.data(), {}, {}, &e));
        rows.Values(e, below.data());
        for (int r = 0; r < rows.size(); ++r) {
          EXPECT_NEAR((above[r] - below[r]) / (2.0 * kStep), J(r, i), 1e-7);
        }
      }
    }
  }
}

TEST(ConstraintRows, KnowsBoundsAndLeavesConstantRowsOut) {
  const Problem problem = WithRows(false);
  const View view = FoldedView(problem);
  ViewEvaluation e;
  view.Resize(&e);
  ConstraintRows rows;
  rows.Prepare(view);
  const Eigen::VectorXd y = Eigen::VectorXd::Zero(view.num_variables());
  ASSERT_TRUE(view.Evaluate(y.data(), {.gradient = true}, {}, &e));
  rows.Set(view, e);
  // The equalities on blocks 0 and 1 cannot be moved; their values are sin(h) and sin(2 + h).
  ASSERT_EQ(rows.size(), 2 + 14);
  EXPECT_NEAR(rows.constant_violation(), std::sin(0.8), 1e-12);
  EXPECT_EQ(rows.lo(0), 0.0);
  EXPECT_EQ(rows.hi(0), 0.0);
  EXPECT_EQ(rows.lo(2), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(rows.hi(2), 0.0);

  std::vector<double> flat(rows.size()), back(rows.size());
  for (std::size_t i = 0; i < flat.size(); ++i) flat[i] = 1.0 + static_cast<double>(i);
  std::vector<std::vector<double>> by_term;
  ConstraintRows::Size(view, &by_term);
  rows.Spread(flat.data(), &by_term);
  EXPECT_EQ(by_term[0][0], 0.0);
  EXPECT_EQ(by_term[0][2], 1.0);
  EXPECT_EQ(by_term[2][0], 3.0);
  ASSERT_TRUE(rows.Gather(by_term, back.data()));
  EXPECT_EQ(back, flat);
  EXPECT_FALSE(rows.Gather({}, back.data()));
}

}  // namespace
}  // namespace touchdown::solvers
