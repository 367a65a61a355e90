// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace touchdown::estimation {

/// Angles are radians, except where people write and read them.
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double Radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

}  // namespace touchdown::estimation
