// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/term.h"

namespace touchdown::planning {

/// Price of time, w T with T = M h: what free arrival trades against smoothness and limits. Inner
/// map u = sqrt(T) [s^0.5] under a square loss, so that least-squares backends take it too. Not
/// convex with the rest once h is free. `weight` >= 0 [1/s].
std::shared_ptr<solvers::Term> MakeArrivalTime(int control_points, double weight);

/// Its registry entry.
solvers::TermFactory ArrivalTimeFactory();

}  // namespace touchdown::planning
