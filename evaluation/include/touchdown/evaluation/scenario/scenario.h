// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "touchdown/evaluation/scenario/registries.h"
#include "touchdown/sim/vehicle/plant.h"

namespace touchdown::evaluation {

enum class PadEstimatorKind { kPaper, kTurnRate };
enum class TaskKind { kLand, kFollow, kGoTo };
enum class DescentKind { kVertical, kPlanned };
/// The words of the keys.
const char* ToString(TaskKind kind);
const char* ToString(DescentKind kind);
enum class SensingKind { kFast, kRendered };
enum class OwnStateKind { kTrue, kEstimated };
enum class ObservedFreeKind { kSensed, kTruth };
enum class ArrivalKind { kFixed, kFree };
enum class EndpointVelocityKind { kPad, kRest };
enum class EndpointKind { kEliminated, kExplicit };
enum class LimitsKind { kSoft, kHard };

/// A depth camera on the vehicle.
struct DepthMount {
  Eigen::Vector3d position = {0.1, 0.0, 0.0};  ///< in B [m]
  double yaw_deg = 0.0;                        ///< of its axis, to the left of the nose [deg]
  double pitch_deg = 0.0;                      ///< ... and below it [deg]
  double fov_deg = 90.0;                       ///< horizontal [deg]
  double rate = 10.0;                          ///< [Hz]
};

/// A box, turned about its middle.
struct BoxObstacle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();    ///< of its base in W [m]
  Eigen::Vector3d size = Eigen::Vector3d::Ones();      ///< edges along x, y, z [m]
  double base = 0.0;                                   ///< of its lower face above the ground [m]
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw [deg]
};

/// An upright cylinder.
struct CylinderObstacle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of its base in W [m]
  double radius = 0.3;                               ///< [m]
  double height = 4.0;                               ///< [m]
  double base = 0.0;                                 ///< of its lower face above the ground [m]
};

struct SphereObstacle {
  Eigen::Vector3d centre = Eigen::Vector3d::UnitZ();  ///< in W [m]
  double radius = 0.3;                                ///< [m]
};

/// Upright walls from point to point.
struct WallObstacle {
  std::vector<double> points;  ///< x, y of each, in W [m]
  double thickness = 0.2;      ///< [m]
  double height = 3.0;         ///< [m]
  double base = 0.0;           ///< of its lower face above the ground [m]
};

/// The solids of a triangle mesh in a file.
struct MeshObstacle {
  std::string file;
  double scale = 1.0;                                  ///< metres to the file's unit
  Eigen::Vector3d at = Eigen::Vector3d::Zero();        ///< of the file's origin in W [m]
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw [deg]
};

/// Ground by a grey picture of its heights.
struct HeightFieldObstacle {
  std::string file;
  Eigen::Vector2d size = Eigen::Vector2d::Constant(10.0);  ///< along x and y [m]
  double height = 1.0;                                     ///< of white above black [m]
  Eigen::Vector3d at = Eigen::Vector3d::Zero();            ///< of its middle, at black, in W [m]
  double yaw_deg = 0.0;                                    ///< [deg]
};

/// The occupied cells of an OctoMap file.
struct OctomapObstacle {
  std::string file;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();                ///< of the file's origin in W [m]
  double yaw_deg = 0.0;                                        ///< [deg]
  Eigen::Vector3d crop_min = Eigen::Vector3d::Constant(-1e4);  ///< in the file's frame [m] ...
  Eigen::Vector3d crop_max = Eigen::Vector3d::Constant(1e4);   ///< ... cells' middles within count
};

/// Time from the question to the plan that is flown.
struct PlanningLatency {
  bool measured = false;  ///< the wall clock's own figure: flies alone, does not repeat bit by bit
  double ms = 20.0;       ///< otherwise this
};

/// Everything that decides a trial, together with the seed. Plain data in SI units; keys, ranges
/// and documentation stand once, in scenario_schema. The defaults here are the schema's defaults.
struct Scenario {
  Scenario();

  std::string name;         ///< stem of the file it came from; not a key
  std::string description;  ///< in words, of one line; has no influence

  struct Pad {
    std::string motion = "straight_turn";               ///< of Registries::pad_motions
    double speed = 0.8;                                 ///< [m/s]
    Eigen::Vector2d start = Eigen::Vector2d(7.0, 6.5);  ///< pad centre at t = 0, phase 0, in W [m]
    double heading_deg = 0.0;                           ///< of the first leg [deg]
    double turn_start = 5.0;                            ///< driven before the turn begins [m]
    double turn_deg = 90.0;                             ///< left positive [deg]
    double turn_rate = 0.25;                            ///< circle: left positive [rad/s]
    double go_time = 8.0;                               ///< stop_and_go, reversing [s]
    double stop_time = 5.0;                             ///< stop_and_go [s]
    double acceleration = 0.5;                          ///< of changing speeds [m/s^2]
    double jerk = 1.0;                                  ///< random, waypoints [m/s^3]
    std::string waypoints = "none";                     ///< path of a CSV file
    double phase = 0.0;                                 ///< path travelled before t = 0 [m]
    double phase_spread = 0.0;                          ///< drawn per trial: uniform in +- this [m]
    double deck_size = 1.5;                             ///< edge of the square deck [m]
    double deck_height = 0.5;                           ///< upper face above the ground [m]
    std::string prediction = "turn_rate";               ///< of Registries::predictors
  } pad;

