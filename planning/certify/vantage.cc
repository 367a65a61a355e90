// SPDX-License-Identifier: BSD-3-Clause
// A cell close above or below is out of the image, wherever the camera points. From farther away, lower or higher it
// is in the image.

#include "planning/certify/vantage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

namespace {

constexpr int kHeadings = 8;
constexpr double kBetter =
    0.1;  // nearer to the middle of the image, or it is not worth the way [rad]

}  // namespace

double OffSight(const Eigen::Vector3d& place_W, const Eigen::Vector3d& p_WB,
                const Eigen::Vector3d& pull_W) noexcept {
  const Eigen::Vector3d to = place_W - p_WB;
  const double ahead = std::max(to.head<2>().norm(), 1e-3);
  const double along = pull_W.head<2>().dot(to.head<2>()) / ahead;
  return std::abs(std::atan2(to.z(), ahead) - std::atan(along / estimation::kGravity));
}

Vantages::Vantages(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& place_W,
                   const Eigen::Vector3d& pull_W) noexcept {
  const double enough = OffSight(place_W, p_WB, pull_W) - kBetter;
  const auto off = [&](const Eigen::Vector3d& shift) {
    return OffSight(place_W, p_WB + shift, pull_W);
  };
  const auto consider = [&](const Eigen::Vector3d& direction) {
    for (const double share : {1.0, 0.5, 0.25}) {
      const Eigen::Vector3d shift = share * kFarthest * direction;
      if (off(shift) < enough) shifts_[size_++] = shift;
    }
  };
  const Eigen::Vector3d to = place_W - p_WB;
  const double ahead = std::atan2(to.y(), to.x());
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = ahead + 2.0 * std::numbers::pi * i / kHeadings;
    consider({std::cos(heading), std::sin(heading), 0.0});
  }
  consider(Eigen::Vector3d::UnitZ());
  consider(-Eigen::Vector3d::UnitZ());
  std::sort(shifts_.begin(), shifts_.begin() + size_,
            [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return off(a) < off(b); });
}

}  // namespace touchdown::planning
