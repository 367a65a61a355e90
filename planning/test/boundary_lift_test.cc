// SPDX-License-Identifier: BSD-3-Clause
// The lift's derivatives with respect to the knot interval, over a pad whose snap is zero: then they are complete.
#include "touchdown/planning/spline/boundary_lift.h"

#include <vector>

#include <gtest/gtest.h>

#include "touchdown/planning/replan/goal.h"

namespace touchdown::planning {
namespace {

TEST(BoundaryLift, DerivativesMatchDifferences) {
  const MovingGoal pad([](const Taylor& t) {
    return MovingGoal::Position{1.0 + 0.8 * t + 0.1 * t * t + 0.03 * t * t * t,
                                2.0 - 0.3 * t - 0.02 * t * t * t, 0.5 + 0.05 * t * t};
  });
  SplineState start;
  start.p = {0.0, 0.5, 2.0};
  start.v = {1.0, -0.5, 0.2};
  start.a = {0.3, 0.4, -0.6};
  constexpr int kSegments = 9;
  constexpr double h = 0.4, d = 1e-5;
  for (const bool free_acceleration : {false, true}) {
    BoundaryLift lift(kSegments, free_acceleration);
    lift.Set(start, 0.7, pad, EndpointTarget{0.0, 2.0, 0.1, 0.2, 0.3});
    const std::size_t size = 3 * (kSegments + 3);
    std::vector<double> l(size), dl(size), d2l(size), lo(size), dlo(size), hi(size), dhi(size);
    lift.At(h, l.data(), dl.data(), d2l.data());
    lift.At(h - d, lo.data(), dlo.data(), nullptr);
    lift.At(h + d, hi.data(), dhi.data(), nullptr);
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_NEAR((hi[i] - lo[i]) / (2 * d), dl[i], 1e-6) << free_acceleration << ' ' << i;
      EXPECT_NEAR((dhi[i] - dlo[i]) / (2 * d), d2l[i], 1e-5) << free_acceleration << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace touchdown::planning
