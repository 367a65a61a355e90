// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/perception.h"

#include <utility>

#include "evaluation/judge/truth_map.h"
#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

sim::PadGpsConfig GpsConfig(const Scenario& scenario) {
  sim::PadGpsConfig config;
  config.sigma = scenario.gps.sigma;
  config.rate_hz = scenario.gps.rate;
  config.outage_begin_s = scenario.gps.outage[0];
  config.outage_end_s = scenario.gps.outage[1];
  config.outlier_probability = scenario.gps.outliers;
  config.outlier_size = scenario.gps.outlier_size;
  return config;
}

}  // namespace

Perception::Perception(const Scenario& scenario, const sim::World& world, std::uint64_t seed)
    : own_(scenario, seed),
      gps_(GpsConfig(scenario), seed),
      pad_sensor_(MakePadSensor(scenario, world.config(), seed)),
      depth_sensors_(MakeDepthSensors(scenario, world.config(), seed)) {
  if (scenario.map_observed_free == ObservedFreeKind::kTruth) truth_ = world.config().obstacles;
}

void Perception::Hover(const sim::World& world, control::Onboard* onboard) {
  own_.Hover(world.vehicle(), world.timestep(), onboard);
}

void Perception::Sense(const sim::World& world, control::Onboard* onboard) {
  const double begin = solvers::ThreadCpuSeconds();
  const estimation::VehicleState vehicle = world.vehicle();
  const estimation::PadState pad = world.pad();
  SenseOwn(vehicle, onboard);
  SensePad(vehicle, pad, onboard);
  for (const auto& sensor : depth_sensors_) sensor->Look(vehicle, pad, &sensing_times_);
  onboard->Take(world.foot_force());
  const double sensed = solvers::ThreadCpuSeconds();
  sensing_cpu_s_ += sensed - begin;
  SenseDepth(vehicle, onboard);
  if (image_taken()) mapping_cpu_s_ += solvers::ThreadCpuSeconds() - sensed;
}

void Perception::SenseOwn(const estimation::VehicleState& vehicle, control::Onboard* onboard) {
  if (!onboard->own_estimated()) return own_.Sense(vehicle, onboard);
  solvers::AddThreadCpu(&sensing_times_.own_state, [&] { own_.Sense(vehicle, onboard); });
}

void Perception::SensePad(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                          control::Onboard* onboard) {
  const double t = vehicle.t;
  pad_measured_ = false;
  // Most steps bring nothing: the clock is read only if something has arrived.
  const auto take = [this, onboard](const auto& measurement, double* time) {
    solvers::AddThreadCpu(time, [&] {
      const control::Taken taken = onboard->Take(measurement);
      if (taken != control::Taken::kIgnored && taken != control::Taken::kEmpty)
        pad_measured_ = true;
    });
  };
  if (const auto fix = gps_.Poll(t, pad)) take(*fix, &sensing_times_.pad_filter);
  pad_sensor_->Look(vehicle, onboard->own(), pad, &sensing_times_);
  while (const auto seen = pad_sensor_->Poll(t)) {
    if (seen->image) {
      take(*seen->image, &sensing_times_.pad_finding);
    } else {
      take(seen->sighting, &sensing_times_.pad_filter);
    }
  }
}

void Perception::SenseDepth(const estimation::VehicleState& vehicle, control::Onboard* onboard) {
  frame_times_.clear();
  for (const auto& sensor : depth_sensors_) {
    while (auto timed = sensor->Poll(vehicle.t)) {
      FrameTimes& times = frame_times_.emplace_back();
      times.sense = timed->sense;
      {
        const planning::StageTimer timer(&times.map);
        onboard->Take(timed->image);
      }
      if (truth_) {
        ObserveTruth(*truth_, onboard->own().p_WB - vehicle.p_WB, onboard->mutable_map());
      }
      sensor->Recycle(std::move(*timed));
    }
  }
}

}  // namespace touchdown::evaluation
