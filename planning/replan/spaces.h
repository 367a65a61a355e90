// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle with these options may fly, and where its hull may be.
#pragma once

#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// Without a pad.
inline FreeSpace SpaceFor(const ReplannerOptions& options, const OccupancyMap& map) {
  FreeSpace space;
  space.map = &map;
  space.floor = options.floor_height;
  space.ceiling = options.ceiling_height;
  return space;
}

/// @param margin around the hull [m]. @param deck of the pad; nullptr: there is none. `space` must outlive the result.
inline HullSpace HullFor(const ReplannerOptions& options, const FreeSpace& space, double margin,
                         const estimation::PadPrediction* deck) {
  HullSpace hull;
  hull.space = &space;
  hull.hull_radius = options.hull_radius;
  hull.margin = margin;
  hull.pad = deck;
  hull.deck_half_size = options.deck_half_size;
  hull.foot_depth = options.contact_height;
  return hull;
}

/// The deck below a known pad that has one; nullptr: none.
inline const estimation::PadPrediction* DeckOf(const ReplanInput& input) {
  return input.pad != nullptr && input.pad->has_deck() ? input.pad : nullptr;
}

}  // namespace touchdown::planning
