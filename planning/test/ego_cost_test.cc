// SPDX-License-Identifier: BSD-3-Clause
// Costs of the EGO-Planner baseline against differences.
#include "planning/baselines/ego/ego_cost.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

class Cost : public ::testing::Test {
 protected:
  ControlPoints Points(int n, double spread) {
    std::uniform_real_distribution<double> u(-spread, spread);
    ControlPoints q(3, n);
    for (int i = 0; i < n; ++i) q.col(i) = Vector3d{0.4 * i + u(engine_), u(engine_), u(engine_)};
    return q;
  }

  /// The gradient against central differences, and its weight.
  void Check(const ControlPoints& q,
             const std::function<double(const ControlPoints&, double, ControlPoints*)>& cost) {
    ControlPoints gradient = ControlPoints::Zero(3, q.cols());
    const double value = cost(q, 2.5, &gradient);
    EXPECT_GT(value, 0.0);
    ControlPoints ignored = gradient;
    const double step = 1e-6;
    for (int i = 0; i < q.cols(); ++i) {
      for (int c = 0; c < 3; ++c) {
        ControlPoints above = q, below = q;
        above(c, i) += step;
        below(c, i) -= step;
        const double slope =
            (cost(above, 1.0, &ignored) - cost(below, 1.0, &ignored)) / (2.0 * step);
        EXPECT_NEAR(gradient(c, i), 2.5 * slope, 1e-6 * std::max(1.0, std::abs(slope)));
      }
    }
  }

  std::mt19937 engine_{7};
};

TEST_F(Cost, SmoothnessHasItsGradient) { Check(Points(12, 0.3), EgoSmoothness); }

TEST_F(Cost, CollisionHasItsGradientInBothBranches) {
  const ControlPoints q = Points(12, 0.3);
  SurfacePairs pairs(12);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 2; ++k) {
      const Vector3d v = Vector3d{u(engine_), u(engine_), u(engine_)}.normalized();
      // From free by more than the clearance to a metre inside.
      pairs[i].push_back({q.col(i) - u(engine_) * v, v});
    }
  }
  // Ends are fixed: their pairs cost nothing.
  Check(q, [&](const ControlPoints& x, double weight, ControlPoints* g) {
    return EgoCollision(x, pairs, 0.5, weight, g);
  });
  ControlPoints gradient = ControlPoints::Zero(3, 12);
  EgoCollision(q, pairs, 0.5, 1.0, &gradient);
  EXPECT_TRUE(gradient.leftCols(3).isZero());
  EXPECT_TRUE(gradient.rightCols(3).isZero());
}

TEST_F(Cost, CollisionIsSmoothWhereItsBranchesMeet) {
  ControlPoints q = ControlPoints::Zero(3, 7);
  SurfacePairs pairs(7);
  pairs[3] = {{Vector3d::Zero(), Vector3d::UnitX()}};
  ControlPoints below = ControlPoints::Zero(3, 7), above = below;
  q(0, 3) = 1e-9;
  const double cubic = EgoCollision(q, pairs, 0.5, 1.0, &below);
  q(0, 3) = -1e-9;
  const double quadratic = EgoCollision(q, pairs, 0.5, 1.0, &above);
  EXPECT_NEAR(cubic, 0.125, 1e-8);
  EXPECT_NEAR(quadratic, cubic, 1e-8);
  EXPECT_NEAR(below(0, 3), above(0, 3), 1e-7);
}

TEST_F(Cost, FeasibilityHasItsGradient) {
  Check(Points(12, 0.3), [](const ControlPoints& q, double weight, ControlPoints* g) {
    return EgoFeasibility(q, 0.24, 1.5, 2.0, weight, g);
  });
  ControlPoints slow(3, 8), gradient = ControlPoints::Zero(3, 8);
  for (int i = 0; i < 8; ++i) slow.col(i) = Vector3d(0.1 * i, 0, 0);
  EXPECT_EQ(EgoFeasibility(slow, 0.24, 2.0, 3.0, 1.0, &gradient), 0.0);
}

TEST_F(Cost, FitnessHasItsGradient) {
  const ControlPoints q = Points(12, 0.3);
  std::vector<Vector3d> reference;
  for (int i = 0; i < 10; ++i) reference.emplace_back(0.4 * i + 0.3, 0.1 * i, 0.02 * i * i);
  Check(q, [&](const ControlPoints& x, double weight, ControlPoints* g) {
    return EgoFitness(x, reference, weight, g);
  });
}

}  // namespace
}  // namespace touchdown::planning
