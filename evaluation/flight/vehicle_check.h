// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "evaluation/judge/trial_result.h"
#include "sim/vehicle/vehicle_findings.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// How well a vehicle flies a metre and stays there, in still air. Tracking law and all else are as in any flight.
struct HoverCheck {
  bool held = false;
  std::string outcome;         ///< of the flight
  double seconds = 0.0;        ///< flown, on the way there too
  double farthest_m = 0.0;     ///< from where it was to stay, in the last five seconds
  double greatest_tilt = 0.0;  ///< [rad]
};

/// All findings in a vehicle's file.
struct VehicleCheck {
  std::string file;
  std::string airframe_file;  ///< beside it; empty: there is none
  sim::VehicleFindings findings;
  std::optional<estimation::VehicleModel> model;       ///< without faults
  std::optional<HoverCheck> hover;                     ///< alike
  std::vector<std::vector<Eigen::Vector3d>> outlines;  ///< points around each geom in B [m]

  bool passed() const { return findings.faults().empty() && hover && hover->held; }
};

/// Reads the MJCF file as `vehicle: FILE` does, with the airframe file beside it and overrides KEY=VALUE. If there are
/// no faults, it hovers the vehicle for five seconds.
/// @throws BadInput for overrides and airframe files that LoadScenario refuses.
VehicleCheck CheckVehicle(const std::string& file, const std::vector<std::string>& overrides,
                          const Registries& registries);

/// The document of `touchdown check-vehicle --json`, which its picture is drawn from too.
nlohmann::ordered_json VehicleCheckJson(const VehicleCheck& check);

}  // namespace touchdown::evaluation
