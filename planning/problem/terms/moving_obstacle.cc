// SPDX-License-Identifier: BSD-3-Clause
// Ellipsoids that move at constant velocity, evaluated at every inner knot at its own time. With
// the semi-axes s and the least of them s_min
//   u = s_min (1 - sum_c ((p_c - o_c(t)) / s_c)^2) / 2.
// It is smooth everywhere, zero on the surface, and near it about the depth. Not convex. Not
// checked between the knots: the semi-axes must include the vehicle's and the obstacle's way in one
// interval. Source: docs/formulation.md.

#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

struct InsideEllipsoid {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  std::span<const MovingObstacle> obstacles;
  int inner_knots = 0;

  int windows() const { return static_cast<int>(obstacles.size()) * inner_knots; }
  int first_block(int k) const { return 1 + k % inner_knots; }
  void Update(const LandingContext& context) {
    obstacles = context.obstacles;
    inner_knots = context.segments - 1;
  }

  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& t, T* u) const {
    const MovingObstacle& o = obstacles[k / inner_knots];
    const Triple<T> p = KnotPosition(q);
    T sum(0.0);
    for (int c = 0; c < 3; ++c) {
      const T part = (p[c] - o.p_WO[c] - o.v_WO[c] * (t - o.t_reference)) * (1.0 / o.semi_axes[c]);
      sum += part * part;
    }
    u[0] = (1.0 - sum) * (0.5 * o.semi_axes.minCoeff());
  }
};

}  // namespace

TermEntry MovingObstacleTerm() {
  TermEntry entry;
  entry.info = {"moving_obstacle", "w sum hinge(s_min (1 - sum ((p - o(t)) / s)^2) / 2)", "m",
                "docs/formulation.md", false};
  entry.parameters = {HingeWidth(0.3, "m")};
  entry.use = TermUse::kMovingObstacles;
  entry.make = [info = entry.info](const TermSetup& setup) {
    const int most = setup.max_obstacles * (setup.segments() - 1);
    return MakeLandingTerm(info, InsideEllipsoid{}, setup.Hinge(), most);
  };
  return entry;
}

}  // namespace touchdown::planning
