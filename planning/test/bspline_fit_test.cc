// SPDX-License-Identifier: BSD-3-Clause
#include "planning/baselines/ego/bspline_fit.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "planning/baselines/ego/quintic.h"

namespace touchdown::planning {
namespace {

using Eigen::Vector3d;

Quintic SomeQuintic(double T) {
  return Quintic::Between({{0, 0, 1}, {1, 0.3, 0}, {0.2, -0.1, 0}},
                          {{6, 1, 1.5}, {1.5, 0, 0.1}, {0, 0, 0}}, T);
}

TEST(Fit, ReproducesAQuinticAndItsEnds) {
  const Quintic quintic = SomeQuintic(4.0);
  SampledPath path;
  path.interval = 0.2;
  for (int k = 0; k <= 20; ++k) path.points.push_back(quintic.At(0.2 * k).p);
  const SplineState start = quintic.At(0.0), end = quintic.At(4.0);
  path.v_start = start.v;
  path.a_start = start.a;
  path.v_end = end.v;
  path.a_end = end.a;
  const UniformBspline curve(FitBspline(path), path.interval, 0.0);
  EXPECT_EQ(curve.control_points().cols(), 23);
  EXPECT_NEAR(curve.duration(), 4.0, 1e-12);
  for (double t = 0.0; t <= 4.0; t += 0.05) {
    EXPECT_LT((curve.Evaluate(t).p_WB - quintic.At(t).p).norm(), 1e-3) << t;
  }
  EXPECT_LT((curve.Evaluate(0.0).v_WB - start.v).norm(), 2e-3);
  EXPECT_LT((curve.Evaluate(4.0).v_WB - end.v).norm(), 2e-3);
}

TEST(Fit, RefusesMisuse) {
  SampledPath path;
  path.points.assign(1, Vector3d::Zero());
  path.interval = 0.2;
  EXPECT_THROW(FitBspline(path), std::invalid_argument);
  path.points.assign(5, Vector3d::Zero());
  path.interval = 0.0;
  EXPECT_THROW(FitBspline(path), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
