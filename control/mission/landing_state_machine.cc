// SPDX-License-Identifier: BSD-3-Clause
// The landing mission (the paper's section 2.2, figure 2) with hold, go-around and emergency stop.
// Each step first updates how long the conditions have lasted. It then decides at most one
// transition: contact first, then emergency, invalid input, and the mode's own. Last it moves the
// commanded foot height by one step of a rate- and acceleration-limited profile. Only the height's
// target changes in a transition, so the height never jumps. While a plan leads to the deck, it is
// the vehicle's own height.

#include "touchdown/control/mission/landing_state_machine.h"

#include <algorithm>
#include <cmath>

#include "control/mission/landing_conditions.h"
#include "control/mission/landing_transitions.h"
#include "control/tracking/rate_profile.h"

namespace touchdown::control {
namespace {

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
  // With invalid numbers the invalid-input timer decides, not the pad's. Without an own state the
  // pad's timer is neither started nor stopped, so that an intermittent state does not restart it
  // each time.
  if (in.own_usable) Track(now.numbers_valid && !now.pad_good, t, state.pad_missing_since);
  Track(!in.own_usable, t, state.own_lost_since);
  Track(now.pad_good && now.sees && in.has_plan && in.plan_failed_for <= 0.0, t,
        state.recovered_since);
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
  const bool lands = state.mode == MissionMode::kLanding || in.lands;
  Track(lands && (now.touching || bounces), t, state.contact_since);
}

// The largest rate at `distance` before a place that is to be reached with `rate`.
double RateBefore(double distance, double rate, double deceleration) {
  return std::sqrt(rate * rate + 2.0 * deceleration * std::max(0.0, distance));
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
    // Arrives at the gate height with the slow rate, and at the deck with the contact rate.
    rate_max =
        std::min({std::max(p.fast_rate, p.slow_rate),
                  RateBefore(s.foot_height - p.gate_height, p.slow_rate, p.height_acceleration),
                  RateBefore(s.foot_height, p.contact_rate, p.contact_deceleration)});
    target = -p.press_depth;
    if (!s.committed && !now.may_land) {
      target = s.foot_height > p.gate_height ? p.gate_height : rest;
      if (s.foot_height <= p.gate_height + 0.05) hold = DescentHold::kGate;
    }
    if (!s.committed && !now.in_corridor) {
      target = rest;
      hold = DescentHold::kCorridor;
    }
    // If the command went on, a vehicle that had to stop would dive after it and meet the deck
    // hard.
    if (hold == DescentHold::kNone && !in.at_goal && now.numbers_valid &&
        in.height > s.foot_height + p.height_lag) {
      target = rest;
      hold = DescentHold::kLag;
    }
  }
  // A climb that began gently would let the feet touch first.
  const bool begins = s.mode == MissionMode::kGoAround && s.foot_height < p.gate_height;
  const double acceleration = begins ? p.turn_acceleration : p.height_acceleration;
  const RateStep step =
      StepTowards(target - s.foot_height, s.foot_height_rate, rate_max, acceleration, dt);
  s.foot_height += step.advance;
  s.foot_height_rate = step.rate;
  return hold;
}

// From here on the landing goes on by prediction.
void Commit(const MissionInputs& in, const MissionParameters& p, const Conditions& now,
            MissionState& s) {
  // A planned landing was decided on when it began.
  const bool open = Planned(in) ? now.gate_open : now.may_land;
  if (s.mode != MissionMode::kLanding || s.committed || !open) return;
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
  const bool low = in.height < p.gate_height + HeightLost(in, p, p.turn_time) && now.comes_in;
  s.waits_above = !now.may_land && (s.waits_above || due || low);
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
                         Gate gate, Guidance guidance) {
  MissionOutputs out;
  out.mode = s.mode;
  out.reason = reason;
  out.descent_hold = hold;
  out.gate = gate;
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

MissionStep Step(const MissionState& state, const MissionInputs& inputs,
                 const MissionParameters& parameters) noexcept {
  MissionState s = state;
  if (!std::isfinite(inputs.t)) {  // without a time nothing can be decided
    const bool armed = s.mode != MissionMode::kDisarmed;
    return {s, OutputsOf(s, TransitionReason::kNone, DescentHold::kNone, Gate::kOwnState,
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
  DescentHold hold = MoveHeight(inputs, parameters, now, dt, s);
  Commit(inputs, parameters, now, s);
  DecideToWait(inputs, parameters, now, s);
  if (s.mode == MissionMode::kTracking && Planned(inputs) && s.waits_above) {
    hold = DescentHold::kAbove;
  }
  if (inputs.looks) hold = DescentHold::kLook;
  return {s, OutputsOf(s, transition.reason, hold, now.gate, GuidanceOf(s, inputs, now))};
}

}  // namespace touchdown::control
