// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/free_space.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/landing_term.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// Binds {p, v} pairs to the control points that shape the blocked run of `curve`: each is pushed
/// from the curve towards where the guide path crosses the plane normal to the curve there; p is
/// the last free point on the way back from the guide. Only control points 3..N-4 are free to move
/// and get pairs. Appends to `pairs`, at most up to `max_pairs`; a pair that says nearly what an
/// earlier one of the same control point said replaces it. Returns the number of pairs bound.
int BindPairs(const UniformBspline& curve, const BlockedRun& run, const GuidePath& guide,
              const FreeSpace& space, std::size_t max_pairs, std::vector<ObstaclePair>* pairs);

}  // namespace touchdown::planning
