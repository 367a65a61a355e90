// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "touchdown/control/tracking/controller.h"
#include "touchdown/evaluation/scenario/part.h"

namespace touchdown::evaluation {

/// What a tracking law is made from.
struct ControllerSetup : PartSetup {
  const estimation::VehicleModel& model;
  control::ControllerOptions options;
};

/// How a tracking law gets into the program.
struct ControllerEntry : Part {
  /// It gets the estimated disturbance, and its thrusts lead the rotors' lag.
  bool compensates = true;
  std::function<std::unique_ptr<control::Controller>(const ControllerSetup&)> make;
};

/// The laws of the library.
std::vector<ControllerEntry> StandardControllers();

}  // namespace touchdown::evaluation
