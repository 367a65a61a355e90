// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/obstacles/obstacle.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

/// Shape of the pad vehicle: a square deck (a board) on a box body. The height of the deck above
/// the ground is the z of the pad's motion.
struct PadGeometry {
  double deck_half_size = 0.75;   ///< half the side of the deck [m], in [0.1, 5]
  double deck_thickness = 0.03;   ///< of the board [m], in [0.005, 0.2]
  double body_half_length = 0.5;  ///< of the box below the deck, along the pad's x axis [m]
  double body_half_width = 0.35;  ///< along the pad's y axis [m]
  double ground_gap = 0.05;       ///< between the body's underside and the ground [m], >= 0
  double friction = 1.0;          ///< sliding friction between feet and deck, in (0, 5]
};

/// Throws std::invalid_argument naming the key, its value and the allowed range. `deck_height` is
/// the deck's upper face above the ground [m].
void Validate(const PadGeometry& geometry, double deck_height);

/// The deck's board in W for a pad at `pad`; its upper face is at the pad's z.
Box DeckBox(const PadGeometry& geometry, const estimation::PadState& pad);

/// The vehicle's body below the deck in W.
Box PadBodyBox(const PadGeometry& geometry, const estimation::PadState& pad);

/// The edge of an opaque plate that covers this share of the printed sheet. The plate lies on the sheet from this x_P
/// to the sheet's front edge [m].
double PlateEdge(double share);

}  // namespace touchdown::sim
