// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

/// A landing drawn at random with everything that a LandingContext points to: a turning pad, a
/// sinking endpoint, a previous plan, moving obstacles and pairs. Half of the starts are beyond the
/// limits. For derivative checks.
class RandomContext {
 public:
  RandomContext(int segments, int max_pairs, int max_obstacles, std::mt19937_64& random);
  RandomContext(const RandomContext&) = delete;
  RandomContext& operator=(const RandomContext&) = delete;

  const LandingContext& get() const { return context_; }

 private:
  /// A pad whose position is cubic in time: derivatives are exact, and its snap, which no prediction
  /// has, is zero.
  class Pad : public estimation::PadPrediction {
   public:
    estimation::PadState At(double t) const noexcept override;
    double t_reference = 0.0;
    estimation::PadState state;  // at t_reference
  };

  Pad pad_;
  UniformBspline previous_;
  std::vector<MovingObstacle> obstacles_;
  std::vector<ObstaclePair> pairs_;
  LandingContext context_;
};

}  // namespace touchdown::planning
