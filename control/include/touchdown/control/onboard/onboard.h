// SPDX-License-Identifier: BSD-3-Clause
// The part that would fly: measurements in, set-points out.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "touchdown/control/mission/landing_state_machine.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/onboard/replan_request.h"
#include "touchdown/control/onboard/step_time.h"
#include "touchdown/control/onboard/taken.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_arrival.h"
#include "touchdown/planning/look/no_way.h"
#include "touchdown/planning/spline/flatness.h"

namespace touchdown::control {

/// What the vehicle is to do from now on, at three depths. A vehicle with an autopilot takes the middle or the last.
struct Setpoint {
  double t = 0.0;                ///< of the last Step that was not refused [s]
  double valid_until = 0.0;      ///< later nobody may fly it: what it answers is too long ago [s]
  bool armed = true;             ///< false: the rotors are to stand still, however old it is
  bool level = false;            ///< made without an own state or a time: hover thrust, no moment
  estimation::Commands thrusts;  ///< of the actuators, in the model's order [N], of moments [N m]
  bool saturated = false;        ///< of those, one is at a limit
  Wrench wrench;                 ///< collective thrust and moment
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< the attitude that the law wants
  planning::FlatState reference;                       ///< p, v, a, j, yaw of the committed plan

  /// It may be flown now, by the caller's clock [s]. Else the vehicle levels out by its own means, with hover thrust.
  bool CountsAt(double now) const { return !armed || (now >= t && now <= valid_until); }
};

/// How it stands at the end of the last Step. If that was refused, only `time` and `mission_step` (false) are new.
struct OnboardStatus {
  StepTime time = StepTime::kGood;  ///< what became of the last Step's time
  MissionOutputs mission;           ///< mode, and of the last step of the mission why it changed
  bool mission_step = false;        ///< ... which was in the last Step
  estimation::OwnStatus own = estimation::OwnStatus::kAligning;
  double foot_force = 0.0;  ///< as it counts: forgotten where no newer one comes [N]
  bool pad_known = false;   ///< it has been measured; a goal always is
  bool pad_sure = false;    ///< ... well enough to land by
  bool plan_valid = false;  ///< what is flown is no older than the mission allows
  std::optional<planning::NoWay> no_way;  ///< the scout knows no way to a target that stands
  std::string_view look;  ///< why the last look began, or how it ended; empty: there was none
};

/// What was asked of the planner in the last Step; nullptr: nothing.
struct OnboardPlan {
  const OnboardReplan* asked = nullptr;
  const planning::ReplanResult* answer = nullptr;  ///< the planner's own, until its next
  planning::ReplannerState
      before;         ///< what a Replanner remembered before, where it is asked to be kept
  bool idle = false;  ///< asked, and it had nothing to do: there is no answer
};

/// Thread CPU time since the beginning [s].
struct OnboardTimes {
  double control = 0.0, planning = 0.0;
};

/// A vehicle's own software: own state, pad filter, map, mission, planner, tracking law. It uses no clock except the
/// time stamps, no file, no thread and no simulator. One instance per vehicle; the thread may change between calls.
/// Times are those of the caller's clock. Only inside of own(), pad(), plan() and map() they are FlightTime.
///
/// Take() whatever has come, in any order; Step() at the rate of the tracking law, 500 Hz by default of the laws'
/// gains. The first state must be a hover: Begin() takes it over. The same calls give the same bits (except with
/// PlanLatency::measured). In flight nothing allocates: the first steps make the room that is kept. A moved-from
/// instance may only be assigned or destroyed.
class Onboard {
 public:
  /// @throws std::invalid_argument naming the first option out of its range, or the part that is missing.
  Onboard(OnboardOptions options, OnboardParts parts);
  ~Onboard();
  Onboard(Onboard&&) noexcept;
  Onboard& operator=(Onboard&&) noexcept;

  /// The own state, if it is given, or the measurements that it is estimated from. Before the
  /// flight the time is not known. A state that is older than the history then counts as a new
  /// beginning, and the states before it are forgotten.
  Taken Take(const estimation::VehicleState& state);
  Taken Take(const estimation::ImuSample& sample);
  Taken Take(const estimation::OwnPositionFix& fix);
  Taken Take(const estimation::OwnVelocityFix& fix);
  Taken Take(const estimation::HeightSample& sample);
  Taken Take(const estimation::HeadingSample& sample);
  /// The pad, by its GPS and by its tags: as they were found, or to be found in an image, which allocates.
  Taken Take(const estimation::PadGpsFix& fix);
  Taken Take(const estimation::PadSighting& sighting);
  Taken Take(const estimation::PadImage& image);
  /// Obstacles. Returns from the pad are distinguished.
  Taken Take(const estimation::DepthImage& image);
  Taken Take(const estimation::FootForce& force);

  /// How many measurements became what, by Taken.
  const std::array<int, kTakenKinds>& taken() const;

  /// The flight begins, once: the vehicle hovers at the time t [s], in [0, 1e10], with these rotor
  /// thrusts [N]. States that are later than t, by more than a moment, are forgotten.
  /// @throws std::invalid_argument if its state at t is unknown or not below the ceiling, if the
  /// flight has begun, or if a time or thrust is out of range.
  void Begin(double t, const estimation::Commands& thrusts);

  /// The set-point for the time t [s], later than that of the last step by at most 0.1 s. A step at another time is
  /// refused: the last set-point again, after 50 in a row a level one. Until one is taken, measurements of pad and depth
  /// are invalid. The fifth of those that go on from each other by at most 0.1 s is taken. If it is later by at most
  /// 10 s, that time has passed; else t may be of another clock, and 10 s count as passed. Then given own states are
  /// forgotten, and the committed plan is lost. Before Begin: the rotors stand still.
  const Setpoint& Step(double t);
  /// How many steps were judged how, by StepTime.
  const std::array<int, kStepTimes>& steps() const;
  /// The flight's own time at the caller's time t [s]: the same, until the caller's clock is another one.
  double FlightTime(double t) const;

  const OnboardStatus& status() const;
  const OnboardPlan& plan() const;
  const OnboardTimes& times() const;
  /// Committed reference with heading at time t.
  planning::FlatState Reference(double t) const;
  /// Estimated, and compensated where the law does so.
  Disturbance disturbance() const;

  /// What it uses as its own state now, and how that was at t [s].
  const estimation::VehicleState& own() const;
  estimation::VehicleState OwnAt(double t) const;
  bool own_estimated() const;
  const estimation::PadFilter& pad() const;
  const planning::OccupancyMap& map() const;
  const OnboardOptions& options() const;

  /// Keep what a Replanner remembered before each question, for records. Allocates then.
  void KeepBefore(bool keep);
  /// Keeps a copy of whatever comes to the pad filter from now on.
  void LogPadTo(std::vector<estimation::PadArrival>* log);
  /// The map itself, for those who know more than the sensors.
  planning::OccupancyMap* mutable_map();
  /// Hands over everything observed so far, and starts again with nothing remembered outside of the
  /// window. Allocates.
  planning::PersistentMap TakeMemory();

 private:
  struct Parts;
  Taken Counted(Taken taken);
  template <typename Measurement>
  Measurement InFlight(Measurement measured) const;
  std::unique_ptr<Parts> it_;
};

}  // namespace touchdown::control
