// SPDX-License-Identifier: BSD-3-Clause
// Pads and random draws shared by the planning tests.
#pragma once

#include <cmath>
#include <random>

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// A pad on a circular arc (turn rate != 0) or a straight line: exact derivatives.
class ArcPad : public estimation::PadPrediction {
 public:
  ArcPad(const Eigen::Vector3d& p_WP, double speed, double yaw, double yaw_rate)
      : p_WP_(p_WP), speed_(speed), yaw_(yaw), rate_(yaw_rate) {}

  estimation::PadState At(double t) const noexcept override {
    estimation::PadState s;
    s.yaw = yaw_ + rate_ * t;
    s.yaw_rate = rate_;
    const Eigen::Vector3d along(std::cos(s.yaw), std::sin(s.yaw), 0.0);
    const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
    if (rate_ != 0.0) {
      const double r = speed_ / rate_;
      s.p_WP = p_WP_ + r * Eigen::Vector3d(std::sin(s.yaw) - std::sin(yaw_),
                                           std::cos(yaw_) - std::cos(s.yaw), 0.0);
    } else {
      s.p_WP = p_WP_ + speed_ * t * along;
    }
    s.v_WP = speed_ * along;
    s.a_WP = speed_ * rate_ * left;
    s.j_WP = -speed_ * rate_ * rate_ * along;
    return s;
  }

 private:
  Eigen::Vector3d p_WP_;
  double speed_, yaw_, rate_;
};

/// Seeded draws for property tests. Several in one expression stand in braces: between parentheses the
/// compiler chooses which comes first.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double Uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Eigen::Vector3d Vector(double size) {
    return {Uniform(-size, size), Uniform(-size, size), Uniform(-size, size)};
  }
  SplineState State(double p, double v, double a) { return {Vector(p), Vector(v), Vector(a)}; }
  ArcPad Pad() {
    const Eigen::Vector3d p{Uniform(-8.0, 8.0), Uniform(-8.0, 8.0), Uniform(0.0, 1.0)};
    const double speed = Uniform(0.0, 2.0), yaw = Uniform(-3.0, 3.0);
    return {p, speed, yaw, Uniform(0.0, 1.0) < 0.3 ? 0.0 : Uniform(-0.5, 0.5)};
  }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace touchdown::planning