  struct Start {
    Eigen::Vector3d position = Eigen::Vector3d(0.0, 0.0, 2.5);  ///< of the vehicle in W [m]
    Eigen::Vector3d position_spread =
        Eigen::Vector3d::Zero();  ///< uniform in +- this, per axis [m]
    double yaw_deg = 0.0;         ///< [deg]
    bool yaw_random = false;      ///< drawn from the whole circle
  } start;

  struct Gps {
    double sigma = 0.01;                               ///< [m]
    double rate = 10.0;                                ///< [Hz]
    Eigen::Vector2d outage = Eigen::Vector2d::Zero();  ///< no fix from the first to the second [s]
    double outliers = 0.0;                             ///< probability of each fix
    double outlier_size = 10.0;                        ///< [m]
  } gps;
  double tag_rate = 20.0;    ///< [Hz]
  double depth_rate = 10.0;  ///< [Hz]
  /// Downward camera.
  struct Camera {
    int width = 320;                                   ///< [pixel]
    int height = 240;                                  ///< [pixel]
    double fov_deg = 90.0;                             ///< vertical [deg]
    double noise = 2.0;                                ///< of a pixel [grey level]
    double exposure_ms = 0.0;                          ///< [ms]
    double latency_ms = 0.0;                           ///< [ms]
    double drop = 0.0;                                 ///< probability of each image
    Eigen::Vector2d outage = Eigen::Vector2d::Zero();  ///< no image from first to second [s]
    double occlusion = 0.0;  ///< share of the pad's printed sheet that is covered
  } camera;
  /// Depth cameras.
  struct Depth {
    int width = 80;           ///< [pixel]
    int height = 60;          ///< [pixel]
    double range = 6.0;       ///< [m]
    double noise = 0.0;       ///< standard deviation of a range over the range
    double latency_ms = 0.0;  ///< [ms]
    double drop = 0.0;        ///< probability of each image
    Eigen::Vector2d outage = Eigen::Vector2d::Zero();  ///< no image from first to second [s]
    std::vector<DepthMount> cameras;                   ///< empty: one at the nose, at depth_rate
  } depth;
  SensingKind sensing = SensingKind::kFast;
  OwnStateKind own_state = OwnStateKind::kTrue;
  /// The vehicle's own sensors where own_state is estimated; docs/own_state.md says what they are.
  struct Own {
    double imu_noise = 1.0;  ///< factor on the noise and the biases of the IMU
    struct OwnGps {
      double rate = 10.0;                                ///< [Hz], 0: none
      double sigma = 0.02;                               ///< horizontal [m]
      double drift = 0.0;                                ///< of an error with memory [m]
      double latency_ms = 100.0;                         ///< [ms]
      Eigen::Vector2d outage = Eigen::Vector2d::Zero();  ///< no fix from first to second [s]
    } gps;
    struct Odometry {
      double rate = 0.0;    ///< [Hz], 0: none
      double sigma = 0.03;  ///< [m/s]
      double drift = 0.01;  ///< of an error with memory [m/s]
    } odometry;
    struct Height {
      double rate = 25.0;  ///< [Hz], 0: none
      double sigma = 0.1;  ///< [m]
    } height;
    struct Heading {
      double rate = 25.0;      ///< [Hz], 0: none
      double sigma_deg = 2.0;  ///< [deg]
    } heading;
  } own;
  PadEstimatorKind pad_estimator = PadEstimatorKind::kTurnRate;

  /// An OctoMap file that is known before the flight, or none.
  std::string map_prior = "none";
  ObservedFreeKind map_observed_free = ObservedFreeKind::kSensed;
  double map_thinnest_obstacle = 0.1;  ///< [m]
  /// Around the start, in all directions [m]. The camera sees the edge of the hull's way only from 0.7 m ahead; one
  /// cell is spare.
  double map_start_free = 0.8;

  /// The air; without any of it, it stands still.
  struct Wind {
    double mean = 0.0;             ///< speed of the mean wind [m/s]
    double max = 0.0;              ///< greatest speed with turbulence [m/s]; 0: steady wind
    double direction_deg = 0.0;    ///< where it blows to, from x_W, left positive [deg]
    bool direction_random = true;  ///< drawn from the whole circle instead
    struct Gust {
      double speed = 0.0;     ///< [m/s], 0: none
      double start = 5.0;     ///< of the first one [s]
      double duration = 2.0;  ///< [s]
      double period = 0.0;    ///< [s], 0: one only
    } gust;
  } wind;
  struct Air {
    bool ground_effect = false;
    bool pad_wake = false;
  } air;
  sim::PlantFactors plant;  ///< how the vehicle differs from what its pilot knows

