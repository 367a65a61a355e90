// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "planning/baselines/ego/ego_plan.h"
#include "planning/baselines/ego/ego_reference.h"
#include "touchdown/planning/replan/planner.h"

namespace touchdown::planning {

/// Modes of the published state machine. Its INIT is over once the vehicle hovers.
enum class EgoMode {
  kWaitTarget,     ///< no goal, or the trajectory to it is over
  kGenerate,       ///< plans from the vehicle's own state
  kExecute,        ///< flies the trajectory
  kReplan,         ///< plans from the trajectory, which is flown meanwhile
  kEmergencyStop,  ///< stands where it was
};
const char* ToString(EgoMode mode);

struct EgoPlannerOptions {
  EgoOptions plan;
  double goal_rate = 5.0;  ///< the pad's position is sent as a new goal so often [Hz]
  bool goal_velocity =
      false;  ///< the goal is to be reached with the pad's velocity (`ego-velocity`)
  double floor_height = 0.0;  ///< lowest free height of the body's origin [m]; goals may lie lower
  double ceiling_height = 10.0;  ///< highest one [m]
};

/// The EGO-Planner baseline in the closed loop: its state machine with goals that follow the pad. Call Replan at
/// kRate. The goal is the pad's position when it is sent, at the endpoint's height. Nothing is certified. Differences
/// from the published system:
/// - A plan asked for at t_now starts on the committed trajectory at t_start and takes over there, as
///   this project's own planner does. The state machine waits for it.
/// - A call whose search ran into its limit is repeated after the published limit of 0.2 s at the
///   earliest.
/// - The map is this project's.
class EgoPlanner : public Planner {
 public:
  static constexpr double kRate = 100.0;       ///< of the state machine [Hz]
  static constexpr double kSafetyRate = 20.0;  ///< of the collision check [Hz]

  /// Throws std::invalid_argument if an option is out of range.
  explicit EgoPlanner(const EgoPlannerOptions& options);

  void CommitHover(const Eigen::Vector3d& p_W, double t) override;
  /// One step of the state machine: `idle` unless it made a plan call or stopped.
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) override;
  /// No new goal: the trajectory is flown to its end, where the vehicle stays; a climb is one goal.
  const ReplanResult& Rest(const ReplanInput& input, double climb,
                           const OccupancyMap& map) override;
  void TakeOverAt(double t) override;
  /// Position, velocity and acceleration, as published: the jerk is zero. Past its end a trajectory's
  /// last point is held with zero velocity.
  FlatState Reference(double t) const override;

  EgoMode mode() const { return mode_; }

 private:
  void SetGoal(const ReplanInput& input, const Eigen::Vector3d& goal,
               const Eigen::Vector3d& v_goal);
  void Begin(const ReplanInput& input);
  const ReplanResult& Refuse(const ReplanInput& input);
  const ReplanResult& Step(const ReplanInput& input, const OccupancyMap& map);
  void CheckSafety(const ReplanInput& input, const EgoGrid& grid);
  void Execute(const ReplanInput& input, const EgoGrid& grid);
  bool PlanFromVehicle(const ReplanInput& input, const EgoGrid& grid);
  bool PlanFromCurve(const ReplanInput& input, const EgoGrid& grid);
  bool Call(const ReplanInput& input, const SplineState& start, EgoGuess guess,
            const EgoGrid& grid);
  void Stop(const ReplanInput& input);
  const UniformBspline& InForce(double t) const { return t < takes_over_ ? current_ : next_; }

  EgoPlannerOptions options_;
  EgoPlan plan_;
  EgoReference reference_;
  EgoMode mode_ = EgoMode::kWaitTarget;
  UniformBspline current_, next_;
  double takes_over_ = 0.0;      // next_ does [s]
  bool has_trajectory_ = false;  // next_ is a plan, not a hover
  bool has_goal_ = false;
  bool new_goal_ = false;               // no plan call was made for it yet
  bool may_stop_ = true;                // the emergency stop is armed
  int tries_ = 0;                       // in a row, in kGenerate
  double next_goal_t_, next_safety_t_;  // due then [s]
  double next_call_t_;                  // no plan call before [s]
  double busy_until_;                   // a plan call is under way [s]
  std::optional<double> climb_;         // goal of a rest already sent
  ReplanResult result_;
};

}  // namespace touchdown::planning
