// SPDX-License-Identifier: BSD-3-Clause
// How the vehicle sees obstacles: by rendered depth images, or by cast rays.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "estimation/base/sample_clock.h"
#include "evaluation/base/sensing_times.h"
#include "sim/sensors/depth_camera.h"
#include "sim/sensors/frame_delivery.h"
#include "sim/world/world.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::evaluation {

/// A depth image, and the time that it took to make it.
struct TimedDepthImage {
  estimation::DepthImage image;
  planning::StageTimes::Span sense{"sense"};
};

/// A depth camera. Images come at the camera's rate; some are dropped, and they arrive
/// late, as the scenario says. Belongs to the thread that made it.
class DepthSensor {
 public:
  virtual ~DepthSensor() = default;
  DepthSensor(const DepthSensor&) = delete;
  DepthSensor& operator=(const DepthSensor&) = delete;

  /// Takes an image if one is due at the vehicle's time. Call once per physics step.
  void Look(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
            SensingTimes* times);

  /// The oldest image that has arrived by the time t [s]; call until there is none.
  std::optional<TimedDepthImage> Poll(double t) { return delivery_.Poll(t); }

  /// Takes the memory of an image that is done with, for one to come.
  void Recycle(TimedDepthImage timed) { spare_ = std::move(timed); }

 protected:
  /// @param rate of images [Hz].
  DepthSensor(const Scenario& scenario, double rate, std::uint64_t seed);

 private:
  virtual void Capture(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
                       estimation::DepthImage* image) = 0;

  estimation::SampleClock clock_;
  sim::FrameDelivery<TimedDepthImage> delivery_;
  TimedDepthImage spare_;
};

/// A depth camera of a scenario.
struct MountedDepthCamera {
  sim::DepthCameraConfig config;
  double rate = 0.0;  ///< [Hz]
};

/// The depth cameras of the scenario, one at least.
std::vector<MountedDepthCamera> DepthCamerasOf(const Scenario& scenario);

/// Their sensors, of the scenario's `sensing`; as MakePadSensor.
std::vector<std::unique_ptr<DepthSensor>> MakeDepthSensors(const Scenario& scenario,
                                                           const sim::WorldConfig& world,
                                                           std::uint64_t seed);

}  // namespace touchdown::evaluation
