// SPDX-License-Identifier: BSD-3-Clause
// The whole-curve check against dense sampling of random curves in random maps.

#include "touchdown/planning/certify/curve_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planning/test/small_map.h"

namespace touchdown::planning {
namespace {

/// Random single cells and pillars.
void Scatter(Draw* draw, int pillars, OccupancyMap* map) {
  for (int i = 0; i < pillars; ++i) {
    const double x = draw->Uniform(-2.5, 2.5), y = draw->Uniform(-2.5, 2.5);
    for (double z = -1.5; z < 1.6; z += 0.1) map->SetOccupied({x, y, z});
  }
}

TEST(CurveCheck, AgreesWithDenseSampling) {
  Draw draw(22);
  int blocked_curves = 0;
  for (int trial = 0; trial < 100; ++trial) {
    OccupancyMap map(SmallMap(0.2));
    Scatter(&draw, 6, &map);
    ControlPoints q(3, 10);
    for (int i = 0; i < 10; ++i) {
      q.col(i) = Eigen::Vector3d(-2.5 + 0.55 * i, 0.0, 0.0) + draw.Vector(0.7);
    }
    const UniformBspline curve(q, 0.3, 2.0);
    const FreeSpace space = SpaceOf(map);
    std::vector<BlockedRun> runs;
    FindBlockedRuns(curve, 2.0, space, &runs);
    blocked_curves += !runs.empty();
    EXPECT_EQ(runs.empty(), std::isinf(FirstBlockedTime(curve, 2.0, space)));
    for (double t = 2.0; t <= curve.t_end(); t += 0.0005) {
      if (!space.Blocked(curve.Evaluate(t).p_WB)) continue;
      const bool covered = std::any_of(runs.begin(), runs.end(), [&](const BlockedRun& run) {
        return t >= run.t_in && t <= run.t_out;
      });
      // Chords leave the curve by up to 2 mm, so a cell clipped by less may be missed on it.
      const Eigen::Vector3d p = curve.Evaluate(t).p_WB;
      bool deep = true;
      for (int c = 0; c < 6; ++c) {
        Eigen::Vector3d near = p;
        near[c / 2] += c % 2 ? 0.003 : -0.003;
        deep = deep && space.Blocked(near);
      }
      EXPECT_TRUE(covered || !deep) << "trial " << trial << " t " << t;
    }
  }
  EXPECT_GT(blocked_curves, 20);
}

}  // namespace
}  // namespace touchdown::planning
