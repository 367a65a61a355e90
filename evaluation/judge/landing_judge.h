// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// How a trial ended. One class each, the first that applies.
enum class Outcome {
  kLanded,
  kCollision,        ///< touched an obstacle before the landing was over, or in the air the ground
                     ///< far from the pad, or the pad with anything but a foot
  kOffPad,           ///< the feet came down beside the pad
  kHardTouchdown,    ///< too fast relative to the deck at first contact
  kTiltedTouchdown,  ///< too far from the equilibrium attitude, or tilted too much, at contact
  kBouncedOff,       ///< left the pad again after first contact
  kTipOver,          ///< fell over after first contact
  kDisarmedInAir,    ///< rotors stopped without contact
  kLostPad,          ///< time ran out while the vehicle did not know where the pad was
  kInfeasible,       ///< time ran out while no certified plan to the pad existed
  kFollowed,         ///< it stayed above the pad, and no more was asked
  kArrived,          ///< it is at the goal that was asked for
  kTimeout,          ///< time ran out otherwise
  kStood,            ///< it stood for as long as the trial allows, saw, and made no new plan
  kUnstable,         ///< the simulated physics failed
  // Never set by the judge:
  kError,    ///< the program failed in this trial, and said why
  kCrashed,  ///< the process that flew it died
  kHung,     ///< it took longer than it was given
};
inline constexpr Outcome kLastOutcome = Outcome::kHung;

const char* ToString(Outcome outcome);
/// The outcome that ToString gives this name, if there is one.
std::optional<Outcome> OutcomeNamed(std::string_view name);
/// One sentence for people.
const char* Explain(Outcome outcome);
/// The task is done.
bool IsSuccess(Outcome outcome);
/// It tells nothing about the flight: the program or its process failed. Such a trial may be flown again.
bool IsLost(Outcome outcome);

/// The success rule, fixed before any run.
struct LandingRule {
  double horizontal_speed = 0.6;  ///< relative to the deck point below, at first contact [m/s]
  double vertical_speed = 0.5;    ///< [m/s]
  double tilt_over_equilibrium = 0.261799387799149431;  ///< 15 degrees [rad]
  double tilt = 0.698131700797731805;                   ///< 40 degrees [rad]
  double upright_tilt = 0.261799387799149431;           ///< at rest on the pad [rad]
  double tip_over_tilt = 1.04719755119659775;           ///< 60 degrees [rad]
  double rest = 1.0;                ///< upright on the pad, disarmed, without a break [s]
  double contact_gap = 0.1;         ///< a shorter loss of contact does not interrupt the rest [s]
  double bounce_gap = 0.5;          ///< a longer loss of contact has left the pad [s]
  double off_pad_distance = 2.0;    ///< a fall farther than this from the pad is a collision [m]
  double loss_share = 0.5;          ///< share of the time without pad or plan, recent time weighted
  double loss_window = 5.0;         ///< by exp(-age / this) [s], that turns a timeout into lost_pad
                                    ///< or infeasible
  double following_distance = 2.0;  ///< horizontal distance to the pad's centre, averaged with the
                                    ///< same weights, up to which the pad was followed [m]
};

/// What the judge sees at one physics step: only truth.
struct JudgeSample {
  double t = 0.0;  ///< since the start of the trial [s]
  estimation::VehicleState vehicle;
  estimation::PadState pad;
  bool foot_on_pad = false;  ///< a foot touches the deck
  bool beside_pad = false;   ///< anything touches the ground or the pad
                             ///< vehicle's body below the deck
  bool on_obstacle = false;  ///< anything touches an obstacle
  bool hull_on_deck = false;
  bool simulated = true;  ///< false: the physics failed, the state is the last good one
  bool armed = true;      ///< rotors may turn
  /// Unit thrust axis at which the vehicle would hold its velocity against the relative wind's mean
  /// over the last second, in W.
  Eigen::Vector3d equilibrium_axis = Eigen::Vector3d::UnitZ();
  bool pad_known = true;   ///< the vehicle's own estimate of the pad is valid
  bool plan_valid = true;  ///< a certified plan to the pad is being flown
  bool stood = false;      ///< for longer than the trial allows (stand_watch.h)
  bool at_target = false;  ///< of the tasks that are no landing: where it is to stay
};

/// What happened at first contact of a foot with the pad.
struct Touchdown {
  double t = 0.0;        ///< since the start [s]
  double error_m = 0.0;  ///< horizontal, B to pad centre [m]
  Eigen::Vector3d relative_velocity =
      Eigen::Vector3d::Zero();         ///< to the deck point below, W [m/s]
  double tilt = 0.0;                   ///< [rad]
  double tilt_over_equilibrium = 0.0;  ///< [rad]
};

/// Which limits of the rule a touchdown breaks, in words; empty: none.
std::string Broken(const LandingRule& rule, const Touchdown& touchdown);

/// Velocity of the deck's material point below p_WB, in W [m/s].
Eigen::Vector3d DeckPointVelocity(const estimation::PadState& pad, const Eigen::Vector3d& p_WB);

/// A task to stay at the target, without a break.
struct HoldTask {
  Outcome done = Outcome::kArrived;  ///< or kFollowed
  double distance = 0.0;  ///< so near is at the target [m]; the caller that samples decides
  double time = 0.0;      ///< so long [s]; 0, to follow: near it until the time-out
};

/// Decides a trial step by step. A pure function of the samples. Does not
/// allocate.
class LandingJudge {
 public:
  /// A landing is asked for within `timeout` [s], or to stay.
  LandingJudge(const LandingRule& rule, double timeout, const std::optional<HoldTask>& stay = {});

  /// Takes the next sample (t rising). Returns the outcome once it is decided, and from then on.
  std::optional<Outcome> Observe(const JudgeSample& sample);

  const std::optional<Outcome>& outcome() const { return outcome_; }
  /// First contact of a foot with the pad, whether or not the landing was a good one.
  const std::optional<Touchdown>& touchdown() const { return touchdown_; }

 private:
  bool Asks(Outcome done) const { return stay_ && stay_->done == done; }
  bool Stayed(const JudgeSample& sample);
  std::optional<Outcome> InTheAir(const JudgeSample& sample);
  std::optional<Outcome> OnThePad(const JudgeSample& sample);
  Outcome TimeoutClass() const;

  LandingRule rule_;
  double timeout_;
  std::optional<HoldTask> stay_;
  std::optional<Outcome> outcome_;
  std::optional<Touchdown> touchdown_;
  double t_previous_ = 0.0;
  double last_contact_t_ = 0.0;
  std::optional<double> rest_since_;
  std::optional<double> there_since_;  ///< at the target
  double without_pad_ = 0.0;           // exponentially weighted shares over loss_window
  double without_plan_ = 0.0;
  std::optional<double> distance_;  // averaged with the same weights [m]
};

}  // namespace touchdown::evaluation
