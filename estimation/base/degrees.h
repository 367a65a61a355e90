// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace touchdown::estimation {

/// Angles are radians but for what people write and read.
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double Radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

}  // namespace touchdown::estimation
