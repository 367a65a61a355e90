// SPDX-License-Identifier: BSD-3-Clause
// In whitened variables the nominal Hessian is the identity, and gradients follow the change of
// variables.

#include "touchdown/solvers/backend/whitening.h"

#include <gtest/gtest.h>

#include <random>

#include "solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

/// Holds every block near zero: without it the problem leaves directions free.
struct Anchor {
  static constexpr int kBlockSize = 2, kWindow = 1, kOutputs = 2;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  int windows() const { return 9; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0];
    u[1] = q[1];
  }
};

TEST(Whitening, MakesTheNominalHessianTheIdentity) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const bool free_interval : {false, true}) {
    Problem problem({.blocks = 9, .block_size = 2, .free_interval = free_interval});
    problem.set_interval(0.8);
    problem.AddTerm(std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
                        TermInfo{"wavy", "", "", "", false}, WavyMap(7), SquareLoss(1.3), 7),
                    Role::kCost);
    problem.AddTerm(std::make_shared<WindowTerm<Anchor, SquareLoss>>(
                        TermInfo{"anchor", "", "", "", true}, Anchor(), SquareLoss(0.1), 9),
                    Role::kCost);
    const View view(problem);
    Eigen::VectorXd y(view.num_variables());
    for (double& value : y) value = normal(random);
    if (free_interval) y[y.size() - 1] = 0.8;

    Whitening white;
    white.Prepare(view);
    ViewEvaluation e;
    view.Resize(&e);
    ASSERT_TRUE(white.Set(view, y.data(), &e));

    // L^-1 H L^-T = 1 where H is the Gauss-Newton Hessian.
    const int n = view.num_variables();
    Eigen::MatrixXd H(n, n), product(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) H(i, j) = e.hessian.At(i, j);
    }
    for (int j = 0; j < n; ++j) {
      Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j), column(n);
      white.FromWhite(unit.data(), column.data());
      Eigen::VectorXd image = H * column;
      white.GradientToWhite(image.data());
      product.col(j) = image;
    }
    Eigen::MatrixXd error = product - Eigen::MatrixXd::Identity(n, n);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-9);

    Eigen::VectorXd z(n), back(n);
    white.ToWhite(y.data(), z.data());
    white.FromWhite(z.data(), back.data());
    EXPECT_LT((back - y).norm(), 1e-9 * y.norm());
    if (free_interval) {
      EXPECT_NEAR(z[n - 1], white.interval_scale() * y[n - 1], 1e-12);
    }
  }
}

}  // namespace
}  // namespace touchdown::solvers
