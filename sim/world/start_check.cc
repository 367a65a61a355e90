// SPDX-License-Identifier: BSD-3-Clause
// A start is accepted if the cylinder that holds the vehicle touches nothing. Obstacles and pad are
// checked by FCL, the ground by the cylinder's lowest point in closed form.

#include "sim/world/start_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "estimation/base/argument_check.h"
#include "sim/obstacles/true_clearance.h"

namespace touchdown::sim {
namespace {

void CheckState(const estimation::VehicleState& start) {
  const bool finite = start.p_WB.allFinite() && start.v_WB.allFinite() &&
                      start.q_WB.coeffs().allFinite() && start.w_WB_B.allFinite();
  if (!finite) throw std::invalid_argument("start state: not finite; allowed are finite numbers");
  estimation::CheckWithin("start state: norm of q_WB", start.q_WB.norm(), 1.0 - 1e-6, 1.0 + 1e-6);
}

}  // namespace

void CheckStart(const WorldConfig& config, const estimation::VehicleModel& model) {
  const estimation::PadState pad = CourseOf(config)->At(0.0);
  Validate(config.pad, pad.p_WP.z());
  CheckState(config.start);
  const Clearance obstacle = TrueClearance(config.obstacles, model).Nearest(config.start);
  if (obstacle.distance <= 0.0) {
    estimation::ThrowOutOfRange(
        "start: distance of the vehicle to obstacle " + std::to_string(obstacle.obstacle) + " [m]",
        obstacle.distance, "> 0");
  }
  const ObstacleField pad_boxes({DeckBox(config.pad, pad), PadBodyBox(config.pad, pad)});
  const double to_pad = TrueClearance(pad_boxes, model).Distance(config.start);
  if (to_pad <= 0.0)
    estimation::ThrowOutOfRange("start: distance of the vehicle to the pad [m]", to_pad, "> 0");
  // Lowest point of the hull cylinder: its lower rim, or the upper one when upside down.
  const double upright = config.start.q_WB.toRotationMatrix()(2, 2);
  const double rim = model.hull_radius * std::sqrt(std::max(0.0, 1.0 - upright * upright));
  const double depth = std::max(upright * model.foot_depth, -upright * model.hull_top) + rim;
  const double height = config.start.p_WB.z() - depth;
  if (height <= 0.0)
    estimation::ThrowOutOfRange("start: height above the ground [m]", height, "> 0");
}

}  // namespace touchdown::sim
