// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {

/// Least squares without rows or bounds, for every backend: of J. Moré, B. Garbow, K. Hillstrom,
/// "Testing Unconstrained Optimization Software", ACM Trans. Math. Softw. 7 (1981) 17, by their
/// names. Some costs flatten to a value far out where exponentials vanish: these values are among
/// the known ones. Left out are problems with poles, which have optima between any two of them.
std::vector<ReferenceProblem> MoreGarbowHillstrom();

}  // namespace touchdown::solvers
