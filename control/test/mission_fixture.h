// SPDX-License-Identifier: BSD-3-Clause
// A mission that is run step by step, shared by the tests of the landing state machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "touchdown/control/mission/landing_state_machine.h"

namespace touchdown::control {

inline constexpr double kStep = 0.01;  // [s]

/// Everything as it should be, well away from the pad.
inline MissionInputs Fine() {
  MissionInputs in;
  in.pad_available = true;
  in.pad_converged = true;
  in.horizontal_distance = 5.0;
  in.height = 1.5;
  in.pad_sigma = 0.02;
  in.tag_age = 0.05;
  in.has_plan = true;
  return in;
}

/// Runs the mission step by step; the vehicle's feet follow the command unless told otherwise.
class Mission {
 public:
  using Change = std::function<void(MissionInputs&)>;

  MissionState state;
  MissionOutputs outputs;
  MissionParameters parameters;
  MissionInputs in = Fine();
  bool height_follows = true;

  void Run(double duration, const Change& change = {}) {
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int k = 0; k < steps; ++k) Tick(change);
  }

  /// Runs until the mode is reached; returns the reason, kNone after 20 s without.
  TransitionReason RunUntil(MissionMode mode) {
    for (int k = 0; k < 2000; ++k) {
      Tick();
      if (outputs.mode == mode) return outputs.reason;
    }
    return TransitionReason::kNone;
  }

  void Tick(const Change& change = {}) {
    in.t += kStep;
    if (height_follows && state.started) in.height = state.foot_height;
    if (change) change(in);
    const MissionStep step = Step(state, in, parameters);
    // A plan to contact leads; its height is no command.
    const bool led = outputs.guidance == Guidance::kTouchDown;
    if (state.started &&
        !led) {  // the commanded height is continuous and its rate is its derivative
      const double dt = step.state.t - state.t;
      const bool climb_begins =
          step.state.mode == MissionMode::kGoAround && state.foot_height < parameters.gate_height;
      const double a = climb_begins ? parameters.turn_acceleration : parameters.height_acceleration;
      EXPECT_LE(step.state.foot_height,
                std::max(state.foot_height, parameters.follow_height) + 1e-4);
      const double advance = step.state.foot_height - state.foot_height;
      EXPECT_LE(
          std::abs(advance),
          std::max(std::abs(state.foot_height_rate), std::abs(step.state.foot_height_rate)) * dt +
              1e-12);
      if (step.state.mode != MissionMode::kDisarmed) {
        EXPECT_LE(std::abs(step.state.foot_height_rate - state.foot_height_rate), a * dt + 1e-12);
        EXPECT_NEAR(advance, 0.5 * (state.foot_height_rate + step.state.foot_height_rate) * dt,
                    1e-12);
      }
    }
    state = step.state;
    outputs = step.outputs;
  }

  void GoTo(MissionMode mode) {
    ASSERT_EQ(RunUntil(MissionMode::kTracking), TransitionReason::kPadConverged);
    if (mode == MissionMode::kTracking) return;
    in.horizontal_distance = 0.1;
    ASSERT_EQ(RunUntil(MissionMode::kLanding), TransitionReason::kAbovePad);
  }

  /// Landing, if it is not yet, commanded down to just below `height`.
  void DescendTo(double height) {
    if (outputs.mode != MissionMode::kLanding) GoTo(MissionMode::kLanding);
    for (int k = 0; k < 2000 && state.foot_height > height; ++k) Tick();
    ASSERT_LE(state.foot_height, height);
  }
};

}  // namespace touchdown::control
