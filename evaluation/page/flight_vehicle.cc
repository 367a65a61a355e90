// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/flight_vehicle.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "estimation/tags/pad_sheet.h"
#include "evaluation/flight/depth_sensor.h"
#include "evaluation/flight/pad_sensor.h"
#include "evaluation/page/rounded.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_shapes.h"
#include "touchdown/planning/map/pad_outline.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDecimals = 4;  // of metres

Json Numbers(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  Json json = Json::array();
  for (const double x : numbers) json.push_back(Rounded(x, kDecimals));
  return json;
}

// x y z w, as three.js has it.
Json QuaternionJson(const Eigen::Quaterniond& q) { return Numbers(q.coeffs()); }

Json ShapeJson(const sim::VehicleShape& shape) {
  Json json = {{"kind", sim::ToString(shape.kind)},
               {"size", Numbers(shape.size)},
               {"p", Numbers(shape.p_BG)},
               {"q", QuaternionJson(shape.q_BG)},
               {"rgba", Numbers(shape.rgba)}};
  if (shape.kind != sim::VehicleShape::Kind::kMesh) return json;
  Json &corners = json["corners"] = Json::array(), &triangles = json["triangles"] = Json::array();
  for (const Eigen::Vector3d& corner : shape.corners) {
    for (const double x : corner) corners.push_back(Rounded(x, kDecimals));
  }
  for (const Eigen::Vector3i& triangle : shape.triangles) {
    for (const int corner : triangle) triangles.push_back(corner);
  }
  return json;
}

// `slope_x`, `slope_y`: half the image's sides at 1 m.
Json CameraJson(const char* name, const Eigen::Vector3d& p_BC, const Eigen::Matrix3d& R_BC,
                double slope_x, double slope_y, double range) {
  return {{"name", name},
          {"p", Numbers(p_BC)},
          {"q", QuaternionJson(Eigen::Quaterniond(R_BC))},
          {"slope", {Rounded(slope_x, 4), Rounded(slope_y, 4)}},
          {"range", range}};
}

Json DepthCameraJson(const sim::DepthCameraConfig& config) {
  const double slope = std::tan(0.5 * config.fov_x_deg * estimation::kRadPerDeg);
  return CameraJson("depth", config.p_BC, sim::CameraAxes(config), slope,
                    slope * config.height / config.width, config.max_range);
}

Json PadCameraJson(const Scenario& scenario) {
  const sim::PadCameraConfig config = PadCameraOf(scenario);
  constexpr double kDrawn = 2.0;  // it has no range; so far it is drawn [m]
  const double slope = std::tan(0.5 * config.fov_y_deg * estimation::kRadPerDeg);
  return CameraJson("downward", config.p_BC, sim::DownwardCameraAxes(),
                    slope * config.width / config.height, slope, kDrawn);
}

Json SheetJson() {
  const estimation::GrayImage sheet = estimation::PadSheet();
  constexpr std::uint8_t kWhite = 128;
  Json rows = Json::array();
  for (int v = 0; v < sheet.height; ++v) {
    Json runs = Json::array();
    bool white = true;
    int count = 0;
    for (int u = 0; u < sheet.width; ++u, ++count) {
      const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(sheet.width) +
                      static_cast<std::size_t>(u);
      if ((sheet.pixels[at] >= kWhite) == white) continue;
      runs.push_back(count);
      white = !white;
      count = 0;
    }
    runs.push_back(count);
    rows.push_back(std::move(runs));
  }
  return {{"side", estimation::kPadSheetSide}, {"texels", sheet.width}, {"rows", std::move(rows)}};
}

}  // namespace

Json VehicleDocument(const Scenario& scenario) {
  const std::string mjcf = VehicleMjcf(scenario);
  const estimation::VehicleModel model = sim::LoadVehicleModel(mjcf);
  Json json;
  Json& shapes = json["shapes"] = Json::array();
  for (const sim::VehicleShape& shape : sim::VehicleShapes(mjcf)) {
    shapes.push_back(ShapeJson(shape));
  }
  Json& rotors = json["rotors"] = Json::array();
  for (const estimation::Actuator& actuator : model.actuators) {
    // What makes a moment alone has no place.
    rotors.push_back({{"p", Numbers(actuator.p_BR)},
                      {"lifts", actuator.thrust != 0.0},
                      {"max", Rounded(actuator.max, 3)}});
  }
  json["rotor_radius"] = Rounded(sim::DrawnRotorRadius(model), 3);
  json["foot_depth"] = Rounded(model.foot_depth, 3);
  Json& cameras = json["cameras"] = Json::array();
  for (const MountedDepthCamera& camera : DepthCamerasOf(scenario)) {
    cameras.push_back(DepthCameraJson(camera.config));
  }
  cameras.push_back(PadCameraJson(scenario));
  return json;
}

Json GoalDocument(const Scenario& scenario) {
  if (scenario.task != TaskKind::kGoTo) return nullptr;
  const estimation::PadState goal = GoalOf(scenario).At(0.0);
  return {{"p", Numbers(goal.p_WP)}, {"v", Numbers(goal.v_WP)}};
}

Json PadDocument(const Scenario& scenario) {
  const sim::PadGeometry pad = PadGeometryOf(scenario);
  return {
      {"half_size", pad.deck_half_size},
      {"thickness", pad.deck_thickness},
      {"body", {pad.body_half_length, pad.body_half_width}},
      {"ground_gap", pad.ground_gap},
      // Returns from the deck, grown by so many sigmas of its place, are no obstacles. Beyond `sure` they are doubtful.
      {"sigmas", planning::PadOutline::kSigmas},
      {"sure", planning::PadOutline::kSure},
      {"plate_from", Rounded(sim::PlateEdge(scenario.camera.occlusion), kMilli)},
      {"sheet", SheetJson()}};
}

}  // namespace touchdown::evaluation
