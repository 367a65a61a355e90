// SPDX-License-Identifier: BSD-3-Clause
// A point that flies what an Onboard commits, exactly, in a scene: sensors, pad filter, map, mission and planner are those
// of every flight; physics and tracking are left out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/playground/scene.h"
#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/pad_motion.h"
#include "sim/sensors/depth_camera.h"
#include "sim/sensors/gps.h"
#include "sim/sensors/tag_sensor.h"
#include "touchdown/control/onboard/onboard.h"

namespace touchdown::evaluation {

/// How a flight of a point ended, in a word and in a sentence.
struct PointOutcome {
  std::string name;
  std::string sentence;
};

class PointFlight {
 public:
  /// @throws std::invalid_argument as SceneFrom, Replanner and Onboard do.
  explicit PointFlight(const PlaygroundScene& scene);

  /// Flies on for some time [s], at most to its end.
  void Advance(double seconds);
  /// Walls and pillars stand elsewhere from now on. The map still has what it saw.
  void Move(const PlaygroundScene& scene);

  double time() const { return vehicle_.t; }
  const std::optional<PointOutcome>& outcome() const { return outcome_; }
  /// The least distance from the hull to an obstacle so far [m].
  double least_clearance() const { return least_clearance_; }

  /// How it stands, and what has happened since the last call: events, cells of the map, and the newest replanning step.
  nlohmann::ordered_json Report();
  /// The newest replanning step asked again and written down; null before the first.
  nlohmann::ordered_json Explain() const;

 private:
  struct Event {
    double t;
    std::string text;
  };

  void Step();
  void Sense();
  void Note();
  void MoveOn(const control::Setpoint& setpoint);
  void Judge();
  nlohmann::ordered_json MapReport();

  PlaygroundScene scene_;
  sim::ObstacleField field_;
  sim::PadMotion motion_;
  sim::DepthCamera depth_camera_;
  sim::TagSensor tag_sensor_;
  sim::PadGps gps_;
  estimation::SampleClock depth_clock_;
  estimation::SampleClock tag_clock_;
  control::Onboard onboard_;

  estimation::VehicleState vehicle_;
  long steps_ = 0;
  std::optional<Eigen::Vector3d> stands_P_;  ///< on the deck, there in P [m]
  std::optional<PointOutcome> outcome_;
  double clearance_ = 0.0;
  double least_clearance_ = 0.0;

  std::vector<Event> events_;                    ///< since the last report
  std::vector<planning::CellIndex> cells_;       ///< occupied ones, as last reported
  std::optional<control::OnboardReplan> asked_;  ///< the newest step ...
  planning::ReplannerState before_;
  planning::ReplanResult answer_;
  bool answer_is_new_ = false;
  estimation::DepthImage image_;
  estimation::DepthFrame frame_;
};

}  // namespace touchdown::evaluation
