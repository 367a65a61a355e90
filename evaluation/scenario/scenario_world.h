// SPDX-License-Identifier: BSD-3-Clause
// From a scenario's plain numbers to the simulator's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scenario/world_obstacles.h"
#include "sim/air/wind.h"
#include "sim/pad/pad_geometry.h"
#include "sim/vehicle/vehicle_import.h"
#include "sim/world/world.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/replan/goal.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// What drives the pad in the trial of `seed` with `phase` metres driven before t = 0.
/// @throws std::invalid_argument if the motion cannot be made or is unknown; if its waypoint file cannot be read, the line
/// first.
std::shared_ptr<const sim::PadCourse> PadCourseOf(const Scenario& scenario,
                                                  const Registries& registries, double phase,
                                                  std::uint64_t seed);

/// The goal of the task go_to.
planning::MovingGoal GoalOf(const Scenario& scenario);

/// The predictor of the pad, whose future is `truth`, or in the task go_to of the goal. @throws std::invalid_argument if
/// it is unknown.
std::unique_ptr<estimation::PadPredictor> PredictorOf(const Scenario& scenario,
                                                      const Registries& registries,
                                                      std::shared_ptr<const sim::PadCourse> truth);

sim::PadGeometry PadGeometryOf(const Scenario& scenario);

/// The scenario's keys for a vehicle's file in the common form.
sim::AirframeExtras AirframeOf(const Scenario& scenario);

/// The path of the airframe file beside a vehicle's; empty where there is none.
std::string AirframeFile(const std::string& vehicle);

/// The default scenario with a vehicle's file, the keys of the airframe file beside it, and overrides KEY=VALUE. The
/// vehicle is not checked. @throws BadInput as LoadScenario does for keys and values.
Scenario UncheckedVehicleScenario(const std::string& vehicle,
                                  const std::vector<std::string>& overrides,
                                  const Registries& registries);

/// MJCF text of the scenario's vehicle. @throws std::invalid_argument naming the file.
std::string VehicleMjcf(const Scenario& scenario);

/// Findings in the vehicle's file though it can be flown. @throws std::invalid_argument as VehicleMjcf.
std::vector<sim::VehicleFinding> VehicleWarnings(const Scenario& scenario);

/// Contents of the outside files that a flight depends on, as a record keeps them. They are the points of the waypoint
/// file and the hashes of the vehicle's MJCF text and of the obstacle files. Each is `none` without such a file.
/// @throws std::invalid_argument as PadCourseOf and VehicleMjcf do.
struct OutsideFiles {
  std::string pad_waypoints = "none";
  std::string vehicle_hash = "none";
  std::string world_hash = "none";
};
OutsideFiles OutsideFilesOf(const Scenario& scenario);

/// The draws of a trial before it begins.
struct TrialDraw {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< start of the vehicle [m]
  double yaw = 0.0;                                ///< [rad]
  double phase = 0.0;                              ///< of the pad [m]
  std::uint64_t seed = 0;                          ///< of the trial
  double wind_direction = 0.0;                     ///< where the wind blows to [rad]
};

/// The draws of `seed`, from the streams "start", "pad" and "wind direction".
TrialDraw DrawTrial(const Scenario& scenario, std::uint64_t seed);

/// The simulator's wind for this scenario and draw.
sim::WindConfig WindOf(const Scenario& scenario, const TrialDraw& draw);

/// The simulator's world at t = 0.
sim::WorldConfig WorldOf(const Scenario& scenario, const TrialDraw& draw,
                         const Registries& registries);

}  // namespace touchdown::evaluation
