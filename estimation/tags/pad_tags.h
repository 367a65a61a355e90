// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

namespace touchdown::estimation {

/// One square TAG36H11 marker, flat on the deck, its sides along the pad's axes. The side is that
/// of the black square, the white ring around it not counted.
struct PadTag {
  int id = 0;                                          ///< in the family TAG36H11
  Eigen::Vector2d center_P = Eigen::Vector2d::Zero();  ///< [m]
  double side = 0.15;                                  ///< [m]

  /// Corners in P [m], columns in the order in which the tag detector reports them: (-,-), (+,-),
  /// (+,+), (-,+).
  Eigen::Matrix<double, 2, 4> Corners() const;
};

inline constexpr int kPadTagCount = 5;

/// The pad's five markers, the index is the id: the small one in the centre first, then four large
/// ones around it.
const std::array<PadTag, kPadTagCount>& PadTags();

}  // namespace touchdown::estimation
