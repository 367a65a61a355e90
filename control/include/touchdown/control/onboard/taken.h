// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace touchdown::control {

/// How a measurement was treated.
enum class Taken {
  kUsed,     ///< in its place in time, also where it came late or out of order
  kWaiting,  ///< queued for the start of the filter
  kGated,    ///< too unlikely, or of no use to the filter now; nothing changed
  kEmpty,    ///< an image that does not show the pad, or no depth at all
  kIgnored,  ///< the pad's GPS, while its tags are seen and the own state is estimated
  kDoubled,  ///< a duplicate: this sensor's measurement of that time is there already
  kTooOld,   ///< older than the history reaches
  kInvalid,  ///< not finite, out of range, or ahead of time
  kUnasked,  ///< not expected: no such sensor is configured, or the own state is not known yet
};
inline constexpr int kTakenKinds = 9;
std::string_view ToString(Taken taken);

/// A second one of the same time would be a duplicate.
constexpr bool IsLookedAt(Taken taken) {
  return taken == Taken::kUsed || taken == Taken::kGated || taken == Taken::kWaiting;
}

}  // namespace touchdown::control
