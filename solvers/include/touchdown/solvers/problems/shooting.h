// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {

/// Ten multiple-shooting problems, with a block of states and inputs for each time. The dynamics
/// are equality rows between neighbours (trapezoidal rule). Ends, waypoints and actuator limits are
/// bounds on variables; the effort is the cost. 20 to 200 steps, blocks of 3 to 16. Their optima
/// are not published: `cost` is NaN.
std::vector<ReferenceProblem> ShootingProblems();

}  // namespace touchdown::solvers
