// SPDX-License-Identifier: BSD-3-Clause
// The one exception in the map: the pad is no obstacle, but what stands beside it is.

#include "touchdown/planning/map/pad_outline.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

PadOutline OutlineOf(const estimation::PadState& pad, double half_size) {
  PadOutline outline;
  outline.p_WP = pad.p_WP;
  outline.yaw = pad.yaw;
  outline.half_size = half_size;
  // The trace bounds the largest eigenvalue.
  outline.sigma = std::sqrt(std::max(0.0, pad.cov_p.trace()));
  return outline;
}

double DistanceBeside(const PadOutline& pad, const Eigen::Vector3d& p_W) {
  const Eigen::Vector2d offset = (p_W - pad.p_WP).head<2>();
  const double c = std::cos(pad.yaw), s = std::sin(pad.yaw);
  const Eigen::Array2d in_P(c * offset.x() + s * offset.y(), -s * offset.x() + c * offset.y());
  return (in_P.abs() - pad.half_size).max(0.0).matrix().norm();
}

bool PadOutline::SurelyOver(const Eigen::Vector3d& p_W) const {
  PadOutline sure = *this;
  sure.half_size -= kSigmas * sigma;
  return sure.half_size > 0.0 && DistanceBeside(sure, p_W) <= 0.0;
}

ReturnKind PadOutline::Classify(const Eigen::Vector3d& p_W, double tolerance) const {
  if (half_size <= 0.0 || p_W.z() > p_WP.z() + tolerance) return ReturnKind::kObstacle;
  const double doubt = kSigmas * sigma;
  if (DistanceBeside(*this, p_W) > doubt + tolerance) return ReturnKind::kObstacle;
  return Known() ? ReturnKind::kPad : ReturnKind::kDoubtful;
}

}  // namespace touchdown::planning
