// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace touchdown::control {

/// How the time of a Step was judged.
enum class StepTime {
  kGood,     ///< later than the last good one, by 0.1 s at most
  kResumed,  ///< taken over: a few that agree have come after a stall or from another clock
  kStands,   ///< no later than the last good one; from here on the step is refused
  kBack,     ///< earlier
  kLeap,     ///< later by more than 0.1 s
  kInvalid,  ///< not in [0, 1e10] s
};
inline constexpr int kStepTimes = 6;
std::string_view ToString(StepTime time);

/// There is a new set-point.
constexpr bool IsFlown(StepTime time) {
  return time == StepTime::kGood || time == StepTime::kResumed;
}

}  // namespace touchdown::control
