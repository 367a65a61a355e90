// SPDX-License-Identifier: BSD-3-Clause
// Paces are lists of knots; what smooths them is sim/pace. Of a random drive the jerk is, along and
// across the path, (s''' - s'^3 k^2) and (s'^3 k' + 3 s' s'' k), with k the curvature and k' its slope:
// each of these four shares is kept to a third of the limit or less, so that the norm is within it.

#include "touchdown/sim/path_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "touchdown/sim/random_stream.h"

namespace touchdown::sim {
namespace {

constexpr double kBefore = 10.0;  // a pace begins so long before t = 0 [s]

struct Stretch {
  double speed = 0.0;  // [m/s]
  double time = 0.0;   // [s]
};

// Stretches in turn, the first from t = 0 on; before that its speed.
Pace Alternating(const std::vector<Stretch>& stretches, double smoothing) {
  std::vector<Pace::Knot> knots = {{-kBefore, -kBefore * stretches.front().speed}, {0.0, 0.0}};
  for (std::size_t i = 0; knots.back().t < kPaceHorizon; i = (i + 1) % stretches.size()) {
    const Stretch& stretch = stretches[i];
    const Pace::Knot last = knots.back();
    knots.push_back({last.t + stretch.time, last.s + stretch.time * stretch.speed});
  }
  return Pace(std::move(knots), smoothing);
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
                     std::uint64_t seed) {
  constexpr double kShare = 1.0 / 3.0;
  constexpr double kSteepestStep = 1.5;  // of the chain's smooth step, over its mean
  const double v = limits.speed;
  const double v3 = v * v * v;
  const double share = kShare * limits.jerk;
  const double sharpest =
      std::min({limits.turn_rate / v, limits.acceleration / (v * v), std::sqrt(share / v3),
                share / (3.0 * v * limits.acceleration)});
  // From one curvature to the opposite one at the most.
  const double ramp = std::max(kSteepestStep * 2.0 * sharpest * v3 / share, 0.5 * v);

  RandomStream random(seed, "pad_motion");
  PathDrive drive{CurvatureChain(start, heading), Pace({{0.0, 0.0}, {1.0, v}}, 1.0)};
  double curvature = 0.0;
  drive.path.Append(0.5 * v, 0.0, 0.0);
  while (drive.path.length() < v * (kPaceHorizon + kBefore)) {
    const double next = sharpest * random.Uniform(-1.0, 1.0);
    drive.path.Append(ramp, curvature, next);
    drive.path.Append(v * random.Uniform(2.0, 8.0), next, next);
    curvature = next;
  }
  std::vector<Stretch> stretches;
  for (double t = 0.0; t < kPaceHorizon; t += stretches.back().time) {
    const bool stops = random.Uniform(0.0, 1.0) < 0.2;
    const double share_of_speed = random.Uniform(0.3, 1.0);
    stretches.push_back({stops ? 0.0 : share_of_speed * v, random.Uniform(3.0, 8.0)});
  }
  drive.pace = Alternating(stretches, Pace::SmoothingFor(v, limits.acceleration, share));
  return drive;
}

}  // namespace touchdown::sim
