// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {

/// Least squares without rows or bounds, for every backend, from J. Moré, B. Garbow, K. Hillstrom,
/// "Testing Unconstrained Optimization Software", ACM Trans. Math. Softw. 7 (1981) 17, by their
/// names. Some costs become flat far out where exponentials vanish: these values are among the
/// known ones. Problems with poles are left out: they have optima between any two poles.
std::vector<ReferenceProblem> MoreGarbowHillstrom();

}  // namespace touchdown::solvers
