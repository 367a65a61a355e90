// SPDX-License-Identifier: BSD-3-Clause
// Gaussian wake: M. Bastankhah, F. Porte-Agel, "A new analytical model for wind-turbine wakes", Renewable Energy 70,
// 2014. It follows from conservation of momentum for any body of thrust or drag coefficient C and diameter d. At x
// downstream of the body, in a flow of speed U,
//   dU / U = (1 - sqrt(1 - C / (8 s^2))) exp(-r^2 / (2 s^2 d^2)),   s = k x / d + e,
// with k = 0.05 (a rough boundary layer) and e = 0.35. With these the root is real for C <= 0.98. The body is the box
// under the deck and the board, as a disc of the same frontal area. C = 0.9 is that of a blunt ground vehicle. The wake
// grows over the first diameter, so that nothing jumps. The deck's own boundary layer and its separation are left out.

#include "sim/air/pad_wake.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchdown::sim {
namespace {

constexpr double kDragCoefficient = 0.9;
constexpr double kGrowth = 0.05;
constexpr double kFirstWidth = 0.35;
constexpr double kLeastFlow = 1e-6;  // [m/s]

}  // namespace

Eigen::Vector3d PadWake(const PadGeometry& geometry, const estimation::PadState& pad,
                        const Eigen::Vector3d& wind_W, const Eigen::Vector3d& p_W) {
  // The flow around the pad vehicle. Only the horizontal part makes a wake.
  const Eigen::Vector2d flow = (wind_W - pad.v_WP).head<2>();
  const double speed = flow.norm();
  if (speed < kLeastFlow) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d along = flow / speed;
  const Eigen::Vector3d p_PW = p_W - pad.p_WP;
  const double x = p_PW.head<2>().dot(along);
  if (x <= 0.0) return Eigen::Vector3d::Zero();

  // Frontal area of box and board, seen along the flow.
  const Eigen::Vector2d nose(std::cos(pad.yaw), std::sin(pad.yaw));
  const double c = std::abs(along.dot(nose));
  const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
  const double height = std::max(0.0, pad.p_WP.z() - geometry.deck_thickness - geometry.ground_gap);
  const double box = 2.0 * (geometry.body_half_width * c + geometry.body_half_length * s) * height;
  const double board = 2.0 * geometry.deck_half_size * (c + s) * geometry.deck_thickness;
  const double diameter = std::sqrt(4.0 * (box + board) / std::numbers::pi);

  const double across = p_PW.head<2>().dot(Eigen::Vector2d(-along.y(), along.x()));
  const double above = p_W.z() - 0.5 * pad.p_WP.z();
  const double width = kGrowth * x / diameter + kFirstWidth;
  const double deficit = 1.0 - std::sqrt(1.0 - kDragCoefficient / (8.0 * width * width));
  const double r2 = (across * across + above * above) / (diameter * diameter);
  const double begun = std::min(1.0, x / diameter);
  const double share = begun * deficit * std::exp(-r2 / (2.0 * width * width));
  return {-share * flow.x(), -share * flow.y(), 0.0};
}

}  // namespace touchdown::sim
