// SPDX-License-Identifier: BSD-3-Clause
// The landing mission (the paper's section 2.2, figure 2) with hold, go-around and emergency stop.
// Each step: update how long the conditions have lasted, decide at most one transition (contact
// first, then emergency, invalid input, and the mode's own), then move the commanded foot height
// by one step of a rate- and acceleration-limited profile. The height never jumps, whatever the
// transition, because only its target changes; while a plan leads to the deck it is the vehicle's own.

#include "touchdown/control/landing_state_machine.h"

#include <algorithm>
#include <cmath>

#include "touchdown/control/rate_profile.h"

namespace touchdown::control {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// The inputs read once: what is usable, and which conditions hold now.
struct Conditions {
  bool numbers_valid;
  bool pad_good;   // the pad can be planned to
  bool gate_open;  // the pad is known well enough to descend below the gate height
  bool in_corridor;
  bool in_cone;  // of a planned landing: wider, and it opens upwards
  bool touching;
};

// False for a condition that does not hold.
bool LastedLonger(double since, double t, double duration) { return t - since > duration; }

bool Planned(const MissionInputs& in) { return in.descent == DescentStyle::kPlanned; }

// Whether what is known now lasts until contact, were nothing measured on the way.
bool CanBridge(const MissionState& s, const MissionInputs& in, const MissionParameters& p) {
  const bool on_the_way = Planned(in) || s.foot_height <= p.gate_height;
  return on_the_way && in.tag_age + ContactIn(s, in, p) <= p.bridge_time &&
         in.contact_sigma <= p.bridge_sigma;
}

Conditions Assess(const MissionState& s, const MissionInputs& in, const MissionParameters& p) {
  Conditions now{};
  // pad_sigma, contact_sigma, tag_age and plan_failed_for may be infinite: never seen, never planned.
  now.numbers_valid = std::isfinite(in.horizontal_distance) && std::isfinite(in.height) &&
                      std::isfinite(in.horizontal_speed) && std::isfinite(in.sink_rate) &&
                      std::isfinite(in.foot_force) && !std::isnan(in.pad_sigma) &&
                      !std::isnan(in.contact_sigma) && !std::isnan(in.tag_age) &&
                      !std::isnan(in.plan_failed_for) && !std::isnan(in.arrival_in);
  now.pad_good = now.numbers_valid && in.own_usable && in.pad_available && in.pad_converged;
  // Dead reckoning only gets worse: one that lasts is not waited out while tags show the pad.
  const bool own_good =
      in.own_usable && (in.own_fresh || LastedLonger(s.own_stale_since, s.t, p.own_patience));
  const bool seen = in.pad_sigma <= p.gate_sigma && in.tag_age <= p.gate_tag_age;
  // A bridge is what is foretold in W, and dead reckoning leaves W.
  const bool bridged = in.own_fresh && CanBridge(s, in, p);
  now.gate_open = now.numbers_valid && own_good && in.pad_available && (seen || bridged);
  now.in_corridor =
      now.numbers_valid &&
      in.horizontal_distance <= p.corridor_radius + p.corridor_slope * std::max(0.0, in.height);
  now.in_cone =
      now.numbers_valid &&
      in.horizontal_distance <= p.landing_distance + p.cone_slope * std::max(0.0, in.height);
  now.touching = now.numbers_valid && in.foot_force >= p.contact_force &&
                 std::abs(in.height) <= p.contact_height &&
                 in.horizontal_distance <= p.contact_distance;
  return now;
}

// Keeps the time since when a condition has held.
void Track(bool holds, double t, double& since) {
  if (!holds) {
    since = kNever;
  } else if (since == kNever) {
    since = t;
  }
}

void UpdateTimers(const MissionInputs& in, const MissionParameters& p, const Conditions& now,
                  double dt, MissionState& state) {
  const double t = state.t;
  Track(now.pad_good, t, state.converged_since);
  // Without numbers the invalid-input timer decides, not the pad's. Without an own state the pad's is
  // neither begun nor ended, so that a state that comes and goes does not start it anew each time.
  if (in.own_usable) Track(now.numbers_valid && !now.pad_good, t, state.pad_missing_since);
  Track(!in.own_usable, t, state.own_lost_since);
  Track(now.pad_good && in.has_plan && in.plan_failed_for <= 0.0, t, state.recovered_since);
  Track(!now.numbers_valid, t, state.invalid_since);
  Track(!in.emergency, t, state.calm_since);
  const bool gate_matters = state.mode == MissionMode::kLanding && !state.committed &&
                            state.foot_height <= p.gate_height + 0.05;
  Track(gate_matters && !now.gate_open, t, state.gate_closed_since);
  // Contact must be seen without a gap: two touches far apart are not one that lasts.
  if (dt > p.contact_gap) state.contact_since = kNever;
  Track(now.touching, t, state.touching_since);
  Track(!now.touching, t, state.lifted_since);
  const bool bounces =
      state.contact_since != kNever && !LastedLonger(state.lifted_since, t, p.contact_break);
  Track(state.mode == MissionMode::kLanding && (now.touching || bounces), t, state.contact_since);
}

struct Transition {
  MissionMode mode;
  TransitionReason reason;
};

// A planned landing that is decided does not pause: what a pause would have to wait for ends it.
Transition FromArriving(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        const MissionParameters& p) {
  if (!now.gate_open && in.own_usable) {  // else it is not the tags, and own_timeout decides
    return {MissionMode::kGoAround, TransitionReason::kTagsLost};
  }
  if (in.plan_failed_for > p.arrival_plan_timeout) {
    return {MissionMode::kGoAround, TransitionReason::kPlanFailed};
  }
  // Contact that every new plan puts off would never be overdue.
  if (LastedLonger(s.mode_since, s.t, p.decide_time + p.arrival_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kNoContact};
  }
  return {s.mode, TransitionReason::kNone};
}

// May the horizontal error become contact? A vertical descent is above the pad, a planned one in the cone
// over it.
bool TooFarOff(const MissionState& s, const MissionInputs& in, const Conditions& now,
               const MissionParameters& p) {
  if (Planned(in)) return !now.in_cone;
  return in.horizontal_distance > (s.committed ? p.commit_abort_distance : p.abort_distance);
}

// Will the feet be still enough over the deck when they touch it?
bool TooFast(const MissionInputs& in, const MissionParameters& p) {
  const bool foretold = Planned(in) && std::isfinite(in.arrival_in);
  const double left = foretold ? std::max(0.0, in.arrival_in) : 0.0;
  return in.horizontal_speed > p.contact_speed + p.closing_rate * left;
}

Transition FromLanding(const MissionState& s, const MissionInputs& in, const Conditions& now,
                       const MissionParameters& p) {
  if (LastedLonger(s.own_lost_since, s.t, p.own_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kOwnStateLost};
  }
  // Feet that touch are not pulled off again: the contact is about to be confirmed.
  const bool touches = s.contact_since != kNever;
  if (!touches && TooFarOff(s, in, now, p)) {
    return {MissionMode::kGoAround, TransitionReason::kErrorTooLarge};
  }
  if (s.committed && !touches && TooFast(in, p)) {
    return {MissionMode::kGoAround, TransitionReason::kTooFast};
  }
  if (s.committed) {  // blind last part: no tags needed, but it must end
    if (!touches && (in.tag_age > p.bridge_time || in.pad_sigma > p.bridge_sigma)) {
      return {MissionMode::kGoAround, TransitionReason::kTagsLost};
    }
    const bool overdue = Planned(in) && !touches && in.arrival_in < -p.arrival_timeout;
    if (overdue || LastedLonger(s.committed_since, s.t, p.commit_timeout)) {
      return {MissionMode::kGoAround, TransitionReason::kNoContact};
    }
    return {s.mode, TransitionReason::kNone};
  }
  if (LastedLonger(s.pad_missing_since, s.t, p.pad_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kPadLost};
  }
  if (Planned(in)) return FromArriving(s, in, now, p);
  if (LastedLonger(s.gate_closed_since, s.t, p.gate_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kTagsLost};
  }
  if (in.plan_failed_for > p.plan_timeout) {
    return {MissionMode::kGoAround, TransitionReason::kPlanFailed};
  }
  return {s.mode, TransitionReason::kNone};
}

// Whether plans lead to the deck while tracking.
bool TouchesDown(const MissionState& s, const MissionInputs& in) {
  return Planned(in) && !s.waits_above;
}

Transition FromTracking(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        const MissionParameters& p) {
  if (LastedLonger(s.own_lost_since, s.t, p.own_timeout)) {
    return {MissionMode::kHold, TransitionReason::kOwnStateLost};
  }
  if (LastedLonger(s.pad_missing_since, s.t, p.pad_timeout)) {
    return {MissionMode::kHold, TransitionReason::kPadLost};
  }
  if (in.plan_failed_for > p.plan_timeout) {
    return {MissionMode::kHold, TransitionReason::kPlanFailed};
  }
  if (now.pad_good && in.descent == DescentStyle::kVertical &&
      in.horizontal_distance < p.landing_distance && in.horizontal_speed < p.landing_speed) {
    return {MissionMode::kLanding, TransitionReason::kAbovePad};
  }
  if (now.pad_good && TouchesDown(s, in) && in.arrival_in <= p.decide_time && now.gate_open &&
      now.in_cone) {
    return {MissionMode::kLanding, TransitionReason::kArriving};
  }
  return {s.mode, TransitionReason::kNone};
}

Transition FromGoAround(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        const MissionParameters& p) {
  const double enough = p.follow_height - p.climb_tolerance;
  // The height above a lost pad means nothing: the command alone tells when the climb is done.
  const bool high = s.foot_height >= enough && (in.height >= enough || !now.pad_good);
  const bool timeout = LastedLonger(s.mode_since, s.t, p.climb_timeout);
  if (!high && !timeout) return {s.mode, TransitionReason::kNone};
  if (!in.own_usable) return {MissionMode::kHold, TransitionReason::kOwnStateLost};
  if (!now.pad_good) return {MissionMode::kHold, TransitionReason::kPadLost};
  return {MissionMode::kTracking,
          high ? TransitionReason::kClimbComplete : TransitionReason::kClimbTimeout};
}

Transition Decide(const MissionState& s, const MissionInputs& in, const Conditions& now,
                  const MissionParameters& p) {
  const Transition stay = {s.mode, TransitionReason::kNone};
  if (s.mode == MissionMode::kDisarmed) return stay;
  const bool rests = now.touching && s.t - s.touching_since >= p.contact_rest;
  if (rests && s.t - s.contact_since >= p.contact_time) {
    return {MissionMode::kDisarmed, TransitionReason::kContact};
  }
  if (s.mode == MissionMode::kEmergencyStop) {
    if (LastedLonger(s.calm_since, s.t, p.emergency_time)) {
      return {MissionMode::kHold, TransitionReason::kEmergencyCleared};
    }
    return stay;
  }
  if (in.emergency) return {MissionMode::kEmergencyStop, TransitionReason::kEmergency};
  if (s.mode == MissionMode::kHovering) {
    if (now.pad_good && in.yaw_aligned) {
      return {MissionMode::kTracking, TransitionReason::kPadConverged};
    }
    if (now.pad_good && LastedLonger(s.converged_since, s.t, p.align_timeout)) {
      return {MissionMode::kTracking, TransitionReason::kAlignTimeout};
    }
    return stay;
  }
  if (s.mode == MissionMode::kHold) {
    if (s.t - s.recovered_since >= p.hold_time) {
      return {MissionMode::kTracking, TransitionReason::kRecovered};
    }
    return stay;
  }
  if (!now.numbers_valid) {
    if (LastedLonger(s.invalid_since, s.t, p.invalid_timeout)) {
      return {MissionMode::kHold, TransitionReason::kInvalidInput};
    }
    return stay;
  }
  switch (s.mode) {
    case MissionMode::kTracking:
      return FromTracking(s, in, now, p);
    case MissionMode::kLanding:
      return FromLanding(s, in, now, p);
    case MissionMode::kGoAround:
      return FromGoAround(s, in, now, p);
    default:
      return stay;
  }
}

// Moves the commanded foot height by dt; returns why a descent pauses.
DescentHold MoveHeight(const MissionInputs& in, const MissionParameters& p, const Conditions& now,
                       double dt, MissionState& s) {
  double target = p.follow_height;
  double rate_max = p.climb_rate;
  DescentHold hold = DescentHold::kNone;
  if (s.mode == MissionMode::kDisarmed) {
    s.foot_height_rate = 0.0;
    return hold;
  }
  if (s.mode == MissionMode::kLanding && Planned(in)) {
    // The plan leads; a climb would begin where the vehicle is.
    if (now.numbers_valid) s.foot_height = std::clamp(in.height, 0.0, p.follow_height);
    s.foot_height_rate = 0.0;
    return hold;
  }
  if (s.mode == MissionMode::kLanding) {
    // Where the present rate can be brought to rest: holding means no farther than this.
    const double rest = s.foot_height + 0.5 * s.foot_height_rate * std::abs(s.foot_height_rate) /
                                            p.height_acceleration;
    // Arrives at the gate height with the slow rate.
    rate_max =
        std::sqrt(p.slow_rate * p.slow_rate +
                  2.0 * p.height_acceleration * std::max(0.0, s.foot_height - p.gate_height));
    rate_max = std::min(std::max(p.fast_rate, p.slow_rate), rate_max);
    target = -p.press_depth;
    if (!s.committed && !now.gate_open) {
      target = s.foot_height > p.gate_height ? p.gate_height : rest;
      if (s.foot_height <= p.gate_height + 0.05) hold = DescentHold::kGate;
    }
    if (!s.committed && !now.in_corridor) {
      target = rest;
      hold = DescentHold::kCorridor;
    }
  }
  const RateStep step =
      StepTowards(target - s.foot_height, s.foot_height_rate, rate_max, p.height_acceleration, dt);
  s.foot_height += step.advance;
  s.foot_height_rate = step.rate;
  return hold;
}

// From here on the landing goes on by prediction.
void Commit(const MissionInputs& in, const MissionParameters& p, const Conditions& now,
            MissionState& s) {
  if (s.mode != MissionMode::kLanding || s.committed || !now.gate_open) return;
  // Both the command and the vehicle must be low: a vehicle that lags behind is not committed.
  const bool low =
      now.in_corridor && s.foot_height < p.commit_height && in.height < p.commit_height;
  const bool arriving = now.in_cone && in.arrival_in < p.arrival_commit_time;
  if (!(Planned(in) ? arriving : low)) return;
  s.committed = true;
  s.committed_since = s.t;
}

// A planned arrival that cannot be decided on when it is time ends above the pad instead.
void DecideToWait(const MissionInputs& in, const MissionParameters& p, const Conditions& now,
                  MissionState& s) {
  if (s.mode != MissionMode::kTracking) {
    s.waits_above = s.mode == MissionMode::kGoAround || s.mode == MissionMode::kHold;
    return;
  }
  const bool due = in.arrival_in <= p.decide_time;
  const double sinks = std::max(0.0, in.sink_rate);
  const double turn = sinks * (p.turn_time + 0.5 * sinks / p.turn_acceleration);
  const bool low = in.height < p.gate_height + turn && now.in_cone;
  s.waits_above = s.waits_above ? !now.gate_open : (due || low) && !now.gate_open;
}

Guidance GuidanceOf(const MissionState& s, const MissionInputs& in, const Conditions& now) {
  switch (s.mode) {
    case MissionMode::kDisarmed:
      return Guidance::kIdle;
    case MissionMode::kTracking:
      return TouchesDown(s, in) ? Guidance::kTouchDown : Guidance::kFollowPad;
    case MissionMode::kLanding:
      return Planned(in) ? Guidance::kTouchDown : Guidance::kFollowPad;
    case MissionMode::kGoAround:
      return now.pad_good && in.plan_failed_for <= 0.0 ? Guidance::kFollowPad : Guidance::kClimb;
    default:
      return Guidance::kHoldPosition;
  }
}

MissionOutputs OutputsOf(const MissionState& s, TransitionReason reason, DescentHold hold,
                         Guidance guidance) {
  MissionOutputs out;
  out.mode = s.mode;
  out.reason = reason;
  out.descent_hold = hold;
  out.guidance = guidance;
  out.motors_armed = s.mode != MissionMode::kDisarmed;
  out.plan_requested = s.mode == MissionMode::kTracking || s.mode == MissionMode::kLanding ||
                       s.mode == MissionMode::kGoAround || s.mode == MissionMode::kHold;
  out.committed = s.committed;
  out.foot_height = s.foot_height;
  out.foot_height_rate = s.foot_height_rate;
  return out;
}

}  // namespace

