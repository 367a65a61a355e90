// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "control/onboard/own_state.h"
#include "control/tracking/disturbance_observer.h"
#include "control/tracking/mixer.h"
#include "control/tracking/rotor_lead.h"
#include "control/tracking/settling.h"
#include "control/tracking/yaw_planner.h"
#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/onboard/replan_request.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/planning/look/scout.h"
#include "touchdown/planning/replan/planner.h"

namespace touchdown::control {

/// A plan that ends in contact. It ends `level_time` [s] before it, level, sinking with
/// `touchdown_rate` [m/s].
planning::EndpointTarget ContactTarget(const estimation::VehicleModel& model, double touchdown_rate,
                                       double level_time);
/// Between a plan's end and contact in still air, in which the tilt dies away [s].
inline constexpr double kLevelTime = 0.15;

/// Of one control step.
struct PilotCommand {
  ControlOutput law;
  MixerOutput mix;                ///< rotor thrusts [N]
  planning::FlatState reference;  ///< as committed
  bool level = false;             ///< without knowing how the vehicle is
};

/// What an Onboard does with what it knows: mission, replanning, heading, tracking.
class Pilot {
 public:
  /// The flight begins with a hover at `start`, for which the rotors are told `start_thrusts` [N].
  /// `parts` and `options` are to outlive it. @throws std::invalid_argument if the feet have no room on the deck.
  Pilot(const OnboardOptions& options, const OnboardParts& parts,
        const estimation::VehicleState& start, const estimation::Commands& start_thrusts,
        const planning::OccupancyMap& map);

  /// Mission and heading, by what the vehicle knows of itself. `depth_age`: of the last depth image [s]. Call at a
  /// fixed rate.
  void StepMission(const OwnState& own, const estimation::PadFilter& filter, double depth_age,
                   double foot_force, double dt);

  /// Time has passed in which nothing was flown. A reference that leapt may lead through the deck: the vehicle brakes,
  /// with the acceleration that it had [m/s^2], until there is a new plan.
  void Resume(const estimation::VehicleState& vehicle, const Eigen::Vector3d& a_WB);

  /// One replanning step while flying, to the pad or to rest as the mission wants. nullptr while
  /// hovering or disarmed, and where the planner had nothing to do. Call at replan_rate, or at
  /// close_rate where it `plans_often`. The planner owns the result until the next.
  const planning::ReplanResult* Replan(const estimation::VehicleState& vehicle,
                                       const estimation::PadFilter& filter,
                                       const std::vector<planning::LookCamera>& cameras,
                                       const planning::OccupancyMap& map);

  /// What is commanded in this control step. Once per step: the disturbance is estimated from it.
  PilotCommand Control(const OwnState& own);
  /// What is flown at time t without knowing how the vehicle is: level, hover thrust, no moment. No rotor thrusts yet.
  PilotCommand Level(double t) const;
  /// The same with thrusts, for as long as it takes.
  PilotCommand Hold(double t);

  /// What the tracking law compensates; nothing where it is not estimated.
  Disturbance disturbance() const;

  /// Committed reference with heading at time t.
  planning::FlatState Reference(double t) const;

  const MissionOutputs& mission() const { return mission_; }
  const OnboardReplan& last_replan() const { return replan_; }
  std::optional<planning::NoWay> no_way() const;
  std::string_view look_words() const;
  /// What the landing planner remembers before its next step; empty with any other. Allocates.
  planning::ReplannerState replanner_state() const;
  bool plan_valid(double t) const;
  /// The planner was asked in the last Replan, and had nothing to do.
  bool idle() const { return idle_; }
  /// To contact, or away from a deck that is near: Replan is to be called at close_rate.
  bool plans_often() const;

