// SPDX-License-Identifier: BSD-3-Clause
// The shares are measured over the flights of `study hostile` (docs/safety.md).

#include "touchdown/planning/certify/margins.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr double kSigmas = 3.0;
// Largest drift (1 sigma) between seeing a cell and passing it, whatever the error in W [m].
constexpr double kDrift = 0.03;
constexpr double kSeenFrom = 1.0;  // the last look at a cell beside the way is from so far [m]
constexpr double kLeastTracking = 0.04;  // [m]
constexpr double kGusts = 0.08;          // off the reference per gust [m per m/s^2]

}  // namespace

Margins MarginsOf(double sigma_position, double sigma_attitude, double recent_tracking,
                  double gust) noexcept {
  Margins margins;
  margins.own_state = kSigmas * std::min(sigma_position, kDrift);
  margins.attitude = kSigmas * kSeenFrom * sigma_attitude;
  margins.tracking = std::max(kLeastTracking, recent_tracking) + kGusts * gust;
  return margins;
}

void RecentError::Note(double t, double error) noexcept {
  value_ = std::max(error, value_ * std::exp(-std::max(0.0, t - t_) / kFade));
  t_ = t;
}

}  // namespace touchdown::planning