double ContactIn(const MissionState& state, const MissionInputs& in,
                 const MissionParameters& p) noexcept {
  if (Planned(in)) {
    return std::isfinite(in.arrival_in) ? std::max(0.0, in.arrival_in) + p.contact_reserve : kNever;
  }
  if (!std::isfinite(in.height)) return kNever;
  const double way = std::max({0.0, in.height, state.foot_height});
  const double faster = std::max(0.0, p.slow_rate + state.foot_height_rate);  // yet to be gained
  const double speeding_up = 0.5 * faster * faster / (p.height_acceleration * p.slow_rate);
  return way / p.slow_rate + speeding_up + p.contact_reserve;
}

MissionStep Step(const MissionState& state, const MissionInputs& inputs,
                 const MissionParameters& parameters) noexcept {
  MissionState s = state;
  if (!std::isfinite(inputs.t)) {  // without a time nothing can be decided
    const bool armed = s.mode != MissionMode::kDisarmed;
    return {s, OutputsOf(s, TransitionReason::kNone, DescentHold::kNone,
                         armed ? Guidance::kHoldPosition : Guidance::kIdle)};
  }
  if (!s.started) {
    s.started = true;
    s.t = s.mode_since = inputs.t;
    s.foot_height = parameters.follow_height;
  }
  const double dt = std::max(0.0, inputs.t - s.t);
  s.t += dt;

  Track(!inputs.own_fresh, s.t, s.own_stale_since);
  const Conditions now = Assess(s, inputs, parameters);
  UpdateTimers(inputs, parameters, now, dt, s);
  const Transition transition = Decide(s, inputs, now, parameters);
  if (transition.mode != s.mode) {
    s.mode = transition.mode;
    s.mode_since = s.t;
    s.committed = false;
    s.gate_closed_since = s.contact_since = kNever;
    // An old success must not end a hold that has only begun.
    s.recovered_since = kNever;
  }
  const DescentHold hold = MoveHeight(inputs, parameters, now, dt, s);
  Commit(inputs, parameters, now, s);
  DecideToWait(inputs, parameters, now, s);
  return {s, OutputsOf(s, transition.reason, hold, GuidanceOf(s, inputs, now))};
}

}  // namespace touchdown::control
