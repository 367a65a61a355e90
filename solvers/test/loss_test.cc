// SPDX-License-Identifier: BSD-3-Clause
// Losses: derivatives, residuals, convexity, smooth joints.

#include "touchdown/solvers/problem/loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "touchdown/solvers/problem/window_term.h"

namespace touchdown::solvers {
namespace {

template <class Loss>
void ExpectConsistent(const Loss& loss) {
  const double d = 1e-6;
  for (double u = -2.0; u <= 3.0; u += 0.0371) {
    const LossValue at = loss.Value(u), plus = loss.Value(u + d), minus = loss.Value(u - d);
    EXPECT_NEAR(at.drho, (plus.rho - minus.rho) / (2 * d), 1e-5);
    EXPECT_NEAR(at.d2rho, (plus.drho - minus.drho) / (2 * d), 1e-4);
    EXPECT_GE(at.d2rho, 0.0);  // both are convex
    const LossResidual r = loss.Residual(u);
    EXPECT_NEAR(r.r * r.r, 2.0 * at.rho, 1e-12);
    EXPECT_NEAR(r.r * r.dr, at.drho, 1e-9);  // the residual's gradient is the loss's
  }
}

TEST(Loss, DerivativesResidualsAndConvexity) {
  ExpectConsistent(SquareLoss(3.0));
  ExpectConsistent(HingeLoss(2.0, 0.5));
  ExpectConsistent(RangeLoss({-0.7, 0.4}, 2.0, 0.5));
  ExpectConsistent(RangeLoss({0.3, 0.3}, 2.0, 0.5));
}

TEST(Loss, LinearMayBeNegativeAndHasNoResidual) {
  const LossValue at = LinearLoss(-2.0).Value(3.0);
  EXPECT_EQ(at.rho, -6.0);
  EXPECT_EQ(at.drho, -2.0);
  EXPECT_EQ(at.d2rho, 0.0);
  EXPECT_TRUE(HasResidual<SquareLoss>);
  EXPECT_FALSE(HasResidual<LinearLoss>);
}

TEST(Loss, HingeIsTwiceContinuouslyDifferentiable) {
  const HingeLoss hinge(2.0, 0.5);
  for (const double joint : {0.0, 0.5}) {
    const LossValue below = hinge.Value(joint - 1e-12), above = hinge.Value(joint + 1e-12);
    EXPECT_NEAR(below.rho, above.rho, 1e-10);
    EXPECT_NEAR(below.drho, above.drho, 1e-10);
    EXPECT_NEAR(below.d2rho, above.d2rho, 1e-10);
  }
  EXPECT_TRUE(std::isnan(hinge.Value(std::nan("")).rho));
}

TEST(Loss, RefusesBadParameters) {
  EXPECT_THROW(SquareLoss(-1.0), std::invalid_argument);
  EXPECT_THROW(SquareLoss(std::nan("")), std::invalid_argument);
  EXPECT_THROW(HingeLoss(1.0, 0.0), std::invalid_argument);
  EXPECT_THROW(LinearLoss(std::nan("")), std::invalid_argument);
  EXPECT_THROW(RangeLoss({1.0, 0.5}, 1.0, 1.0), std::invalid_argument);
  EXPECT_THROW(RangeLoss({0.0, std::nan("")}, 1.0, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::solvers
