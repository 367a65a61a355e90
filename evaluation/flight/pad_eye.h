// SPDX-License-Identifier: BSD-3-Clause
// How the vehicle sees the pad: by rendered images, or by a model of what would be found in them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "estimation/base/sample_clock.h"
#include "evaluation/base/sensing_times.h"
#include "sim/sensors/frame_delivery.h"
#include "sim/world/world.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The downward camera and what is made of its images. Images come at the camera's rate; some are
/// dropped, and what is seen arrives late, as the scenario says. Belongs to the thread that made it.
class PadEye {
 public:
  virtual ~PadEye() = default;
  PadEye(const PadEye&) = delete;
  PadEye& operator=(const PadEye&) = delete;

  /// Takes an image if one is due at the vehicle's time. Call once per physics step.
  /// @param vehicle true state, from where the image is taken.
  /// @param believed what the vehicle takes for its state.
  /// @param expected where the pad should be: an eye may leave out work that cannot find it.
  void Look(const estimation::VehicleState& vehicle, const estimation::VehicleState& believed,
            const estimation::PadState& pad, const estimation::PadFilter& expected,
            SensingTimes* times);

  /// The oldest sighting that has arrived by the time t [s]; call until there is none.
  std::optional<estimation::PadSighting> Poll(double t) { return delivery_.Poll(t); }

 protected:
  PadEye(const Scenario& scenario, std::uint64_t seed);

 private:
  virtual std::optional<estimation::PadSighting> Sight(const estimation::VehicleState& vehicle,
                                                       const estimation::VehicleState& believed,
                                                       const estimation::PadState& pad,
                                                       const estimation::PadFilter& expected,
                                                       SensingTimes* times) = 0;

  estimation::SampleClock clock_;
  sim::FrameDelivery<estimation::PadSighting> delivery_;
};

/// The eye of the scenario's `sensing`. `world` only gives the configuration; `seed` feeds its own
/// streams. @throws std::invalid_argument naming key, value and range, std::runtime_error if there
/// is no off-screen rendering.
/// @param thrifty do not search images in which the expected pad cannot be; this saves time and
/// changes nothing as long as the expectation is not off by more than it says it may be.
std::unique_ptr<PadEye> MakePadEye(const Scenario& scenario, const sim::WorldConfig& world,
                                   std::uint64_t seed, bool thrifty = true);

/// Whether a pad at p_C, its centre in the camera's frame [m], with anything of its sheet within
/// `radius` of there, may show a tag in the image.
bool MayShowPad(const Eigen::Vector3d& p_C, double radius,
                const estimation::CameraIntrinsics& camera);

}  // namespace touchdown::evaluation
