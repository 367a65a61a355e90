// SPDX-License-Identifier: BSD-3-Clause
// Sensors at their own rates feed the pad filter and the map. The pad vehicle is left out of the
// map by a cylinder about its estimated position that grows with the estimate's doubt: else the
// goal of the flight would be an obstacle.
#include "touchdown/evaluation/perception.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "touchdown/evaluation/map_file.h"
#include "touchdown/planning/stage_timer.h"
#include "touchdown/solvers/thread_clock.h"

namespace touchdown::evaluation {
namespace {

constexpr double kVolumeMargin = 0.3;    // around and above the deck [m]
constexpr double kVolumeSigmas = 2.0;    // of the estimate, added to the radius
constexpr double kVolumeSigmaMax = 1.0;  // no more doubt than this is covered [m]

estimation::PadFilterOptions FilterOptions(const Scenario& scenario) {
  estimation::PadFilterOptions options;
  options.model = scenario.pad_estimator == PadEstimatorKind::kPaper
                      ? estimation::PadModel::kPaper
                      : estimation::PadModel::kTurnRate;
  options.pad_height = scenario.pad.deck_height;
  return options;
}

sim::TagSensorConfig TagConfig(const Scenario& scenario) {
  sim::TagSensorConfig config;
  config.rate_hz = scenario.tag_rate;
  return config;
}

}  // namespace

planning::OccupancyMapOptions MapOptions(const Scenario& scenario) {
  planning::OccupancyMapOptions options;
  options.inflation_radius = scenario.planning.clearance;
  return options;
}

Perception::Perception(const Scenario& scenario, const sim::World& world, std::uint64_t seed)
    : gps_({scenario.gps.sigma, scenario.gps.rate}, seed),
      tags_(TagConfig(scenario), world.config().obstacles, seed),
      depth_(sim::DepthCameraConfig{}, world.config().obstacles, world.config().pad, seed),
      depth_clock_(scenario.depth_rate),
      pad_filter_(FilterOptions(scenario)),
      map_(MapOptions(scenario)),
      persistent_map_(map_.options()),
      deck_half_diagonal_(scenario.pad.deck_size * std::sqrt(0.5)),
      deck_height_(scenario.pad.deck_height) {
  if (scenario.map_prior == "none") return;
  ReadMapFile(scenario.map_prior, &persistent_map_);
  map_.Recentre(world.vehicle().p_WB);
  persistent_map_.Refill(&map_);
}

void Perception::Sense(const sim::World& world) {
  const double begin = solvers::ThreadCpuSeconds();
  const double t = world.time();
  const estimation::VehicleState vehicle = world.vehicle();
  image_taken_ = depth_clock_.Due(t);
  if (image_taken_) frame_times_ = {};
  SenseAt(t, vehicle, world.pad());
  const double sensed = solvers::ThreadCpuSeconds();
  sensing_cpu_s_ += sensed - begin;
  if (!image_taken_) return;
  {
    const planning::StageTimer timer(&frame_times_.map);
    UpdateMap(t, vehicle, world.model().hull_radius);
  }
  mapping_cpu_s_ += solvers::ThreadCpuSeconds() - sensed;
}

void Perception::SenseAt(double t, const estimation::VehicleState& vehicle,
                         const estimation::PadState& pad) {
  // Steps without an image are over at once; of them there is no span.
  std::optional<planning::StageTimer> timer;
  if (image_taken_) timer.emplace(&frame_times_.sense);
  pad_measured_ = false;
  if (const auto fix = gps_.Poll(t, pad)) {
    pad_filter_.AddGps(*fix);
    pad_measured_ = true;
  }
  if (const auto sighting = tags_.Poll(t, vehicle, pad)) {
    pad_filter_.AddSighting(*sighting, vehicle);
    pad_measured_ = true;
  }
  if (image_taken_) depth_.Capture(vehicle, pad, &frame_);
}

void Perception::UpdateMap(double t, const estimation::VehicleState& vehicle, double hull_radius) {
  persistent_map_.Recentre(vehicle.p_WB, &map_);
  const planning::ExcludedVolume volume = PadVolume(t);
  map_.MarkOwnVolume(vehicle.p_WB, hull_radius);
  map_.Clear(volume);
  map_.Integrate(frame_, volume);
}

planning::ExcludedVolume Perception::PadVolume(double t) const {
  planning::ExcludedVolume volume;
  if (!pad_filter_.initialized()) return volume;
  volume.centre = pad_filter_.Estimate(t).p_WP.head<2>();
  volume.radius = deck_half_diagonal_ + kVolumeMargin +
                  kVolumeSigmas * std::min(pad_filter_.PositionSigma(t), kVolumeSigmaMax);
  volume.top = deck_height_ + kVolumeMargin;
  return volume;
}

planning::PersistentMap Perception::TakePersistentMap() {
  persistent_map_.Flush(&map_);
  return std::move(persistent_map_);
}

}  // namespace touchdown::evaluation
