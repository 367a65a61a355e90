// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// A stretch of a curve inside blocked cells. `t_in` is the last free time before it (or the start
/// of the check), `t_out` the first after it (or the end of the curve).
struct BlockedRun {
  double t_in = 0.0;
  double t_out = 0.0;
  bool at_start = false;  ///< the curve starts blocked
  bool at_end = false;    ///< and this one ends blocked
};

/// Visits every cell that the curve passes from t_from to its end. Uses chords whose sagitta is at
/// most kChordSagitta. Collects the blocked runs in order in `runs` (cleared first).
void FindBlockedRuns(const UniformBspline& curve, double t_from, const FreeSpace& space,
                     std::vector<BlockedRun>* runs);

/// Time of the first blocked cell, or +infinity. Does not allocate.
double FirstBlockedTime(const UniformBspline& curve, double t_from, const FreeSpace& space);

}  // namespace touchdown::planning
