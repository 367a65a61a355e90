// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/mcap/point_cloud.h"
#include "evaluation/mcap/scene_entity.h"
#include "evaluation/mcap/solid.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Frames of an exported flight.
inline constexpr const char kWorldFrame[] = "world";           ///< W
inline constexpr const char kVehicleFrame[] = "vehicle";       ///< B, where it truly is
inline constexpr const char kPadFrame[] = "pad";               ///< P, where it truly is
inline constexpr const char kPadBeliefFrame[] = "pad_belief";  ///< P, where it is believed to be
inline constexpr const char kGoalFrame[] = "goal";             ///< of the task go_to
inline constexpr const char kDepthFrame[] = "camera_depth";    ///< C: x right, y down, z ahead
inline constexpr const char kDownFrame[] = "camera_down";      ///< C of the downward camera

/// What is drawn of one thing, and does not change in its frame.
struct NamedSolids {
  std::string frame;
  std::string name;
  std::vector<Solid> solids;
};

/// Obstacles as they truly are, each under its key.
std::vector<NamedSolids> ObstacleSolids(const Scenario& scenario);
/// @param zones as FlightTables has them.
std::vector<NamedSolids> ZoneSolids(const nlohmann::ordered_json& zones);
NamedSolids VehicleSolids(const Scenario& scenario);
NamedSolids PadSolids(const Scenario& scenario);
NamedSolids GoalSolids();
/// The ground below all of these places.
NamedSolids GroundSolids(const std::vector<NamedSolids>& world,
                         const std::vector<Eigen::Vector3d>& places_W);

std::vector<SceneEntity> EntitiesOf(const std::vector<NamedSolids>& things);
/// Points all over their surfaces, closer to each other than `spacing` [m]. The distance is larger where there would be
/// more than `most` points.
CloudPoints PointsOf(const std::vector<NamedSolids>& things, double spacing, std::size_t most);

}  // namespace touchdown::evaluation
