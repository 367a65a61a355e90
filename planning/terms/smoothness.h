// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/term.h"

namespace touchdown::planning {

/// Integral over the whole curve of |a|^2 + w_j |j|^2, exactly: the acceleration is linear and the
/// jerk constant on a segment,
///   int_segment |a|^2 dt = h |mean a|^2 + h^3 |j|^2 / 12.
/// Inner map u = (sqrt(h) mean a, sqrt(h (w_j + h^2/12)) j), square loss. Units: m^2/s^3 times
/// weight. Convex at fixed h. Source: eq. 15 of the paper for the derivative control points.
/// `weight` >= 0, `jerk_weight` w_j >= 0 [s^2].
std::shared_ptr<solvers::Term> MakeSmoothness(int control_points, double weight,
                                              double jerk_weight);

/// Its registry entry.
solvers::TermFactory SmoothnessFactory();

}  // namespace touchdown::planning
