// SPDX-License-Identifier: BSD-3-Clause
// Paces are lists of knots; sim/pace smooths them. The path has the curvature k and its slope k'. The jerk of a random
// drive is (s''' - s'^3 k^2) along the path and (s'^3 k' + 3 s' s'' k) across it. Each of these four terms is kept to a
// third of the limit or less, so that the norm is within it.

#include "sim/pad/path_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/base/random_stream.h"

namespace touchdown::sim {
namespace {

struct Stretch {
  double speed = 0.0;  // [m/s]
  double time = 0.0;   // [s]
};

// Stretches in turn, for ever. At t = 0 the change to the first one's speed has ended, and the arc length is 0.
Pace Alternating(const std::vector<Stretch>& stretches, double smoothing) {
  const double early = 1.5 * smoothing;
  std::vector<Pace::Knot> knots = {{-early, -early * stretches.front().speed}};
  for (const Stretch& stretch : stretches) {
    const Pace::Knot last = knots.back();
    knots.push_back({last.t + stretch.time, last.s + stretch.time * stretch.speed});
  }
  return Pace::Periodic(knots, smoothing);
}

}  // namespace

Pace StopAndGoPace(double speed, double go_time, double stop_time, double acceleration) {
  return Alternating({{speed, go_time}, {0.0, stop_time}},
                     Pace::SmoothingFor(speed, acceleration, INFINITY));
}

Pace ReversingPace(double speed, double go_time, double acceleration) {
  return Alternating({{speed, go_time}, {-speed, go_time}},
                     Pace::SmoothingFor(2.0 * speed, acceleration, INFINITY));
}

PathDrive RandomDrive(const Eigen::Vector2d& start, double heading, const RandomDriveLimits& limits,
                      std::uint64_t seed, double until) {
  constexpr double kShare = 1.0 / 3.0;
  const double v = limits.speed;
  const double v3 = v * v * v;
  const double share = kShare * limits.jerk;
  const double sharpest =
      std::min({limits.turn_rate / v, limits.acceleration / (v * v), std::sqrt(share / v3),
                share / (3.0 * v * limits.acceleration)});
  // From one curvature to the opposite one at the most.
  const double ramp = std::max(kSteepestStep * 2.0 * sharpest * v3 / share, 0.5 * v);

  const double smoothing = Pace::SmoothingFor(v, limits.acceleration, share);
  const double end = until + 1.5 * smoothing;
  // Streams of their own, so that a longer drive begins like a shorter one.
  RandomStream turns(seed, "pad_motion"), speeds(seed, "pad_motion speed");
  CurvatureChain path(start, heading);
  double curvature = 0.0;
  path.Append(0.5 * v, 0.0, 0.0);
  while (path.length() < v * end) {
    const double next = sharpest * turns.Uniform(-1.0, 1.0);
    path.Append(ramp, curvature, next);
    path.Append(v * turns.Uniform(2.0, 8.0), next, next);
    curvature = next;
  }
  std::vector<Pace::Knot> knots = {{0.0, 0.0}};
  while (knots.back().t < end) {
    const bool stops = speeds.Uniform(0.0, 1.0) < 0.2;
    const double share_of_speed = speeds.Uniform(0.3, 1.0);
    const double time = speeds.Uniform(3.0, 8.0);
    const Pace::Knot last = knots.back();
    knots.push_back({last.t + time, last.s + (stops ? 0.0 : share_of_speed * v) * time});
  }
  return {std::move(path), Pace(std::move(knots), smoothing)};
}

}  // namespace touchdown::sim
