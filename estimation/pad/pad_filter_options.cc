// SPDX-License-Identifier: BSD-3-Clause
// Names of the pad filter's models and outcomes, and the ranges of its options.

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "touchdown/estimation/pad/pad_filter.h"

namespace touchdown::estimation {
namespace {

void Require(bool good, const char* name, double value, const char* range) {
  if (good) return;
  std::ostringstream message;
  message << "PadFilterOptions." << name << " = " << value << ", allowed: " << range;
  throw std::invalid_argument(message.str());
}

void RequirePositive(const char* name, double value) {
  Require(value > 0.0 && std::isfinite(value), name, value, "> 0");
}

void RequireNotNegative(const char* name, double value) {
  Require(value >= 0.0 && std::isfinite(value), name, value, ">= 0");
}

}  // namespace

PadModel PadModelFromName(std::string_view name) {
  if (name == "paper") return PadModel::kPaper;
  if (name == "turn_rate") return PadModel::kTurnRate;
  throw std::invalid_argument("pad model '" + std::string(name) + "', allowed: paper, turn_rate");
}

std::string_view ToString(PadModel model) {
  return model == PadModel::kPaper ? "paper" : "turn_rate";
}

std::string_view ToString(PadUpdate update) {
  switch (update) {
    case PadUpdate::kInitialized:
      return "initialized";
    case PadUpdate::kAccepted:
      return "accepted";
    case PadUpdate::kAcceptedLate:
      return "accepted_late";
    case PadUpdate::kGated:
      return "gated";
    case PadUpdate::kTooOld:
      return "too_old";
    case PadUpdate::kNotUsed:
      return "not_used";
    case PadUpdate::kInvalid:
      return "invalid";
  }
  return "unknown";
}

void Validate(const PadFilterOptions& options) {
  Require(std::isfinite(options.pad_height), "pad_height", options.pad_height, "finite");
  RequirePositive("noise.position", options.noise.position);
  RequirePositive("noise.velocity", options.noise.velocity);
  RequirePositive("noise.acceleration", options.noise.acceleration);
  RequirePositive("noise.heading", options.noise.heading);
  RequirePositive("noise.turn", options.noise.turn);
  RequirePositive("speed_prior", options.speed_prior);
  RequirePositive("turn_rate_prior", options.turn_rate_prior);
  RequirePositive("heading_significance", options.heading_significance);
  RequirePositive("chord_significance", options.chord_significance);
  RequirePositive("min_speed", options.min_speed);
  RequirePositive("heading_lost_sigma", options.heading_lost_sigma);
  Require(options.gate_probability > 0.0 && options.gate_probability < 1.0, "gate_probability",
          options.gate_probability, "(0, 1)");
  RequireNotNegative("maneuver_speed", options.maneuver_speed);
  RequireNotNegative("maneuver_heading", options.maneuver_heading);
  RequireNotNegative("maneuver_turn_rate", options.maneuver_turn_rate);
  Require(options.restart_after >= 1, "restart_after", options.restart_after, ">= 1");
  RequireNotNegative("gps_restart_silence", options.gps_restart_silence);
  RequireNotNegative("max_delay", options.max_delay);
  RequireNotNegative("own_position_sigma", options.own_position_sigma);
  RequireNotNegative("own_attitude_sigma", options.own_attitude_sigma);
  RequireNotNegative("hand_over_distance", options.hand_over_distance);
  RequireNotNegative("hand_over_timeout", options.hand_over_timeout);
  RequirePositive("converged_position_sigma", options.converged_position_sigma);
  RequirePositive("converged_velocity_sigma", options.converged_velocity_sigma);
}

}  // namespace touchdown::estimation
