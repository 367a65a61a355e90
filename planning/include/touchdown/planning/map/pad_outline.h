// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::planning {

/// The possible source of a depth camera's return.
enum class ReturnKind : std::uint8_t {
  kObstacle,  ///< not from the pad
  kPad,       ///< the pad is surely there
  kDoubtful,  ///< the pad may be there
};

/// The estimated pad vehicle at one moment: a square deck with all that is below it.
struct PadOutline {
  Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();  ///< centre of the deck's upper face in W [m]
  double yaw = 0.0;                                ///< of the deck [rad]
  double half_size = 0.0;                          ///< half the deck's side [m]; 0: there is no pad
  double sigma = 0.0;                              ///< 1 sigma of the horizontal position [m]

  /// The source of a return at p_W, where `tolerance` [m] is the return's own error. The pad grown
  /// by kSigmas of its position explains it. If that growth is more than kSure the answer is in
  /// doubt. Does not allocate.
  ReturnKind Classify(const Eigen::Vector3d& p_W, double tolerance) const;

  /// Known so well that no return is in doubt.
  bool Known() const { return kSigmas * sigma <= kSure; }

  /// p_W is above or below the deck, wherever the pad is within kSigmas.
  bool SurelyOver(const Eigen::Vector3d& p_W) const;

  static constexpr double kSigmas = 3.0;
  static constexpr double kSure = 0.15;  ///< kSigmas of tags seen from 2 m, and a margin [m]
};

/// The outline of `pad`, whose covariance gives sigma.
PadOutline OutlineOf(const estimation::PadState& pad, double half_size);

/// Distance of a point from the upright line through the outline's square, 0 within it [m].
double DistanceBeside(const PadOutline& pad, const Eigen::Vector3d& p_W);

}  // namespace touchdown::planning
