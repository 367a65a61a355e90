// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/estimation/base/gray_image.h"

namespace touchdown::estimation {

/// Edge of the square sheet that the pad's markers are printed on [m].
inline constexpr double kPadSheetSide = 1.28;

/// The same of its image [texel].
inline constexpr int kPadSheetTexels = 1024;

/// The sheet: white, with PadTags() in black. Every edge of a cell falls on an edge of
/// a texel. Row 0 is at y_P = +0.64 m, column 0 at x_P = -0.64 m.
GrayImage PadSheet();

}  // namespace touchdown::estimation