  std::string controller = "geometric";  ///< of Registries::controllers
  struct Control {
    bool disturbance = true;  ///< the controller geometric compensates what it estimates
  } control;
  TaskKind task = TaskKind::kLand;
  /// Of the task follow: above the pad's centre.
  struct Follow {
    double time = 10.0;     ///< without a break, until it is done [s]; 0: when the time is up
    double distance = 0.5;  ///< horizontal [m]
  } follow;
  /// Of the task go_to.
  struct GoTo {
    Eigen::Vector3d goal =
        Eigen::Vector3d(6.0, 0.0, 2.0);  ///< of the body's origin at t = 0, in W [m]
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the goal [m/s]
    double time = 1.0;       ///< there without a break, until it is done [s]
    double distance = 0.15;  ///< [m]
  } go_to;
  DescentKind descent = DescentKind::kPlanned;
  struct Mission {
    double corridor_radius = 0.12;  ///< horizontal error at the deck with which it sinks [m]
  } mission;
  std::string planner = "landing";  ///< of Registries::planners
  struct Planning {
    double rate = 10.0;  ///< [Hz]
    PlanningLatency latency;
    double clearance = 0.40;       ///< obstacles are grown by this in the map [m]
    double ceiling = 10.0;         ///< the body's origin stays below this [m]
    double segment_length = 0.75;  ///< of a plan's segment at full speed, at most [m]
    int guides = 2;                ///< most ways around the first obstacle that a step tries
    double max_duration = 30.0;    ///< of a plan; ends that are later are approached in parts [s]
    int max_work = 10000;          ///< of a step, in units of planning/search/work_budget.h
    EndpointVelocityKind endpoint_velocity = EndpointVelocityKind::kPad;
    bool warm_start = true;  ///< solves begin at the committed plan
  } planning;

  /// Parameters of planners, pad motions, controllers and predictors, by key. One that is not here has the part's
  /// default.
  std::map<std::string, double> parameters;

  std::string own_solver;  ///< of a planner that has no choice; not a key
  /// What solves.
  const std::string& solver_name() const {
    return own_solver.empty() ? solver.backend : own_solver;
  }

  struct Solver {
    std::string backend = "banded";
    ArrivalKind arrival = ArrivalKind::kFree;
    EndpointKind endpoint = EndpointKind::kEliminated;
    LimitsKind limits = LimitsKind::kSoft;
    double gap = 0.005;  ///< to the optimum, at which a solve ends, share of the cost
    std::map<std::string, double> options;  ///< of the backend, by its own names
  } solver;
  /// Keys `terms.TERM.KEY`: weight, hard (0 or 1) or a parameter of the term.
  std::map<std::string, std::map<std::string, double>> terms;

  struct Limits {
    double speed = 3.0;         ///< [m/s]
    double acceleration = 6.0;  ///< [m/s^2]
    double tilt_deg = 35.0;     ///< [deg]
  } limits;

  std::string vehicle = "default";  ///< or the path of an MJCF file
  /// What an MJCF file in the common form does not say; see sim/vehicle/vehicle_import.h.
  struct Airframe {
    double rotor_lag = 0.03;                         ///< [s]
    double rotor_drag = 0.0;                         ///< linear, along x and y of B [N s/m]
    double body_drag_area = 0.0;                     ///< [m^2]
    Eigen::Vector3d hull = Eigen::Vector3d::Zero();  ///< radius, bottom, top; 0: from the geoms [m]
    Eigen::Vector2d feet = Eigen::Vector2d::Zero();  ///< radius, depth; 0: from the hull [m]
    std::vector<double> rotor_senses;                ///< +1 or -1; empty: the file's
    bool alternate_senses = false;                   ///< where those of the file cannot steer
    Eigen::Vector3d moment_max = Eigen::Vector3d::Zero();  ///< 0: the file's [N m]
  } airframe;
  double timeout = 60.0;     ///< [s]
  double stand_limit = 0.0;  ///< a flight that stands for so long is over [s]; 0: never
  std::uint64_t seed = 1;

  std::vector<BoxObstacle> boxes;
  std::vector<CylinderObstacle> cylinders;
  std::vector<SphereObstacle> spheres;
  std::vector<WallObstacle> walls;
  std::vector<MeshObstacle> meshes;
  std::vector<HeightFieldObstacle> height_fields;
  std::vector<OctomapObstacle> octomaps;
};

/// One plan is to lead to contact.
inline bool PlansContact(const Scenario& scenario) {
  return scenario.task == TaskKind::kLand && scenario.descent == DescentKind::kPlanned;
}

/// Reads `path` through the schema, then applies `overrides` ("pad.speed=1.2") in order, then
/// checks the whole against what `registries` know. @throws BadInput.
Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides,
                      const Registries& registries);

/// The same from the text of a scenario file. `file` stands in sentences, `name` is the scenario's.
Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& file,
                       const std::vector<std::string>& overrides, const Registries& registries);

/// One override ("pad.speed=1.2") of a scenario that is there already. Checks the value alone,
/// and suits no other key to it.
/// @throws BadInput.
void ApplyOverride(const std::string& text, const Registries& registries, Scenario* scenario);

/// The effective scenario as YAML that LoadScenario reads back to the same values.
std::string DumpScenario(const Scenario& scenario);

}  // namespace touchdown::evaluation
