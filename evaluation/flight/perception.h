// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "evaluation/base/sensing_times.h"
#include "evaluation/flight/depth_eye.h"
#include "evaluation/flight/own_estimate.h"
#include "evaluation/flight/pad_eye.h"
#include "evaluation/flight/pad_log.h"
#include "sim/sensors/gps.h"
#include "sim/world/world.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/map/persistent_map.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::evaluation {

/// The pad filter that a scenario flies with.
estimation::PadFilterOptions PadFilterOptionsOf(const Scenario& scenario);

/// The map that a scenario's planner asks.
planning::OccupancyMapOptions MapOptions(const Scenario& scenario,
                                         const estimation::VehicleModel& model,
                                         const Registries& registries);

/// What one depth image cost, from the simulated camera to the map.
struct FrameTimes {
  planning::StageTimes::Span sense{"sense"}, map{"map"};
};

/// The vehicle's senses in a simulated world: what tells it of itself, GPS of the pad, downward camera, depth
/// camera, and what is made of them, its own state, the pad filter and the obstacle map with its memory. The
/// cameras see from where the vehicle truly is; what they see is put where it believes itself to be.
/// Belongs to the thread that made it.
class Perception {
 public:
  /// `world` only gives the configuration and the start. Every sensor has its own stream of `seed`.
  /// @throws std::invalid_argument naming the file if map.prior cannot be used,
  /// std::runtime_error if there is no off-screen rendering for `sensing: rendered`.
  Perception(const Scenario& scenario, const sim::World& world, const Registries& registries,
             std::uint64_t seed);

  /// Keeps a copy of whatever comes to the pad filter from now on.
  void LogPadTo(std::vector<PadArrival>* log) { pad_log_ = log; }

  /// Takes the images that are due at the world's time and the measurements that arrive at it. Call once per physics step.
  void Sense(const sim::World& world);

  const OwnEstimate& own() const { return own_; }
  const estimation::PadFilter& pad_filter() const { return pad_filter_; }
  const planning::OccupancyMap& map() const { return map_; }

  /// A GPS fix or a sighting arrived in the last call of Sense.
  bool pad_measured() const { return pad_measured_; }

  /// A depth image arrived and was fused in the last call of Sense, and what that cost.
  bool image_taken() const { return image_taken_; }
  const FrameTimes& frame_times() const { return frame_times_; }

  /// Hands over all that was ever observed; the last call.
  planning::PersistentMap TakePersistentMap();

  double sensing_cpu_s() const {
    return sensing_cpu_s_;
  }  ///< simulating sensors and the pad filter
  const SensingTimes& sensing_times() const { return sensing_times_; }  ///< a part of that
  double mapping_cpu_s() const { return mapping_cpu_s_; }  ///< fusing depth into the map

 private:
  void SenseOwn(const estimation::VehicleState& vehicle);
  void SensePad(const estimation::VehicleState& vehicle, const estimation::PadState& pad);
  bool TagsGuide(double t) const;
  void UpdateMap(double t, const estimation::DepthFrame& frame);
  planning::PadOutline Outline(double t, double stamp) const;

  OwnEstimate own_;
  sim::PadGps gps_;
  std::unique_ptr<PadEye> pad_eye_;
  std::unique_ptr<DepthEye> depth_eye_;
  estimation::PadFilter pad_filter_;
  planning::OccupancyMap map_;
  planning::PersistentMap persistent_map_;
  double deck_half_size_;
  bool pad_is_obstacle_;                     // the task is another than the pad
  std::optional<sim::ObstacleField> truth_;  // stands in for what the depth camera sees free
  std::vector<PadArrival>* pad_log_ = nullptr;
  bool pad_measured_ = false;
  bool image_taken_ = false;
  FrameTimes frame_times_;
  double sensing_cpu_s_ = 0.0;
  SensingTimes sensing_times_;
  double mapping_cpu_s_ = 0.0;
};

}  // namespace touchdown::evaluation
