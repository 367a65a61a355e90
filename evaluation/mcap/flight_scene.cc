// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/flight_scene.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/obstacle.h"
#include "sim/pad/pad_geometry.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_shapes.h"

namespace touchdown::evaluation {
namespace {

constexpr Color kObstacleColor = {0.66, 0.67, 0.70, 0.6};
constexpr Color kZoneColor = {0.0, 0.62, 0.45, 0.25};
constexpr Color kGroundColor = {0.30, 0.33, 0.31, 1.0};
constexpr Color kDeckColor = {0.92, 0.92, 0.90, 1.0};
constexpr Color kMiddleColor = {0.84, 0.37, 0.0, 1.0};  // of the deck
constexpr Color kPadBodyColor = {0.35, 0.40, 0.48, 1.0};
constexpr Color kRotorColor = {0.34, 0.71, 0.91, 0.5};
constexpr Color kGoalColor = {0.80, 0.47, 0.65, 1.0};

Eigen::Isometry3d At(const Eigen::Vector3d& p, double yaw = 0.0) {
  return PoseOf(p, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
}

Solid BoxSolid(const sim::Box& box, const Color& color) {
  return {Solid::Kind::kBox, At(box.center, box.yaw), 2.0 * box.half_extents, color, {}};
}

// Only maps and planners know the other kinds: no scenario has any.
std::vector<Solid> SolidsOf(const sim::Obstacle& obstacle) {
  if (const auto* box = std::get_if<sim::Box>(&obstacle)) return {BoxSolid(*box, kObstacleColor)};
  if (const auto* cylinder = std::get_if<sim::Cylinder>(&obstacle)) {
    const double across = 2.0 * cylinder->radius;
    return {{Solid::Kind::kCylinder,
             At(cylinder->center),
             {across, across, cylinder->height},
             kObstacleColor,
             {}}};
  }
  if (const auto* sphere = std::get_if<sim::Sphere>(&obstacle)) {
    return {{Solid::Kind::kEllipsoid,
             At(sphere->center),
             Eigen::Vector3d::Constant(2.0 * sphere->radius),
             kObstacleColor,
             {}}};
  }
  if (const auto* mesh = std::get_if<sim::Mesh>(&obstacle)) {
    return {{Solid::Kind::kSurface,
             Eigen::Isometry3d::Identity(),
             Eigen::Vector3d::Zero(),
             kObstacleColor,
             {mesh->surface->corners(), mesh->surface->triangles()}}};
  }
  return {};
}

Eigen::Vector3d VectorOf(const nlohmann::ordered_json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

// A capsule is a cylinder with two balls.
std::vector<Solid> SolidsOf(const sim::VehicleShape& shape) {
  using Kind = sim::VehicleShape::Kind;
  const Eigen::Isometry3d pose = PoseOf(shape.p_BG, shape.q_BG);
  const Color color = {shape.rgba[0], shape.rgba[1], shape.rgba[2], shape.rgba[3]};
  const double across = 2.0 * shape.size.x();
  const Eigen::Vector3d rod(across, across, 2.0 * shape.size.y());
  const auto ball = [&](const Eigen::Isometry3d& at) -> Solid {
    return {Solid::Kind::kEllipsoid, at, Eigen::Vector3d::Constant(across), color, {}};
  };
  switch (shape.kind) {
    case Kind::kSphere:
      return {ball(pose)};
    case Kind::kCapsule: {
      const Eigen::Translation3d up(0.0, 0.0, shape.size.y());
      return {{Solid::Kind::kCylinder, pose, rod, color, {}},
              ball(pose * up),
              ball(pose * up.inverse())};
    }
    case Kind::kEllipsoid:
      return {{Solid::Kind::kEllipsoid, pose, 2.0 * shape.size, color, {}}};
    case Kind::kCylinder:
      return {{Solid::Kind::kCylinder, pose, rod, color, {}}};
    case Kind::kBox:
      return {{Solid::Kind::kBox, pose, 2.0 * shape.size, color, {}}};
    case Kind::kMesh:
      break;
  }
  return {{Solid::Kind::kSurface,
           pose,
           Eigen::Vector3d::Zero(),
           color,
           {shape.corners, shape.triangles}}};
}

}  // namespace

std::vector<NamedSolids> ObstacleSolids(const Scenario& scenario) {
  std::vector<NamedSolids> things;
  for (const NamedObstacle& named : ObstaclesOf(scenario)) {
    // A wall is several boxes.
    if (things.empty() || things.back().name != named.key) {
      things.push_back({kWorldFrame, named.key, {}});
    }
    const std::vector<Solid> solids = SolidsOf(named.obstacle);
    things.back().solids.insert(things.back().solids.end(), solids.begin(), solids.end());
  }
  return things;
}

std::vector<NamedSolids> ZoneSolids(const nlohmann::ordered_json& zones) {
  std::vector<NamedSolids> things;
  for (const auto& zone : zones) {
    const auto shape = zone.at("shape").get<std::string>();
    const auto kind = shape == "box"      ? Solid::Kind::kBox
                      : shape == "sphere" ? Solid::Kind::kEllipsoid
                                          : Solid::Kind::kCylinder;
    things.push_back(
        {kWorldFrame,
         // Several may be of one term.
         fmt::format("zone {} of {}", things.size() + 1, zone.at("term").get<std::string>()),
         {{kind, At(VectorOf(zone.at("centre"))), VectorOf(zone.at("size")), kZoneColor, {}}}});
  }
  return things;
}

NamedSolids VehicleSolids(const Scenario& scenario) {
  const std::string mjcf = VehicleMjcf(scenario);
  const estimation::VehicleModel model = sim::LoadVehicleModel(mjcf);
  NamedSolids thing = {kVehicleFrame, "vehicle", {}};
  for (const sim::VehicleShape& shape : sim::VehicleShapes(mjcf)) {
    const std::vector<Solid> solids = SolidsOf(shape);
    thing.solids.insert(thing.solids.end(), solids.begin(), solids.end());
  }
  const double across = 2.0 * sim::DrawnRotorRadius(model);
  for (const estimation::Actuator& actuator : model.actuators) {
    if (actuator.thrust == 0.0) continue;  // it makes a moment alone and has no place
    thing.solids.push_back(
        {Solid::Kind::kCylinder, At(actuator.p_BR), {across, across, 0.01}, kRotorColor, {}});
  }
  return thing;
}

NamedSolids PadSolids(const Scenario& scenario) {
  const sim::PadGeometry pad = PadGeometryOf(scenario);
  estimation::PadState state;
  state.p_WP.z() = scenario.pad.deck_height;
  const auto in_pad = [&](sim::Box box, const Color& color) {
    box.center -= state.p_WP;
    return BoxSolid(box, color);
  };
  constexpr double kPaint = 0.002;
  const Solid middle = {Solid::Kind::kCylinder,
                        At(0.5 * kPaint * Eigen::Vector3d::UnitZ()),
                        {0.2, 0.2, kPaint},
                        kMiddleColor,
                        {}};
  return {kPadFrame,
          "pad",
          {in_pad(sim::DeckBox(pad, state), kDeckColor),
           in_pad(sim::PadBodyBox(pad, state), kPadBodyColor), middle}};
}

NamedSolids GoalSolids() {
  return {kGoalFrame,
          "goal",
          {{Solid::Kind::kEllipsoid,
            At(Eigen::Vector3d::Zero()),
            Eigen::Vector3d::Constant(0.25),
            kGoalColor,
            {}}}};
}

NamedSolids GroundSolids(const std::vector<NamedSolids>& world,
                         const std::vector<Eigen::Vector3d>& places_W) {
  constexpr double kBeyond = 3.0, kSheet = 0.02;  // [m]
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : places_W) bounds.extend(p);
  for (const NamedSolids& thing : world) {
    for (const Solid& solid : thing.solids) {
      for (const Eigen::Vector3d& corner : SurfaceOf(solid).corners) {
        bounds.extend(solid.pose * corner);
      }
    }
  }
  Eigen::Vector3d middle = bounds.center(), size = bounds.sizes();
  middle.z() = -0.5 * kSheet;
  size += Eigen::Vector3d::Constant(2.0 * kBeyond);
  size.z() = kSheet;
  return {kWorldFrame, "ground", {{Solid::Kind::kBox, At(middle), size, kGroundColor, {}}}};
}

std::vector<SceneEntity> EntitiesOf(const std::vector<NamedSolids>& things) {
  std::vector<SceneEntity> entities;
  for (const NamedSolids& thing : things) {
    SceneEntity& entity = entities.emplace_back(0.0, thing.frame, thing.name);
    for (const Solid& solid : thing.solids) entity.Add(solid);
  }
  return entities;
}

CloudPoints PointsOf(const std::vector<NamedSolids>& things, double spacing, std::size_t most) {
  double area = 0.0;
  for (const NamedSolids& thing : things) {
    for (const Solid& solid : thing.solids) area += AreaOf(SurfaceOf(solid));
  }
  const double fitting = std::max(spacing, std::sqrt(area / static_cast<double>(most)));
  CloudPoints points;
  for (const NamedSolids& thing : things) {
    for (const Solid& solid : thing.solids) AddSurface(solid, fitting, &points);
  }
  // Each triangle has a point, however small it is.
  const std::size_t step = (points.size() + most - 1) / most;
  if (step <= 1) return points;
  CloudPoints fewer;
  for (std::size_t i = 0; i < points.size(); i += step) fewer.push_back(points[i]);
  return fewer;
}

}  // namespace touchdown::evaluation
