// SPDX-License-Identifier: BSD-3-Clause
// The conditions that the landing mission derives from one step's inputs. Private to landing_state_machine.cc and its
// transitions.
#pragma once

#include <limits>

#include "touchdown/control/mission/landing_state_machine.h"

namespace touchdown::control {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// The inputs read once: what is usable, and which conditions hold now.
struct Conditions {
  bool numbers_valid;
  bool pad_good;  ///< the pad can be planned to
  bool sees;      ///< depth images come
  Gate gate;
  bool gate_open;  ///< the pad is known well enough to descend below the gate height, gust or not
  bool may_land;   ///< ... and in the wind felt now the feet would touch first
  bool in_corridor;
  bool in_cone;   ///< of a planned landing: wider, and it opens upwards
  bool comes_in;  ///< the last seconds of plans lead through here: wider again
  bool touching;  ///< the deck, with some force
  bool
      will_touch;  ///< a foot is so low over a deck that is surely there that a climb comes too late
};

/// Height lost until the present descent has ended [m]; what ends it takes effect after `time` [s].
double HeightLost(const MissionInputs& inputs, const MissionParameters& parameters,
                  double time) noexcept;

Conditions Assess(const MissionState& state, const MissionInputs& inputs,
                  const MissionParameters& parameters) noexcept;

/// False for a condition that does not hold.
inline bool LastedLonger(double since, double t, double duration) { return t - since > duration; }

inline bool Planned(const MissionInputs& inputs) {
  return inputs.descent == DescentStyle::kPlanned;
}

/// Whether plans lead to the deck while tracking.
inline bool TouchesDown(const MissionState& state, const MissionInputs& inputs) {
  return Planned(inputs) && !state.waits_above;
}

}  // namespace touchdown::control
