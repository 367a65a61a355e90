// SPDX-License-Identifier: BSD-3-Clause
// The mission's transitions: contact first, then emergency, invalid input, and the mode's own.

#include "control/mission/landing_transitions.h"

#include <algorithm>
#include <cmath>

namespace touchdown::control {
namespace {

// A planned landing that is decided does not pause: what a pause would have to wait for ends it.
Transition FromArriving(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        bool touches, const MissionParameters& p) {
  if (!touches && !now.gate_open &&
      in.own_usable) {  // else it is not the tags, and own_timeout decides
    return {MissionMode::kGoAround, TransitionReason::kTagsLost};
  }
  if (!touches && in.plan_failed_for > p.arrival_plan_timeout) {
    return {MissionMode::kGoAround, TransitionReason::kPlanFailed};
  }
  // If every new plan postponed contact, it would never be overdue.
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
  const bool predicted = Planned(in) && std::isfinite(in.arrival_in);
  const double left = predicted ? std::max(0.0, in.arrival_in) : 0.0;
  return in.horizontal_speed > p.contact_speed + p.closing_rate * left;
}

Transition FromLanding(const MissionState& s, const MissionInputs& in, const Conditions& now,
                       const MissionParameters& p) {
  if (LastedLonger(s.own_lost_since, s.t, p.own_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kOwnStateLost};
  }
  // Feet that touch are not pulled off again, and feet that will touch anyway stay.
  const bool touches = s.contact_since != kNever || now.will_touch;
  if (!touches && TooFarOff(s, in, now, p)) {
    return {MissionMode::kGoAround, TransitionReason::kErrorTooLarge};
  }
  if (s.committed && !touches && TooFast(in, p)) {
    return {MissionMode::kGoAround, TransitionReason::kTooFast};
  }
  if ((s.committed || Planned(in)) && !touches && in.lean > p.lean_max) {
    return {MissionMode::kGoAround, TransitionReason::kGust};
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
  if (in.looks) return {MissionMode::kTracking, TransitionReason::kLooks};
  if (Planned(in)) return FromArriving(s, in, now, touches, p);
  if (LastedLonger(s.gate_closed_since, s.t, p.gate_timeout)) {
    return {MissionMode::kGoAround, TransitionReason::kTagsLost};
  }
  if (in.plan_failed_for > p.plan_timeout) {
    return {MissionMode::kGoAround, TransitionReason::kPlanFailed};
  }
  return {s.mode, TransitionReason::kNone};
}

Transition FromTracking(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        const MissionParameters& p) {
  if (LastedLonger(s.own_lost_since, s.t, p.own_timeout)) {
    return {MissionMode::kHold, TransitionReason::kOwnStateLost};
  }
  if (LastedLonger(s.pad_missing_since, s.t, p.pad_timeout)) {
    return {MissionMode::kHold, TransitionReason::kPadLost};
  }
  if (!now.sees) return {MissionMode::kHold, TransitionReason::kDepthLost};
  if (in.plan_failed_for > p.plan_timeout) {
    return {MissionMode::kHold, TransitionReason::kPlanFailed};
  }
  if (in.looks) return {s.mode, TransitionReason::kNone};
  if (now.pad_good && in.descent == DescentStyle::kVertical &&
      in.horizontal_distance < p.landing_distance && in.horizontal_speed < p.landing_speed) {
    return {MissionMode::kLanding, TransitionReason::kAbovePad};
  }
  if (now.pad_good && TouchesDown(s, in) && in.arrival_in <= p.decide_time && now.may_land &&
      now.in_cone) {
    return {MissionMode::kLanding, TransitionReason::kArriving};
  }
  return {s.mode, TransitionReason::kNone};
}

Transition FromGoAround(const MissionState& s, const MissionInputs& in, const Conditions& now,
                        const MissionParameters& p) {
  const double enough = p.follow_height - p.climb_tolerance;
  // The height above a lost pad means nothing: only the command says when the climb is done.
  const bool high = s.foot_height >= enough && (in.height >= enough || !now.pad_good);
  const bool timeout = in.rests || LastedLonger(s.mode_since, s.t, p.climb_timeout);
  if (!high && !timeout) return {s.mode, TransitionReason::kNone};
  if (!in.own_usable) return {MissionMode::kHold, TransitionReason::kOwnStateLost};
  if (!now.pad_good) return {MissionMode::kHold, TransitionReason::kPadLost};
  if (!now.sees) return {MissionMode::kHold, TransitionReason::kDepthLost};
  return {MissionMode::kTracking,
          high ? TransitionReason::kClimbComplete : TransitionReason::kClimbTimeout};
}

}  // namespace

Transition Decide(const MissionState& s, const MissionInputs& in, const Conditions& now,
                  const MissionParameters& p) noexcept {
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

}  // namespace touchdown::control
