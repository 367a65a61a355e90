// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"
#include "sim/pad/pad_geometry.h"
#include "sim/pad/pad_motion.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/sim/vehicle/plant.h"

namespace touchdown::sim {

/// Everything a World is built from, as plain data.
struct WorldConfig {
  ObstacleField obstacles;
  PadGeometry pad;
  PadMotionConfig pad_motion;
  /// If set, it drives the pad instead, on a deck as high as pad_motion says.
  std::shared_ptr<const PadCourse> pad_course;
  std::string vehicle_mjcf;        ///< text of the vehicle's MJCF file; empty: DefaultVehicleMjcf()
  estimation::VehicleState start;  ///< state at t = 0; its time stamp is not read
  /// If given, the vehicle comes out of a hover in air of this velocity [m/s]. Then only the yaw of
  /// the start's attitude counts, and the rotors have the thrust that balances the wind. Where they
  /// cannot balance it, the start is as without it.
  std::optional<Eigen::Vector3d> hover_air_W;
  double timestep = 0.002;     ///< [s], in [1e-4, 0.005]
  PlantFactors plant;          ///< how the simulated vehicle differs from its file
  bool ground_effect = false;  ///< of the rotors over the deck and the ground
};

/// What drives the pad of this world. Throws std::invalid_argument as PadMotion does.
std::shared_ptr<const PadCourse> CourseOf(const WorldConfig& config);

/// Kinds of contact.
enum class ContactKind {
  kFootDeck,    ///< a foot on the deck: how a landing looks
  kHullDeck,    ///< any other part of the vehicle on the deck
  kPadVehicle,  ///< any part of the vehicle on the pad vehicle's body below the deck
  kObstacle,  ///< any part of the vehicle on an obstacle; it is not pushed back, the flight is over
  kGround,    ///< any part of the vehicle on the ground
};

/// Name as used in results: "foot-deck", "hull-deck", "pad-vehicle", "obstacle", "ground".
const char* ToString(ContactKind kind);

/// One contact point of the step just taken.
struct Contact {
  ContactKind kind = ContactKind::kGround;
  int obstacle = -1;                                  ///< index in the field for kObstacle, else -1
  double normal_force = 0.0;                          ///< [N]; of an obstacle 0
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();      ///< contact point [m]
  Eigen::Vector3d v_rel_W = Eigen::Vector3d::Zero();  ///< vehicle's point minus the other's [m/s]
};

/// The simulated world: quadrotor, pad vehicle, obstacles, ground, contact, drag. One World belongs
/// to one thread; any number of them can run side by side. Deterministic: the same configuration
/// and commands give the same bits.
class World {
 public:
  /// Rotors start at the thrust of a hover, the pad on its path at its speed.
  /// @throws std::invalid_argument naming the thing, its value and the allowed range. A start in contact with an
  /// obstacle or the ground is such a fault, and so is ground effect for rotors without a radius.
  explicit World(const WorldConfig& config);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Advances one time step. Allocates only where an obstacle is within the vehicle's reach.
  /// @param rotor_thrust_commands per rotor [N]; clipped to the rotors' limits, reached with their
  /// lag.
  /// @param wind_W velocity of the air [m/s].
  /// @throws std::invalid_argument if a command or the wind is not finite, std::runtime_error if
  /// the physics failed (the message says how). Such a World throws at every later step too.
  void Step(const estimation::Commands& rotor_thrust_commands,
            const Eigen::Vector3d& wind_W = Eigen::Vector3d::Zero());

  double time() const;                            ///< steps taken times the time step [s]
  double timestep() const;                        ///< [s]
  const estimation::VehicleModel& model() const;  ///< as its file says: what may be known of it
  const estimation::VehicleModel& plant() const;  ///< as it is simulated
  const std::shared_ptr<const PadCourse>& pad_course() const;
  /// How far the pad may be off its motion while nothing lands on it. Its drive needs a force, so it lags.
  struct PadLag {
    double position = 0.0;  ///< [m]
    double velocity = 0.0;  ///< [m/s]
    double yaw = 0.0;       ///< [rad]
    double yaw_rate = 0.0;  ///< [rad/s]
  };
  PadLag MaxPadLag() const;
  const WorldConfig& config() const;

  /// True state of the vehicle now.
  estimation::VehicleState vehicle() const;

  /// True state of the pad now, read from its joints: p, v, yaw and yaw rate. a is that of the step
  /// just taken; j is unknown and zero. The yaw is not wrapped.
  estimation::PadState pad() const;

  /// Thrust of each rotor now, after its lag [N].
  estimation::Commands rotor_thrusts() const;

  /// The rotors' commands after their lag [N]. The thrusts of a plant differ from them.
  estimation::Commands rotor_commands() const;

  /// Drag applied in the step just taken, in W [N].
  Eigen::Vector3d drag_force() const;

  /// Thrust that the ground effect added to the rotors in the step just taken, in total [N].
  double ground_effect_thrust() const;

  /// Contacts of the step just taken. Positions, velocities and forces are those at its beginning.
  /// So the step in which a contact first appears holds the velocity before the impact.
  const std::vector<Contact>& contacts() const;

  /// Sum of the normal forces on the feet in the step just taken, whatever they stand on.
  estimation::FootForce foot_force() const;

  /// Velocity of the vehicle's centre relative to the deck point below it, in W [m/s], now.
  Eigen::Vector3d velocity_over_deck() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::sim
