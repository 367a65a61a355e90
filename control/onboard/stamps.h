// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace touchdown::control {

inline constexpr double kLatestTime = 1e10;  ///< the clock of 1970 is far below [s]
constexpr bool IsTime(double t) { return t >= 0.0 && t <= kLatestTime; }
/// The flight's own may be later than all clocks (flight_clock.h).
constexpr bool IsFlightTime(double t) { return t >= 0.0 && t <= 2.0 * kLatestTime; }
/// A given own state, a foot force and a set-point count for so long without a newer one [s].
inline constexpr double kCounts = 0.1;

/// The newest time stamps of one sensor that were checked: a ring. Does not allocate.
class Stamps {
 public:
  bool Has(double t) const {
    const auto end = stamps_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kKept));
    return std::find(stamps_.begin(), end, t) != end;
  }
  void Add(double t) { stamps_[count_++ % kKept] = t; }

 private:
  static constexpr std::size_t kKept = 64;
  std::array<double, kKept> stamps_{};
  std::size_t count_ = 0;
};

}  // namespace touchdown::control
