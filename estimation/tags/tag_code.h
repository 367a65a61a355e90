// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace touchdown::estimation {

/// Cells along the side of a printed TAG36H11 marker: with the white ring, and of the black square
/// within it. A tag's side is the side of this square.
inline constexpr int kTagCells = 10;
inline constexpr int kTagBlackCells = 8;

/// Grey level of each cell, 0 or 255; row 0 is the top of the upright marker, column 0 its left.
using TagCode = std::array<std::array<std::uint8_t, kTagCells>, kTagCells>;

/// The marker `id` as libapriltag prints it. Throws std::invalid_argument for an id that the family
/// lacks.
TagCode TagCodeOf(int id);

}  // namespace touchdown::estimation
