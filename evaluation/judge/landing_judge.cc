// SPDX-License-Identifier: BSD-3-Clause
// The success rule of the evaluation as an incremental observer of the true state. First contact of
// a foot with the pad is judged on relative velocity and attitude. Then one second of rest, upright
// and disarmed, makes a landing. Everything else is exactly one failure class. An obstacle that is
// touched before the landing is over is a collision, whatever the feet stand on.
#include "evaluation/judge/landing_judge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "estimation/base/degrees.h"

namespace touchdown::evaluation {
namespace {

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool Finite(const JudgeSample& s) {
  return s.vehicle.p_WB.allFinite() && s.vehicle.v_WB.allFinite() &&
         s.vehicle.q_WB.coeffs().allFinite() && s.pad.p_WP.allFinite();
}

}  // namespace

const char* ToString(Outcome outcome) {
  switch (outcome) {
    case Outcome::kLanded:
      return "landed";
    case Outcome::kCollision:
      return "collision";
    case Outcome::kOffPad:
      return "off_pad";
    case Outcome::kHardTouchdown:
      return "hard_touchdown";
    case Outcome::kTiltedTouchdown:
      return "tilted_touchdown";
    case Outcome::kBouncedOff:
      return "bounced_off";
    case Outcome::kTipOver:
      return "tip_over";
    case Outcome::kDisarmedInAir:
      return "disarmed_in_air";
    case Outcome::kLostPad:
      return "lost_pad";
    case Outcome::kInfeasible:
      return "infeasible";
    case Outcome::kFollowed:
      return "followed";
    case Outcome::kArrived:
      return "arrived";
    case Outcome::kTimeout:
      return "timeout";
    case Outcome::kStood:
      return "stood";
    case Outcome::kUnstable:
      return "unstable";
    case Outcome::kError:
      return "error";
    case Outcome::kCrashed:
      return "crashed";
    case Outcome::kHung:
      return "hung";
  }
  return "error";
}

const char* Explain(Outcome outcome) {
  switch (outcome) {
    case Outcome::kLanded:
      return "The vehicle rests upright and disarmed on the pad.";
    case Outcome::kCollision:
      return "The vehicle touched something before its task was done.";
    case Outcome::kOffPad:
      return "The feet came down beside the pad.";
    case Outcome::kHardTouchdown:
      return "The vehicle was too fast relative to the deck at contact.";
    case Outcome::kTiltedTouchdown:
      return "The vehicle was tilted too far at contact.";
    case Outcome::kBouncedOff:
      return "The vehicle left the pad again after contact.";
    case Outcome::kTipOver:
      return "The vehicle fell over after contact.";
    case Outcome::kDisarmedInAir:
      return "The rotors were stopped in the air.";
    case Outcome::kLostPad:
      return "Time ran out while the pad's position was not known.";
    case Outcome::kInfeasible:
      return "Time ran out while no certified plan was found.";
    case Outcome::kFollowed:
      return "The vehicle stayed above the pad for the whole time.";
    case Outcome::kArrived:
      return "The vehicle is at the goal.";
    case Outcome::kTimeout:
      return "Time ran out before the task was done.";
    case Outcome::kStood:
      return "The vehicle stayed in place, had depth images, and found no plan.";
    case Outcome::kUnstable:
      return "The simulated physics failed.";
    case Outcome::kError:
      return "The program failed in this trial.";
    case Outcome::kCrashed:
      return "The process that flew this trial died.";
    case Outcome::kHung:
      return "The trial did not end in the time that it was given.";
  }
  return "The program failed in this trial.";
}

bool IsSuccess(Outcome outcome) {
  return outcome == Outcome::kLanded || outcome == Outcome::kFollowed ||
         outcome == Outcome::kArrived;
}

bool IsLost(Outcome outcome) {
  return outcome == Outcome::kError || outcome == Outcome::kCrashed || outcome == Outcome::kHung;
}

std::optional<Outcome> OutcomeNamed(std::string_view name) {
  for (int i = 0; i <= static_cast<int>(kLastOutcome); ++i) {
    if (name == ToString(static_cast<Outcome>(i))) return static_cast<Outcome>(i);
  }
  return std::nullopt;
}

Eigen::Vector3d DeckPointVelocity(const estimation::PadState& pad, const Eigen::Vector3d& p_WB) {
  const Eigen::Vector3d p_PB = p_WB - pad.p_WP;
  return pad.v_WP + pad.yaw_rate * Eigen::Vector3d(-p_PB.y(), p_PB.x(), 0.0);
}

std::string Broken(const LandingRule& rule, const Touchdown& d) {
  std::vector<std::string> words;
  const auto compare = [&words](double value, double most, double scale, const char* unit) {
    if (value <= most) return;
    words.push_back(fmt::format("{:.3f} {}, {:g} allowed", scale * value, unit, scale * most));
  };
  compare(d.relative_velocity.head<2>().norm(), rule.horizontal_speed, 1.0, "m/s horizontally");
  compare(std::abs(d.relative_velocity.z()), rule.vertical_speed, 1.0, "m/s vertically");
  compare(d.tilt_over_equilibrium, rule.tilt_over_equilibrium, estimation::kDegPerRad,
          "deg from the equilibrium's tilt");
  compare(d.tilt, rule.tilt, estimation::kDegPerRad, "deg of tilt");
  return fmt::format("{}", fmt::join(words, "; "));
}

LandingJudge::LandingJudge(const LandingRule& rule, double timeout,
                           const std::optional<HoldTask>& stay)
    : rule_(rule), timeout_(timeout), stay_(stay) {}

std::optional<Outcome> LandingJudge::Observe(const JudgeSample& sample) {
  if (outcome_) return outcome_;
  const double dt = std::max(0.0, sample.t - t_previous_);
  t_previous_ = sample.t;
  const double forget = std::min(1.0, dt / rule_.loss_window);
  without_pad_ += forget * ((sample.pad_known ? 0.0 : 1.0) - without_pad_);
  without_plan_ += forget * ((sample.plan_valid ? 0.0 : 1.0) - without_plan_);
  const double distance = (sample.vehicle.p_WB - sample.pad.p_WP).head<2>().norm();
  distance_ = distance_ ? *distance_ + forget * (distance - *distance_) : distance;

  if (!sample.simulated || !Finite(sample)) {
    outcome_ = Outcome::kUnstable;
  } else if (sample.on_obstacle) {
    outcome_ = Outcome::kCollision;
  } else {
    outcome_ = touchdown_ ? OnThePad(sample) : InTheAir(sample);
  }
  if (!outcome_ && stay_ && !touchdown_ && Stayed(sample)) outcome_ = stay_->done;
  if (!outcome_ && sample.t >= timeout_) outcome_ = TimeoutClass();
  if (!outcome_ && !touchdown_ && sample.stood) outcome_ = Outcome::kStood;
  return outcome_;
}

bool LandingJudge::Stayed(const JudgeSample& sample) {
  if (!sample.at_target) there_since_.reset();
  if (sample.at_target && !there_since_) there_since_ = sample.t;
  const bool ends_by_time = stay_->time > 0.0 || Asks(Outcome::kArrived);
  return ends_by_time && there_since_ && sample.t - *there_since_ >= stay_->time - 1e-3;
}

std::optional<Outcome> LandingJudge::InTheAir(const JudgeSample& sample) {
  if (sample.hull_on_deck) return Outcome::kCollision;
  // On the way to a goal the pad is one of the obstacles.
  const bool touches = sample.beside_pad || sample.foot_on_pad;
  if (touches && Asks(Outcome::kArrived)) return Outcome::kCollision;
  if (sample.beside_pad) {
    const double distance = (sample.vehicle.p_WB - sample.pad.p_WP).head<2>().norm();
    return distance <= rule_.off_pad_distance ? Outcome::kOffPad : Outcome::kCollision;
  }
  if (!sample.foot_on_pad) {
    if (!sample.armed) return Outcome::kDisarmedInAir;
    return std::nullopt;
  }
  Touchdown touchdown;
  const Eigen::Vector3d axis = sample.vehicle.q_WB * Eigen::Vector3d::UnitZ();
  touchdown.t = sample.t;
  touchdown.error_m = (sample.vehicle.p_WB - sample.pad.p_WP).head<2>().norm();
  touchdown.relative_velocity =
      sample.vehicle.v_WB - DeckPointVelocity(sample.pad, sample.vehicle.p_WB);
  touchdown.tilt = estimation::Tilt(sample.vehicle.q_WB);
  touchdown.tilt_over_equilibrium = AngleBetween(axis, sample.equilibrium_axis);
  touchdown_ = touchdown;
  last_contact_t_ = sample.t;
  if (touchdown.relative_velocity.head<2>().norm() > rule_.horizontal_speed ||
      std::abs(touchdown.relative_velocity.z()) > rule_.vertical_speed) {
    return Outcome::kHardTouchdown;
  }
  if (touchdown.tilt_over_equilibrium > rule_.tilt_over_equilibrium ||
      touchdown.tilt > rule_.tilt) {
    return Outcome::kTiltedTouchdown;
  }
  return std::nullopt;
}

std::optional<Outcome> LandingJudge::OnThePad(const JudgeSample& sample) {
  const double tilt = estimation::Tilt(sample.vehicle.q_WB);
  if (tilt > rule_.tip_over_tilt || sample.hull_on_deck) return Outcome::kTipOver;
  if (sample.beside_pad) return Outcome::kBouncedOff;
  if (sample.foot_on_pad) last_contact_t_ = sample.t;
  const double gap = sample.t - last_contact_t_;
  if (gap > rule_.bounce_gap) return Outcome::kBouncedOff;

  if (sample.armed || tilt > rule_.upright_tilt || gap > rule_.contact_gap) {
    rest_since_.reset();
    return std::nullopt;
  }
  if (!rest_since_) rest_since_ = sample.t;
  // Half a physics step of slack: the sum of binary time steps may fall short by an ulp.
  if (sample.t - *rest_since_ >= rule_.rest - 1e-3) return Outcome::kLanded;
  return std::nullopt;
}

Outcome LandingJudge::TimeoutClass() const {
  if (touchdown_) return Outcome::kTimeout;
  if (without_pad_ > rule_.loss_share) return Outcome::kLostPad;
  if (without_plan_ > rule_.loss_share) return Outcome::kInfeasible;
  const bool near = *distance_ <= rule_.following_distance;
  if (Asks(Outcome::kFollowed) && stay_->time <= 0.0 && near) return Outcome::kFollowed;
  return Outcome::kTimeout;
}

}  // namespace touchdown::evaluation
