// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "touchdown/estimation/pad_filter.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/persistent_map.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/sim/depth_camera.h"
#include "touchdown/sim/gps.h"
#include "touchdown/sim/sample_clock.h"
#include "touchdown/sim/tag_sensor.h"
#include "touchdown/sim/world.h"

namespace touchdown::evaluation {

/// The map that a scenario's planner asks.
planning::OccupancyMapOptions MapOptions(const Scenario& scenario);

/// What one depth image cost, from the sensors' simulation to the map.
struct FrameTimes {
  planning::StageTimes::Span sense{"sense"}, map{"map"};
};

/// The vehicle's senses in a simulated world: GPS of the pad, tag camera, depth camera, and what is
/// made of them, the pad filter and the obstacle map with its memory.
class Perception {
 public:
  /// `world` only gives the configuration and the start. Every sensor has its own stream of `seed`.
  /// @throws std::invalid_argument naming the file if map.prior cannot be used.
  Perception(const Scenario& scenario, const sim::World& world, std::uint64_t seed);

  /// Takes the measurements that are due at the world's time. Call once per physics step.
  void Sense(const sim::World& world);

  const estimation::PadFilter& pad_filter() const { return pad_filter_; }
  const planning::OccupancyMap& map() const { return map_; }

  /// A GPS fix or a sighting was taken in the last call of Sense.
  bool pad_measured() const { return pad_measured_; }

  /// A depth image was taken and fused in the last call of Sense, and what that cost.
  bool image_taken() const { return image_taken_; }
  const FrameTimes& frame_times() const { return frame_times_; }

  /// Hands over all that was ever observed; the last call.
  planning::PersistentMap TakePersistentMap();

  double sensing_cpu_s() const {
    return sensing_cpu_s_;
  }  ///< simulating sensors and the pad filter
  double mapping_cpu_s() const { return mapping_cpu_s_; }  ///< fusing depth into the map

 private:
  void SenseAt(double t, const estimation::VehicleState& vehicle, const estimation::PadState& pad);
  void UpdateMap(double t, const estimation::VehicleState& vehicle, double hull_radius);
  planning::ExcludedVolume PadVolume(double t) const;

  sim::PadGps gps_;
  sim::TagSensor tags_;
  sim::DepthCamera depth_;
  sim::SampleClock depth_clock_;
  estimation::PadFilter pad_filter_;
  planning::OccupancyMap map_;
  planning::PersistentMap persistent_map_;
  estimation::DepthFrame frame_;
  double deck_half_diagonal_;
  double deck_height_;
  bool pad_measured_ = false;
  bool image_taken_ = false;
  FrameTimes frame_times_;
  double sensing_cpu_s_ = 0.0;
  double mapping_cpu_s_ = 0.0;
};

}  // namespace touchdown::evaluation
