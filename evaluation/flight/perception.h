// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "evaluation/base/sensing_times.h"
#include "evaluation/flight/depth_sensor.h"
#include "evaluation/flight/own_sense.h"
#include "evaluation/flight/pad_sensor.h"
#include "sim/sensors/gps.h"
#include "sim/world/world.h"
#include "touchdown/control/onboard/onboard.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::evaluation {

/// The cost of one depth image, from the simulated camera to the map.
struct FrameTimes {
  planning::StageTimes::Span sense{"sense"}, map{"map"};
};

/// The vehicle's sensors in a simulated world: own state, GPS of the pad, downward camera, depth camera. Their
/// measurements go to an Onboard. The cameras see from the vehicle's true pose. Belongs to the thread that made it.
class Perception {
 public:
  /// `world` only gives the configuration. Every sensor has its own stream of `seed`.
  /// @throws std::runtime_error if there is no off-screen rendering for `sensing: rendered`.
  Perception(const Scenario& scenario, const sim::World& world, std::uint64_t seed);

  /// The time before the flight, in which it hovers at its start.
  void Hover(const sim::World& world, control::Onboard* onboard);

  /// Takes the images that are due at the world's time and passes on the measurements that arrive then. Call once per
  /// physics step.
  void Sense(const sim::World& world, control::Onboard* onboard);

  /// A GPS fix or a sighting came to the pad filter in the last call of Sense.
  bool pad_measured() const { return pad_measured_; }

  /// A depth image arrived in the last call of Sense, and what that cost.
  bool image_taken() const { return !frame_times_.empty(); }
  const std::vector<FrameTimes>& frame_times() const { return frame_times_; }

  /// Simulating sensors, and the filters.
  double sensing_cpu_s() const { return sensing_cpu_s_; }
  const SensingTimes& sensing_times() const { return sensing_times_; }  ///< a part of that
  double mapping_cpu_s() const { return mapping_cpu_s_; }  ///< fusing depth into the map

 private:
  void SenseOwn(const estimation::VehicleState& vehicle, control::Onboard* onboard);
  void SensePad(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                control::Onboard* onboard);
  void SenseDepth(const estimation::VehicleState& vehicle, control::Onboard* onboard);

  OwnSense own_;
  sim::PadGps gps_;
  std::unique_ptr<PadSensor> pad_sensor_;
  std::vector<std::unique_ptr<DepthSensor>> depth_sensors_;
  estimation::DepthImage image_;
  std::optional<sim::ObstacleField> truth_;  // stands in for what the depth camera sees free
  bool pad_measured_ = false;
  std::vector<FrameTimes> frame_times_;  ///< of the depth images of this step
  double sensing_cpu_s_ = 0.0;
  SensingTimes sensing_times_;
  double mapping_cpu_s_ = 0.0;
};

}  // namespace touchdown::evaluation
