// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/pad/waypoint_drive.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::sim {

/// Path of the pad and how it is driven, with the pad's x axis along the path.
struct PadMotionConfig {
  enum class Kind {
    kStraightTurn,  ///< straight, one turn by turn_angle, straight
    kCircle,        ///< radius speed / |turn_rate|, to the left for a positive turn_rate
    kLine,          ///< straight on for ever
    kStatic,        ///< stands at p_start
    kFigureEight,   ///< from the end of a loop, where the turn rate is turn_rate
    kStopAndGo,     ///< straight, for go_time at speed, then standing for stop_time, and so on
    kReversing,     ///< straight, for go_time forwards, then as long backwards, and so on
    kRandom,        ///< turns and speeds drawn from seed
    kWaypoints,     ///< past `waypoints`; p_start, heading and speed are not used
  };
  Kind kind = Kind::kStraightTurn;
  Eigen::Vector3d p_start = {0.0, 0.0, 0.3};  ///< centre of the deck's upper face at phase 0 [m]
  double heading = 0.0;                       ///< direction of travel at phase 0 [rad]
  double speed = 0.8;                         ///< [m/s], in [0, 20]; of a changing one the greatest
  double turn_rate = 0.15;  ///< circle, figure_eight: signed; straight_turn, random: the greatest
                            ///< magnitude [rad/s]
  double turn_start = 8.0;  ///< straight_turn: driven before the turn begins [m], >= 0
  double turn_angle = 1.5707963267948966;  ///< straight_turn: signed, left positive [rad]
  double turn_ramp_s = 0.5;  ///< straight_turn: time in which the yaw rate builds up [s], > 0
  /// stop_and_go, reversing: times, with half a change of speed at both ends [s].
  double go_time = 8.0;
  double stop_time = 5.0;
  double acceleration =
      0.5;                 ///< of changing speeds; random, waypoints: across the path too [m/s^2]
  double jerk = 1.0;       ///< random, waypoints: the greatest [m/s^3]
  std::uint64_t seed = 0;  ///< random: of its draws
  std::vector<PadWaypoint> waypoints;
  /// Metres driven along the path before t = 0, at `speed`. Not of waypoints.
  double phase = 0.0;
};

/// The motions of the library.
class PadMotion final : public PathCourse {
 public:
  /// Throws std::invalid_argument naming the key, its value and the allowed range.
  explicit PadMotion(const PadMotionConfig& config);
};

}  // namespace touchdown::sim
