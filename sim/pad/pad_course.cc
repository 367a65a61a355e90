// SPDX-License-Identifier: BSD-3-Clause
// A path in arc length, s, and the way driven along it over time, s(t). With the curvature k and its
// slope k' by s, the direction d of the path and the normal n to its left:
//   v = s. d,  a = s.. d + s.^2 k n,  j = (s... - s.^3 k^2) d + (s.^3 k' + 3 s. s.. k) n.

#include "touchdown/sim/pad/pad_course.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchdown::sim {

PathCourse::PathCourse(Path path, double height, double speed, double phase)
    : path_(std::move(path)), height_(height), speed_(speed), phase_(phase) {
  Check();
}

PathCourse::PathCourse(Path path, double height, Pace pace, double t_phase)
    : path_(std::move(path)), height_(height), pace_(std::move(pace)), phase_(t_phase) {
  Check();
}

void PathCourse::Check() const {
  const auto* chain = std::get_if<CurvatureChain>(&path_);
  if (chain != nullptr && chain->empty()) {
    throw std::invalid_argument("PathCourse: the chain has no stretch");
  }
  for (const double number : {height_, speed_, phase_}) {
    if (!std::isfinite(number)) {
      throw std::invalid_argument("PathCourse: height, speed or phase is not finite");
    }
  }
}

PathPoint PathCourse::PathAt(double s) const noexcept {
  if (const auto* chain = std::get_if<CurvatureChain>(&path_)) return chain->At(s);
  return std::get_if<FigureEight>(&path_)->At(s);
}

PacePoint PathCourse::PaceAt(double t) const noexcept {
  if (!pace_) return {speed_ * t + phase_, speed_, 0.0, 0.0};
  return pace_->At(t + phase_);
}

PadMotionBounds PathCourse::bounds() const {
  const PathBounds path = std::visit([](const auto& p) { return p.bounds(); }, path_);
  const double v =
      pace_ ? std::max(std::abs(pace_->LeastSpeed()), std::abs(pace_->GreatestSpeed())) : speed_;
  const double along = pace_ ? pace_->MaxAcceleration() : 0.0;
  PadMotionBounds bounds;
  bounds.speed = v;
  bounds.acceleration = std::hypot(along, v * v * path.curvature);
  bounds.yaw_acceleration = v * v * path.curvature_slope + along * path.curvature;
  return bounds;
}

estimation::PadState PathCourse::At(double t) const noexcept {
  const PacePoint pace = PaceAt(t);
  const PathPoint point = PathAt(pace.s);
  const double v = pace.speed;
  const Eigen::Vector2d along(std::cos(point.yaw), std::sin(point.yaw));
  const Eigen::Vector2d left(-along.y(), along.x());
  estimation::PadState pad;
  pad.p_WP << point.p, height_;
  pad.v_WP.head<2>() = v * along;
  pad.a_WP.head<2>() = v * v * point.curvature * left + pace.acceleration * along;
  pad.j_WP.head<2>() =
      v * v * v * (point.curvature_slope * left - point.curvature * point.curvature * along) +
      (pace.jerk * along + 3.0 * v * pace.acceleration * point.curvature * left);
  pad.yaw = point.yaw;
  pad.yaw_rate = v * point.curvature;
  return pad;
}

}  // namespace touchdown::sim
