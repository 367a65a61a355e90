// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::estimation {

/// The pad at one instant. v, a, j are the exact time derivatives of p: an arrival time can be
/// optimised through them.
struct PadState {
  Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();   ///< centre of the deck's upper face in W [m]
  Eigen::Vector3d v_WP = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d a_WP = Eigen::Vector3d::Zero();   ///< [m/s^2]
  Eigen::Vector3d j_WP = Eigen::Vector3d::Zero();   ///< [m/s^3]
  double yaw = 0.0;                                 ///< heading of the pad's x axis in W [rad]
  double yaw_rate = 0.0;                            ///< [rad/s]
  Eigen::Matrix2d cov_p = Eigen::Matrix2d::Zero();  ///< covariance of the horizontal position [m^2]
};

/// Where the pad will be. Implemented by the pad filter's models and by the oracle of the tests
/// and studies. Immutable while a plan is made, so that it can be asked from any thread.
class PadPrediction {
 public:
  virtual ~PadPrediction() = default;

  /// State of the pad at the absolute time t [s]. Smooth in t; any finite t is allowed.
  /// Does not allocate.
  virtual PadState At(double t) const noexcept = 0;

  /// The same without a valid cov_p. A step calls this a thousand times, and the covariance is the expensive part of
  /// a belief.
  virtual PadState MeanAt(double t) const noexcept { return At(t); }

  /// There is a deck, to be landed on and not to be flown into. A goal has none.
  virtual bool has_deck() const noexcept { return true; }
};

/// Of a pad of which nothing has been said yet: NaN at all times, so that what is computed from it is no number.
const PadPrediction& UnknownPad() noexcept;

}  // namespace touchdown::estimation
