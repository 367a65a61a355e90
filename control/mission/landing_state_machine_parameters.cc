// SPDX-License-Identifier: BSD-3-Clause
// Names of the mission's modes and reasons, and the ranges of its parameters.

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "touchdown/control/mission/landing_state_machine.h"

namespace touchdown::control {

std::string_view ToString(MissionMode mode) {
  static constexpr std::array<std::string_view, 7> kNames = {
      "hovering", "tracking", "landing", "disarmed", "hold", "go_around", "emergency_stop"};
  return kNames.at(static_cast<std::size_t>(mode));
}

std::string_view ToString(TransitionReason reason) {
  static constexpr std::array<std::string_view, 22> kNames = {
      "none",       "pad_converged", "align_timeout", "above_pad",         "arriving",
      "contact",    "pad_lost",      "tags_lost",     "error_too_large",   "too_fast",
      "gust",       "plan_failed",   "no_contact",    "climb_complete",    "climb_timeout",
      "recovered",  "invalid_input", "emergency",     "emergency_cleared", "own_state_lost",
      "depth_lost", "looks"};
  return kNames.at(static_cast<std::size_t>(reason));
}

std::string_view ToString(Gate gate) {
  static constexpr std::array<std::string_view, 6> kNames = {
      "open", "own_state", "no_pad", "tags_unseen", "pad_uncertain", "gust"};
  return kNames.at(static_cast<std::size_t>(gate));
}

std::string_view ToString(DescentHold hold) {
  static constexpr std::array<std::string_view, 6> kNames = {"none", "gate",  "corridor",
                                                             "lag",  "above", "look"};
  return kNames.at(static_cast<std::size_t>(hold));
}

std::string_view ToString(Guidance guidance) {
  static constexpr std::array<std::string_view, 5> kNames = {"hold_position", "follow_pad",
                                                             "touch_down", "climb", "idle"};
  return kNames.at(static_cast<std::size_t>(guidance));
}

void Validate(const MissionParameters& p) {
  const auto require = [](bool good, const char* name, double value, const char* range) {
    if (good) return;
    std::ostringstream message;
    message << "MissionParameters." << name << " = " << value << ", allowed: " << range;
    throw std::invalid_argument(message.str());
  };
  struct Named {
    const char* name;
    double value;
  };
  const std::array<Named, 46> positive = {{
      {"lean_max", p.lean_max},
      {"follow_height", p.follow_height},
      {"landing_distance", p.landing_distance},
      {"landing_speed", p.landing_speed},
      {"fast_rate", p.fast_rate},
      {"slow_rate", p.slow_rate},
      {"contact_rate", p.contact_rate},
      {"contact_deceleration", p.contact_deceleration},
      {"climb_rate", p.climb_rate},
      {"height_acceleration", p.height_acceleration},
      {"gate_height", p.gate_height},
      {"gate_sigma", p.gate_sigma},
      {"gate_tag_age", p.gate_tag_age},
      {"bridge_time", p.bridge_time},
      {"bridge_sigma", p.bridge_sigma},
      {"gate_timeout", p.gate_timeout},
      {"commit_height", p.commit_height},
      {"commit_timeout", p.commit_timeout},
      {"corridor_radius", p.corridor_radius},
      {"abort_distance", p.abort_distance},
      {"commit_abort_distance", p.commit_abort_distance},
      {"touchdown_rate", p.touchdown_rate},
      {"decide_time", p.decide_time},
      {"arrival_commit_time", p.arrival_commit_time},
      {"arrival_plan_timeout", p.arrival_plan_timeout},
      {"arrival_timeout", p.arrival_timeout},
      {"turn_time", p.turn_time},
      {"climb_time", p.climb_time},
      {"turn_acceleration", p.turn_acceleration},
      {"contact_speed", p.contact_speed},
      {"closing_rate", p.closing_rate},
      {"cone_slope", p.cone_slope},
      {"height_lag", p.height_lag},
      {"press_depth", p.press_depth},
      {"contact_force", p.contact_force},
      {"contact_time", p.contact_time},
      {"contact_height", p.contact_height},
      {"contact_distance", p.contact_distance},
      {"foothold", p.foothold},
      {"contact_gap", p.contact_gap},
      {"pad_timeout", p.pad_timeout},
      {"plan_timeout", p.plan_timeout},
      {"climb_timeout", p.climb_timeout},
      {"depth_timeout", p.depth_timeout},
      {"climb_tolerance", p.climb_tolerance},
      {"emergency_time", p.emergency_time},
  }};
  for (const Named& item : positive) {
    require(item.value > 0.0 && std::isfinite(item.value), item.name, item.value, "> 0");
  }
  const std::array<Named, 9> not_negative = {{
      {"align_timeout", p.align_timeout},
      {"corridor_slope", p.corridor_slope},
      {"contact_reserve", p.contact_reserve},
      {"hold_time", p.hold_time},
      {"invalid_timeout", p.invalid_timeout},
      {"own_timeout", p.own_timeout},
      {"own_patience", p.own_patience},
      {"contact_break", p.contact_break},
      {"contact_rest", p.contact_rest},
  }};
  for (const Named& item : not_negative) {
    require(item.value >= 0.0 && std::isfinite(item.value), item.name, item.value, ">= 0");
  }
  require(p.contact_rate <= p.slow_rate, "contact_rate", p.contact_rate, "at most slow_rate");
  require(p.contact_deceleration <= p.height_acceleration, "contact_deceleration",
          p.contact_deceleration, "at most height_acceleration");
  require(p.commit_height < p.gate_height, "commit_height", p.commit_height, "below gate_height");
  require(p.gate_height < p.follow_height, "gate_height", p.gate_height, "below follow_height");
  require(p.gate_sigma <= p.bridge_sigma, "gate_sigma", p.gate_sigma, "at most bridge_sigma");
  require(p.gate_tag_age <= p.bridge_time, "gate_tag_age", p.gate_tag_age, "at most bridge_time");
  require(p.own_patience < p.gate_timeout, "own_patience", p.own_patience, "below gate_timeout");
  require(p.arrival_commit_time < p.decide_time, "arrival_commit_time", p.arrival_commit_time,
          "below decide_time");
  require(p.landing_distance < p.abort_distance, "landing_distance", p.landing_distance,
          "below abort_distance");
}

}  // namespace touchdown::control
