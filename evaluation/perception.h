// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "touchdown/estimation/pad_filter.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/persistent_map.h"
#include "touchdown/sim/depth_camera.h"
#include "touchdown/sim/gps.h"
#include "touchdown/sim/sample_clock.h"
#include "touchdown/sim/tag_sensor.h"
#include "touchdown/sim/world.h"

namespace touchdown::evaluation {

/// The vehicle's senses in a simulated world: GPS of the pad, tag camera, depth camera, and what is
/// made of them, the pad filter and the obstacle map with its memory.
class Perception {
 public:
  /// `world` only gives the configuration and the start. Every sensor has its own stream of `seed`.
  /// `keep_changes`: the map's changes are kept for TakeMapChanges.
  /// @throws std::invalid_argument naming the file if map.prior cannot be used.
  Perception(const Scenario& scenario, const sim::World& world, std::uint64_t seed,
             bool keep_changes);

  /// Takes the measurements that are due at the world's time. Call once per physics step.
  void Sense(const sim::World& world);

  const estimation::PadFilter& pad_filter() const { return pad_filter_; }
  const planning::OccupancyMap& map() const { return map_; }

  /// A GPS fix or a sighting was taken in the last call of Sense.
  bool pad_measured() const { return pad_measured_; }

  /// Cells that changed since the last call, in order; none unless they are kept.
  std::vector<planning::CellFlip> TakeMapChanges();

  /// Hands over all that was ever observed; the last call.
  planning::PersistentMap TakePersistentMap();

  double sensing_cpu_s() const {
    return sensing_cpu_s_;
  }  ///< simulating sensors and the pad filter
  double mapping_cpu_s() const { return mapping_cpu_s_; }  ///< fusing depth into the map

 private:
  planning::ExcludedVolume PadVolume(double t) const;
  void KeepFlips();

  sim::PadGps gps_;
  sim::TagSensor tags_;
  sim::DepthCamera depth_;
  sim::SampleClock depth_clock_;
  estimation::PadFilter pad_filter_;
  planning::OccupancyMap map_;
  planning::PersistentMap persistent_map_;
  estimation::DepthFrame frame_;
  std::vector<planning::CellFlip> changes_;
  double deck_half_diagonal_;
  double deck_height_;
  bool keep_changes_;
  bool pad_measured_ = false;
  double sensing_cpu_s_ = 0.0;
  double mapping_cpu_s_ = 0.0;
};

}  // namespace touchdown::evaluation
