// SPDX-License-Identifier: BSD-3-Clause
// Numbers as a page needs them: with few decimals, so that they are short.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace touchdown::evaluation {

inline constexpr int kMilli = 3;  ///< decimals of seconds, metres, metres a second

/// `x` with so many decimals; null if it is not finite.
nlohmann::ordered_json Rounded(double x, int decimals);

/// A point in W: to the millimetre.
nlohmann::ordered_json RoundedPoint(const Eigen::Vector3d& p_W);

/// Points, one after the other: x y z x y z ...
nlohmann::ordered_json RoundedPoints(const Eigen::Ref<const Eigen::Matrix3Xd>& points_W);

}  // namespace touchdown::evaluation
