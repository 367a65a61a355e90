// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace touchdown::evaluation {

/// Angles are radians but for what people read.
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

}  // namespace touchdown::evaluation
