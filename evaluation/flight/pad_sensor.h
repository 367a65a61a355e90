// SPDX-License-Identifier: BSD-3-Clause
// How the vehicle sees the pad: by rendered images, or by a model of what would be found in them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "estimation/base/sample_clock.h"
#include "evaluation/base/sensing_times.h"
#include "sim/sensors/frame_delivery.h"
#include "sim/sensors/pad_camera.h"
#include "sim/world/world.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// What the vehicle gets: an image, or the tags that would be found in it.
struct PadSeen {
  std::unique_ptr<estimation::PadImage> image;
  estimation::PadSighting sighting;
};

/// The downward camera. Images come at its rate; some are dropped, and they arrive late, as the scenario says. Belongs to
/// the thread that made it.
class PadSensor {
 public:
  virtual ~PadSensor() = default;
  PadSensor(const PadSensor&) = delete;
  PadSensor& operator=(const PadSensor&) = delete;

  /// Takes an image if one is due at the vehicle's time. Call once per physics step.
  /// @param vehicle true state, from where the image is taken.
  /// @param believed what the vehicle takes for its state.
  /// @param pad true state.
  /// @param times of the stages, to which it is added.
  void Look(const estimation::VehicleState& vehicle, const estimation::VehicleState& believed,
            const estimation::PadState& pad, SensingTimes* times);

  /// The oldest one that has arrived by the time t [s]; call until there is none.
  std::optional<PadSeen> Poll(double t) { return delivery_.Poll(t); }

 protected:
  PadSensor(const Scenario& scenario, std::uint64_t seed);

 private:
  virtual std::optional<PadSeen> See(const estimation::VehicleState& vehicle,
                                     const estimation::VehicleState& believed,
                                     const estimation::PadState& pad, SensingTimes* times) = 0;

  estimation::SampleClock clock_;
  sim::FrameDelivery<PadSeen> delivery_;
};

/// The downward camera of the scenario, and its view.
sim::PadCameraConfig PadCameraOf(const Scenario& scenario);
sim::VisualScene VisualSceneOf(const Scenario& scenario, const sim::WorldConfig& world);

/// The sensor of the scenario's `sensing`. `world` only gives the configuration; `seed` feeds its own
/// streams. @throws std::invalid_argument naming key, value and range, std::runtime_error if there
/// is no off-screen rendering.
std::unique_ptr<PadSensor> MakePadSensor(const Scenario& scenario, const sim::WorldConfig& world,
                                         std::uint64_t seed);

}  // namespace touchdown::evaluation
