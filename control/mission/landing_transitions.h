// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "control/mission/landing_conditions.h"

namespace touchdown::control {

/// Into which mode, and why; the mode at hand and kNone if it lasts.
struct Transition {
  MissionMode mode;
  TransitionReason reason;
};

/// The transition of this step: the table in landing_state_machine.h.
Transition Decide(const MissionState& state, const MissionInputs& inputs,
                  const Conditions& conditions, const MissionParameters& parameters) noexcept;

}  // namespace touchdown::control
