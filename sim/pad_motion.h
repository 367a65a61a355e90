// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "touchdown/estimation/pad_prediction.h"

namespace touchdown::sim {

/// Path of the pad, driven at constant speed with the pad's x axis along the direction of travel.
struct PadMotionConfig {
  enum class Kind {
    kStatic,        ///< stands at p_start
    kLine,          ///< straight on for ever
    kCircle,        ///< radius speed / |turn_rate|, to the left for a positive turn_rate
    kStraightTurn,  ///< straight, one turn by turn_angle, straight
  };
  Kind kind = Kind::kStraightTurn;
  Eigen::Vector3d p_start = {0.0, 0.0, 0.3};  ///< centre of the deck's upper face at phase 0 [m]
  double heading = 0.0;                       ///< direction of travel at phase 0 [rad]
  double speed = 0.8;                         ///< [m/s], in [0, 20]
  double turn_rate = 0.15;  ///< circle: its rate, signed; straight_turn: magnitude [rad/s]
  double turn_start = 8.0;  ///< straight_turn: driven before the turn begins [m], >= 0
  double turn_angle = 1.5707963267948966;  ///< straight_turn: signed, left positive [rad]
  double turn_ramp_s = 0.5;  ///< straight_turn: time in which the yaw rate builds up [s], > 0
  double phase = 0.0;        ///< metres driven along the path before t = 0 [m]
};

/// Where the pad's drive is commanded to be: a pure function of time.
class PadMotion {
 public:
  /// Throws std::invalid_argument naming the key, its value and the allowed range.
  explicit PadMotion(const PadMotionConfig& config);

  /// State at time t [s], any finite t, also negative. v, a, j are the exact derivatives of p; all
  /// of them are continuous. The yaw is not wrapped, so that it is continuous too. cov_p is zero.
  /// Does not allocate.
  estimation::PadState At(double t) const noexcept;

  const PadMotionConfig& config() const { return config_; }

 private:
  /// Piece of the path whose curvature goes from k0 to k1.
  struct Segment {
    double s0 = 0.0;                               ///< arc length at its beginning [m]
    double length = 0.0;                           ///< [m]; the last one goes on for ever
    double k0 = 0.0;                               ///< curvature at its beginning [1/m]
    double k1 = 0.0;                               ///< and at its end
    Eigen::Vector2d p0 = Eigen::Vector2d::Zero();  ///< where it begins
    double yaw0 = 0.0;                             ///< heading there
  };
  struct PathPoint {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    double yaw = 0.0;
    double curvature = 0.0;        ///< [1/m]
    double curvature_slope = 0.0;  ///< by arc length [1/m^2]
  };
  static PathPoint PointOn(const Segment& segment, double s) noexcept;
  void Append(double length, double k0, double k1);

  PadMotionConfig config_;
  std::array<Segment, 5> segments_;
  std::size_t count_ = 0;
};

/// The pad's future known exactly: the oracle of tests and studies.
class OraclePadPrediction final : public estimation::PadPrediction {
 public:
  explicit OraclePadPrediction(const PadMotion& motion) : motion_(motion) {}
  estimation::PadState At(double t) const noexcept override { return motion_.At(t); }

 private:
  PadMotion motion_;
};

}  // namespace touchdown::sim
