// SPDX-License-Identifier: BSD-3-Clause
// Cells are 50 mm (outer tags) and 18.75 mm (centre tag) wide and begin at multiples of 1.25 mm
// from the sheet's edge. So with texels of 1.25 mm, 1024 of them along a side, sampling does not
// blur or move an edge. A power of two also spares the renderer a resampling.

#include "estimation/tags/pad_sheet.h"

#include <cmath>

#include "estimation/tags/pad_tags.h"
#include "estimation/tags/tag_code.h"

namespace touchdown::estimation {
namespace {

constexpr int kTexels = kPadSheetTexels;
constexpr double kTexel = kPadSheetSide / kTexels;  // [m]

void Print(const PadTag& tag, GrayImage* sheet) {
  const TagCode code = TagCodeOf(tag.id);
  const double cell = tag.side / kTagBlackCells;
  const double half = 0.5 * cell * kTagCells;
  const auto texels = [](double length) { return static_cast<int>(std::lround(length / kTexel)); };
  const int left = texels(tag.center_P.x() - half + 0.5 * kPadSheetSide);
  const int top = texels(0.5 * kPadSheetSide - tag.center_P.y() - half);
  const int texels_per_cell = texels(cell);
  const int side = kTagCells * texels_per_cell;
  for (int row = 0; row < side; ++row) {
    const auto& code_row = code[static_cast<std::size_t>(row / texels_per_cell)];
    for (int column = 0; column < side; ++column) {
      sheet->pixels[static_cast<std::size_t>((top + row) * kTexels + left + column)] =
          code_row[static_cast<std::size_t>(column / texels_per_cell)];
    }
  }
}

}  // namespace

GrayImage PadSheet() {
  GrayImage sheet;
  sheet.width = kTexels;
  sheet.height = kTexels;
  sheet.pixels.assign(static_cast<std::size_t>(kTexels) * kTexels, 255);
  for (const PadTag& tag : PadTags()) Print(tag, &sheet);
  return sheet;
}

}  // namespace touchdown::estimation
