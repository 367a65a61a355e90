// SPDX-License-Identifier: BSD-3-Clause
// Units become SI here (degrees to radians), and draws are made. Each purpose has its own stream.
// Every stream is drawn from, whether or not its figure is used, so that one option never shifts
// another's draws.
#include "evaluation/scenario/scenario_world.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "estimation/base/degrees.h"
#include "evaluation/base/build_info.h"
#include "evaluation/scenario/waypoint_file.h"
#include "sim/base/random_stream.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_import.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Predicts the goal and ignores the pad's estimate: the vehicle does not go to the pad.
class ToGoal final : public estimation::PadPredictor {
 public:
  explicit ToGoal(const Scenario& scenario) : goal_(GoalOf(scenario)) {}
  const estimation::PadPrediction& Predict(const estimation::PadKnowledge& /*known*/) override {
    return goal_;
  }

 private:
  planning::MovingGoal goal_;
};

}  // namespace

std::shared_ptr<const sim::PadCourse> PadCourseOf(const Scenario& scenario,
                                                  const Registries& registries, double phase,
                                                  std::uint64_t seed) {
  const PadMotionEntry& entry =
      PartNamed(registries.pad_motions, scenario.pad.motion, "pad motion");
  return MadeBy(entry, PadMotionSetup{{scenario, entry.parameters}, phase, seed}, "pad motion");
}

planning::MovingGoal GoalOf(const Scenario& scenario) {
  const Eigen::Vector3d p = scenario.go_to.goal, v = scenario.go_to.velocity;
  return planning::MovingGoal([p, v](const planning::Taylor& t) {
    return planning::MovingGoal::Position{p.x() + v.x() * t, p.y() + v.y() * t, p.z() + v.z() * t};
  });
}

std::unique_ptr<estimation::PadPredictor> PredictorOf(const Scenario& scenario,
                                                      const Registries& registries,
                                                      std::shared_ptr<const sim::PadCourse> truth) {
  if (scenario.task == TaskKind::kGoTo) return std::make_unique<ToGoal>(scenario);
  const PredictorEntry& entry =
      PartNamed(registries.predictors, scenario.pad.prediction, "pad predictor");
  return MadeBy(entry, PredictorSetup{{scenario, entry.parameters}, std::move(truth)},
                "pad predictor");
}

sim::PadGeometry PadGeometryOf(const Scenario& scenario) {
  sim::PadGeometry geometry;
  geometry.deck_half_size = 0.5 * scenario.pad.deck_size;
  return geometry;
}

sim::AirframeExtras AirframeOf(const Scenario& scenario) {
  const Scenario::Airframe& frame = scenario.airframe;
  sim::AirframeExtras extras;
  extras.rotor_lag = frame.rotor_lag;
  extras.rotor_drag = frame.rotor_drag;
  extras.body_drag_area = frame.body_drag_area;
  extras.hull = frame.hull;
  extras.feet = frame.feet;
  extras.rotor_senses = frame.rotor_senses;
  extras.alternate_senses = frame.alternate_senses;
  extras.moment_max = frame.moment_max;
  return extras;
}

std::string VehicleMjcf(const Scenario& scenario) {
  if (scenario.vehicle == "default") return sim::DefaultVehicleMjcf();
  return sim::ImportVehicle(scenario.vehicle, AirframeOf(scenario));
}

std::vector<sim::VehicleFinding> VehicleWarnings(const Scenario& scenario) {
  if (scenario.vehicle == "default") return {};
  sim::VehicleFindings findings;
  const std::string mjcf = sim::ImportVehicle(scenario.vehicle, AirframeOf(scenario), &findings);
  sim::ReadVehicleModel(mjcf, &findings);
  return findings.warnings();
}

OutsideFiles OutsideFilesOf(const Scenario& scenario) {
  OutsideFiles files;
  if (scenario.pad.waypoints != "none") {
    files.pad_waypoints = WaypointText(ReadWaypointFile(scenario.pad.waypoints));
  }
  if (scenario.vehicle != "default") files.vehicle_hash = HashOf(VehicleMjcf(scenario));
  files.world_hash = WorldHash(scenario);
  return files;
}

TrialDraw DrawTrial(const Scenario& scenario, std::uint64_t seed) {
  TrialDraw draw;
  draw.seed = seed;
  sim::RandomStream start(seed, "start");
  for (int axis = 0; axis < 3; ++axis) {
    draw.p_WB[axis] = scenario.start.position[axis] +
                      scenario.start.position_spread[axis] * start.Uniform(-1.0, 1.0);
  }
  const double yaw = start.Uniform(-kPi, kPi);
  draw.yaw = scenario.start.yaw_random ? yaw : scenario.start.yaw_deg * estimation::kRadPerDeg;
  sim::RandomStream pad(seed, "pad");
  draw.phase = scenario.pad.phase + scenario.pad.phase_spread * pad.Uniform(-1.0, 1.0);
  const double direction = sim::RandomStream(seed, "wind direction").Uniform(-kPi, kPi);
  draw.wind_direction = scenario.wind.direction_random
                            ? direction
                            : scenario.wind.direction_deg * estimation::kRadPerDeg;
  return draw;
}

sim::WindConfig WindOf(const Scenario& scenario, const TrialDraw& draw) {
  const Scenario::Wind& wind = scenario.wind;
  sim::WindConfig config;
  config.mean = wind.mean;
  config.max = wind.max > 0.0 ? wind.max : wind.mean;
  config.direction = draw.wind_direction;
  config.gust = {wind.gust.speed, wind.gust.start, wind.gust.duration, wind.gust.period};
  return config;
}

sim::WorldConfig WorldOf(const Scenario& scenario, const TrialDraw& draw,
                         const Registries& registries) {
  sim::WorldConfig config;
  std::vector<sim::Obstacle> obstacles;
  for (NamedObstacle& named : ObstaclesOf(scenario)) obstacles.push_back(named.obstacle);
  config.obstacles = sim::ObstacleField(std::move(obstacles));
  config.pad = PadGeometryOf(scenario);
  config.pad_motion.p_start.z() = scenario.pad.deck_height;
  config.pad_course = PadCourseOf(scenario, registries, draw.phase, draw.seed);
  config.vehicle_mjcf = VehicleMjcf(scenario);
  config.plant = scenario.plant;
  config.ground_effect = scenario.air.ground_effect;
  config.start.p_WB = draw.p_WB;
  config.start.q_WB = Eigen::AngleAxisd(draw.yaw, Eigen::Vector3d::UnitZ());
  // The flight begins with a hover, in the wind of its first step; wake and ground effect are left out.
  config.hover_air_W =
      sim::Wind(WindOf(scenario, draw), draw.seed).Step(config.start, config.timestep);
  return config;
}

}  // namespace touchdown::evaluation
