// SPDX-License-Identifier: BSD-3-Clause
// The pad vehicle as two upright boxes that turn with the pad: the board and the body below it.

#include "sim/pad/pad_geometry.h"

#include "estimation/base/argument_check.h"
#include "estimation/tags/pad_sheet.h"

namespace touchdown::sim {

void Validate(const PadGeometry& geometry, double deck_height) {
  estimation::CheckWithin("pad.deck_half_size", geometry.deck_half_size, 0.1, 5.0);
  estimation::CheckWithin("pad.deck_thickness", geometry.deck_thickness, 0.005, 0.2);
  estimation::CheckWithin("pad.body_half_length", geometry.body_half_length, 0.05, 5.0);
  estimation::CheckWithin("pad.body_half_width", geometry.body_half_width, 0.05, 5.0);
  estimation::CheckWithin("pad.ground_gap", geometry.ground_gap, 0.0, 1.0);
  estimation::CheckAbove("pad.friction", geometry.friction, 0.0, 5.0);
  // Below the board there is room for a body at least a centimetre high.
  estimation::CheckWithin("pad deck height", deck_height,
                          geometry.ground_gap + geometry.deck_thickness + 0.01, 10.0);
}

Box DeckBox(const PadGeometry& geometry, const estimation::PadState& pad) {
  const double half_thickness = 0.5 * geometry.deck_thickness;
  return {pad.p_WP - half_thickness * Eigen::Vector3d::UnitZ(),
          {geometry.deck_half_size, geometry.deck_half_size, half_thickness},
          pad.yaw};
}

Box PadBodyBox(const PadGeometry& geometry, const estimation::PadState& pad) {
  const double top = pad.p_WP.z() - geometry.deck_thickness;
  const double half_height = 0.5 * (top - geometry.ground_gap);
  return {{pad.p_WP.x(), pad.p_WP.y(), top - half_height},
          {geometry.body_half_length, geometry.body_half_width, half_height},
          pad.yaw};
}

double PlateEdge(double share) { return (0.5 - share) * estimation::kPadSheetSide; }

}  // namespace touchdown::sim
