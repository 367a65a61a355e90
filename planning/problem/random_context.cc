// SPDX-License-Identifier: BSD-3-Clause
// Landings that no scenario has, in which every part of every term acts.

#include "planning/problem/random_context.h"

#include <cmath>

#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

double Uniform(std::mt19937_64& random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}

Vector3d Vector(std::mt19937_64& random, double size) {
  const double x = Uniform(random, -size, size), y = Uniform(random, -size, size);
  const double z = Uniform(random, -size, size);
  return {x, y, z};
}

/// A pad on a circular arc.
estimation::PadState OnArc(const Vector3d& centre, double radius, double rate, double t) {
  const double angle = rate * t;
  const Vector3d out(std::cos(angle), std::sin(angle), 0.0), along(-out.y(), out.x(), 0.0);
  estimation::PadState s;
  s.p_WP = centre + radius * out;
  s.v_WP = radius * rate * along;
  s.a_WP = -radius * rate * rate * out;
  s.j_WP = -radius * rate * rate * rate * along;
  s.v_WP.z() = 0.2;  // as on a swell
  s.a_WP.z() = -0.3;
  s.yaw = angle;
  s.yaw_rate = rate;
  return s;
}

}  // namespace

estimation::PadState RandomContext::Pad::At(double t) const noexcept {
  const double dt = t - t_reference;
  estimation::PadState s = state;
  s.p_WP += dt * (state.v_WP + dt / 2.0 * (state.a_WP + dt / 3.0 * state.j_WP));
  s.v_WP += dt * (state.a_WP + dt / 2.0 * state.j_WP);
  s.a_WP += dt * state.j_WP;
  s.yaw += dt * state.yaw_rate;
  return s;
}

RandomContext::RandomContext(int segments, int max_pairs, int max_obstacles,
                             std::mt19937_64& random) {
  // One draw to a statement: the order of evaluation within an expression is the compiler's.
  const double radius = Uniform(random, 2.0, 6.0);
  const double rate = Uniform(random, -0.4, 0.4);
  const Vector3d centre = Vector(random, 2.0) - radius * Vector3d::UnitX();
  context_.segments = segments;
  context_.interval = Uniform(random, 0.2, 0.5);
  context_.t0 = Uniform(random, 0.0, 3.0);
  pad_.t_reference = context_.t0 + 0.5 * segments * context_.interval;
  pad_.state = OnArc(centre, radius, rate, pad_.t_reference);
  context_.start.p = Vector(random, 3.0) + 2.0 * Vector3d::UnitZ();
  context_.start.v = Vector(random, 3.0);
  context_.start.a = Vector(random, 6.0);
  context_.pad = &pad_;
  const double height = Uniform(random, 1.0, 3.0);
  const double sink_rate = Uniform(random, 0.0, 0.2);
  const double arrival_sink = Uniform(random, 0.0, 0.5);
  context_.target = {context_.t0, height, sink_rate, 0.1, arrival_sink};

  // The previous plan began a little earlier and ends before this one.
  const double T = segments * context_.interval;
  SplineState from = context_.start, to = context_.End(context_.interval).state;
  from.p += Vector(random, 0.3);
  to.p += Vector(random, 0.3);
  const double earlier = 0.1 * T, duration = 0.8 * T;
  previous_ = UniformBspline(HermiteControlPoints(from, to, segments, duration),
                             duration / segments, context_.t0 - earlier);
  context_.previous = &previous_;

  const Vector3d gap = to.p - from.p;
  for (int i = 0; i < max_obstacles; ++i) {
    MovingObstacle obstacle;
    obstacle.t_reference = context_.t0;
    const double share = Uniform(random, 0.2, 0.8);
    obstacle.p_WO = from.p + share * gap + Vector(random, 1.0);
    obstacle.v_WO = Vector(random, 1.0);
    obstacle.semi_axes = Vector3d::Constant(1.2) + Vector(random, 0.6);
    obstacles_.push_back(obstacle);
  }
  context_.obstacles = obstacles_;
  for (int i = 0; i < max_pairs; ++i) {
    const int control_point = i % (segments + 3);
    const Vector3d p = from.p + control_point / (segments + 3.0) * gap + Vector(random, 0.5);
    const Vector3d out = Vector(random, 1.0).normalized();
    pairs_.push_back({control_point, p, out});
  }
  context_.pairs = pairs_;
  context_.pull_W = Vector(random, 2.0);
}

}  // namespace touchdown::planning