 private:
  ControlOutput Blind(double t, const planning::FlatState& reference) const;
  ControlOutput Tracked(const estimation::VehicleState& vehicle,
                        const planning::FlatState& committed);
  bool arriving() const;
  double TiltMost(const estimation::VehicleState& vehicle) const;
  double HeadingAhead(const estimation::VehicleState& vehicle,
                      const estimation::PadFilter& filter) const;
  double Seeing(double heading, const Eigen::Vector3d& p_WB) const;
  double DesiredHeading();
  planning::EndpointTarget Endpoint(double t) const;
  double Latency() const;
  bool DeliverLate(double t);
  bool Levelled(double t) const;
  bool Landing() const;
  Eigen::Vector3d WayAt(double t) const;
  double LeanAtContact(double arrival_in) const;
  double LevelTime(const Eigen::Vector3d& pull_W) const;
  double TouchdownRate(const Eigen::Vector3d& pull_W) const;
  bool to_goal() const;
  bool KnowsTarget(const estimation::PadFilter& filter) const;
  bool IsSureOfTarget(const estimation::PadFilter& filter, double t) const;
  estimation::PadState TargetAt(const estimation::PadFilter& filter, double t) const;
  bool WantsPlan(const estimation::PadFilter& filter, double t) const;
  double RestClimb() const;
  const planning::ReplanResult& Ask(bool for_plan, const estimation::PadFilter& filter,
                                    const std::vector<planning::LookCamera>& cameras,
                                    const planning::OccupancyMap& map);

  const OnboardOptions& options_;
  const OnboardParts& parts_;
  const estimation::VehicleModel& model_;
  Mixer mixer_;
  std::optional<RotorLead> lead_;  ///< the paper's law has none
  std::optional<DisturbanceObserver> observer_;
  Settling settling_;
  MissionParameters parameters_;
  MissionState mission_state_;
  MissionOutputs mission_;
  YawState yaw_;
  double yaw_t_ = 0.0;                     ///< time of yaw_
  double foot_force_ = 0.0;                ///< as it was last told [N]
  double foot_height_ = 0.0;               ///< of the feet above the deck, as last estimated [m]
  bool at_deck_ = false;                   ///< the feet are close over the deck, or on it
  bool blown_off_ = false;                 ///< ... and the vehicle far off a way that does not land
  double heading_ahead_ = 0.0;             ///< of the way that is flown [rad]
  std::optional<Eigen::Vector3d> look_W_;  ///< what the next stops need to have seen
  std::optional<planning::Viewpoint> looks_from_;  ///< it flies there to look
  double heading_ = 0.0;                   ///< that is steered for [rad]
  bool leans_ = false;                     ///< the heading is chosen by the wind
  OnboardReplan replan_;
  bool own_usable_ = true;  ///< the own state is good enough to fly to the pad by
  bool sees_ = true;        ///< depth images come
  bool has_plan_ = false;
  bool idle_ = false;
  bool out_of_reach_ = false;                      ///< the pad drives away: no look would help
  bool at_goal_ = false;                           ///< the last step made no plan: the goal is near
  bool rests_ = false;                             ///< that was wanted, and is so
  const planning::UniformBspline* way_ = nullptr;  // of the latest plan, the planner's own
  bool lands_ = false;                             // what is flown ends in contact
  double own_position_sigma_ = 0.0, own_attitude_sigma_ = 0.0;
  planning::RecentError recent_error_;      // of tracking
  std::optional<double> meets_vehicle_at_;  // the reference does, that of a plan from the vehicle
  bool last_planned_ = false;          ///< the last replanning step left no plan to be wished for
  std::optional<double> planned_t_;    ///< when the last new plan was made
  std::optional<double> requested_t_;  ///< since when plans are asked for without a break
  /// When the committed plan that leads to contact ends [s]; infinite if there is none.
  double plan_end_t_ = std::numeric_limits<double>::infinity();
  double touchdown_rate_ = 0.0;    ///< with which a planned landing meets the deck [m/s]
  double level_time_ = 0.0;        ///< from there to contact [s]
  double measured_latency_ = 0.0;  ///< of the last replanning step [s]
  double busy_until_ = -std::numeric_limits<double>::infinity();  ///< with a late step [s]
};

}  // namespace touchdown::control
