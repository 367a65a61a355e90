// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include "touchdown/planning/landing_term.h"

namespace touchdown::planning {

/// A landing drawn at random with everything that a LandingContext points to: a pad on an arc, a
/// sinking endpoint, a previous plan, moving obstacles and pairs. Half of the starts are beyond the
/// limits. For derivative checks.
class RandomContext {
 public:
  RandomContext(int segments, int max_pairs, int max_obstacles, std::mt19937_64& random);
  RandomContext(const RandomContext&) = delete;
  RandomContext& operator=(const RandomContext&) = delete;

  const LandingContext& get() const { return context_; }

 private:
  /// A pad on a circular arc: its derivatives are exact.
  class Pad : public estimation::PadPrediction {
   public:
    estimation::PadState At(double t) const noexcept override;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 5.0, rate = 0.3, phase = 0.0;
  };

  Pad pad_;
  UniformBspline previous_;
  std::vector<MovingObstacle> obstacles_;
  std::vector<ObstaclePair> pairs_;
  LandingContext context_;
};

}  // namespace touchdown::planning
