// SPDX-License-Identifier: BSD-3-Clause
// The wind blows alike everywhere: buildings neither shelter nor speed it up.
#include "evaluation/flight/air.h"

#include "sim/air/pad_wake.h"

namespace touchdown::evaluation {

Air::Air(const Scenario& scenario, const TrialDraw& draw, std::uint64_t seed)
    : wind_(WindOf(scenario, draw), seed), pad_wake_(scenario.air.pad_wake) {}

const Eigen::Vector3d& Air::Step(const sim::World& world) {
  const estimation::VehicleState vehicle = world.vehicle();
  velocity_ = wind_.Step(vehicle, world.timestep());
  if (pad_wake_) {
    velocity_ += sim::PadWake(world.config().pad, world.pad(), velocity_, vehicle.p_WB);
  }
  return velocity_;
}

}  // namespace touchdown::evaluation
