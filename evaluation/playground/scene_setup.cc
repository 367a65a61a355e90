// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/playground/scene_setup.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "touchdown/control/onboard/envelope.h"

namespace touchdown::evaluation {
namespace {

// As the program has them by default.
constexpr double kPlanLatency = 0.02;   // planning.latency [s]
constexpr double kClearance = 0.4;      // planning.clearance [m]
constexpr double kPeriodSlack = 0.004;  // by which a step may come late [s]

}  // namespace

estimation::VehicleModel PlaygroundVehicle() {
  estimation::VehicleModel model;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d p_BR(i == 0 || i == 3 ? 0.12 : -0.12, i < 2 ? 0.12 : -0.12, 0.04);
    model.actuators.push_back(estimation::RotorAt(p_BR, i % 2 == 0 ? 0.016 : -0.016, 7.0));
  }
  return model;
}

sim::PadGeometry PlaygroundPad() { return {}; }

sim::ObstacleField FieldOf(const PlaygroundScene& scene) {
  std::vector<sim::Obstacle> obstacles(scene.walls.begin(), scene.walls.end());
  obstacles.insert(obstacles.end(), scene.pillars.begin(), scene.pillars.end());
  return sim::ObstacleField(std::move(obstacles));
}

estimation::VehicleState StartOf(const PlaygroundScene& scene) {
  estimation::VehicleState vehicle;
  vehicle.p_WB = scene.p_WB;
  const Eigen::Vector3d to_pad = scene.pad.p_start - scene.p_WB;
  vehicle.q_WB = Eigen::AngleAxisd(std::atan2(to_pad.y(), to_pad.x()), Eigen::Vector3d::UnitZ());
  return vehicle;
}

control::OnboardOptions OnboardOptionsOf(const PlaygroundScene& scene) {
  control::OnboardOptions options =
      control::LandingOptions(PlaygroundVehicle(), scene.pad.p_start.z(), scene.limits);
  options.deck_size = 2.0 * PlaygroundPad().deck_half_size;
  options.latency.time = kPlanLatency;
  options.map.inflation_radius = std::max(options.map.inflation_radius, kClearance);
  options.estimate_disturbance = false;  // a point flies its reference exactly
  return options;
}

planning::ReplannerOptions PlannerOf(const PlaygroundScene& scene) {
  const control::OnboardOptions onboard = OnboardOptionsOf(scene);
  planning::ReplannerOptions options;
  options.backend = scene.backend;
  options.arrival = scene.arrival;
  options.max_guides = scene.ways;
  options.min_contact_duration = onboard.shortest_contact_plan;
  for (const auto& [name, weight] : scene.weights) {
    planning::TermSettings settings;
    settings.name = name;
    settings.weight = weight;
    options.problem.settings.push_back(settings);
  }
  control::SetVehicle(onboard.model, scene.limits, onboard.deck_size,
                      kPeriodSlack + 1.0 / onboard.replan_rate, 0.0, &options);
  control::SetLanding(&options);
  return options;
}

double HullClearance(const sim::ObstacleField& field, const Eigen::Vector3d& p_WB) {
  return field.SignedDistance(p_WB) - control::HullAtEveryTilt(PlaygroundVehicle());
}

}  // namespace touchdown::evaluation
