// SPDX-License-Identifier: BSD-3-Clause
// Ranges of the controllers' options and of the vehicle figures they use; controllers by name.

#include "touchdown/control/tracking/controller.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include "control/tracking/geometric_controller.h"
#include "control/tracking/paper_controller.h"

namespace touchdown::control {
namespace {

void Require(bool good, const char* name, double value, const char* range) {
  if (good) return;
  std::ostringstream message;
  message << name << " = " << value << ", allowed: " << range;
  throw std::invalid_argument(message.str());
}

void RequirePositive(const char* name, double value) {
  Require(value > 0.0 && std::isfinite(value), name, value, "> 0");
}

}  // namespace

void Validate(const ControllerOptions& options) {
  RequirePositive("ControllerOptions.position_frequency", options.position_frequency);
  RequirePositive("ControllerOptions.position_damping", options.position_damping);
  RequirePositive("ControllerOptions.height_frequency", options.height_frequency);
  RequirePositive("ControllerOptions.height_damping", options.height_damping);
  RequirePositive("ControllerOptions.attitude_frequency", options.attitude_frequency);
  RequirePositive("ControllerOptions.attitude_damping", options.attitude_damping);
  RequirePositive("ControllerOptions.yaw_frequency", options.yaw_frequency);
  RequirePositive("ControllerOptions.yaw_damping", options.yaw_damping);
  Require(options.tilt_max > 0.0 && options.tilt_max < 0.5 * std::numbers::pi,
          "ControllerOptions.tilt_max", options.tilt_max, "(0, pi/2) rad");
  Require(options.thrust_fraction_max > 0.0 && options.thrust_fraction_max <= 1.0,
          "ControllerOptions.thrust_fraction_max", options.thrust_fraction_max, "(0, 1]");
  Require(options.thrust_fraction_min > 0.0 && options.thrust_fraction_min < 1.0,
          "ControllerOptions.thrust_fraction_min", options.thrust_fraction_min, "(0, 1)");
}

void Validate(const estimation::VehicleModel& model) {
  RequirePositive("VehicleModel.mass_kg", model.mass_kg);
  RequirePositive("VehicleModel.inertia.x", model.inertia.x());
  RequirePositive("VehicleModel.inertia.y", model.inertia.y());
  RequirePositive("VehicleModel.inertia.z", model.inertia.z());
  Require(model.rotor_drag.allFinite() && model.rotor_drag.minCoeff() >= 0.0,
          "VehicleModel.rotor_drag (least)", model.rotor_drag.minCoeff(), ">= 0");
  RequirePositive("VehicleModel.hull_radius", model.hull_radius);
  RequirePositive("VehicleModel.foot_depth", model.foot_depth);
  const double skew =
      (model.R_BI.transpose() * model.R_BI - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  Require(skew < 1e-6, "VehicleModel.R_BI: off a rotation by", skew, "< 1e-6");
  const double thrust_max = estimation::AllocationOf(model).thrust_max;
  Require(thrust_max > model.HoverThrust(),
          "VehicleModel.actuators: greatest thrust without a moment", thrust_max,
          "more than the weight");
}

std::unique_ptr<Controller> MakeController(std::string_view name,
                                           const estimation::VehicleModel& model,
                                           const ControllerOptions& options) {
  if (name == "geometric") return std::make_unique<GeometricController>(model, options);
  if (name == "paper") return std::make_unique<PaperController>(model, options);
  throw std::invalid_argument("controller '" + std::string(name) + "', allowed: geometric, paper");
}

}  // namespace touchdown::control
