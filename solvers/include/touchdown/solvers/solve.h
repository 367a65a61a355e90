// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/backend/stop.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// One solve of a problem in its own variables (blocks x d, then the interval if it is free) with one of the standard
/// backends. Allocates: a caller that solves many of one structure prepares its own backend (solver_backend.h).
/// Throws std::invalid_argument if the backend is unknown or refuses the problem, or if the start has another size.
SolverResult Solve(const Problem& problem, const Eigen::VectorXd& start,
                   const std::string& backend = "banded", const Stop& stop = {});

}  // namespace touchdown::solvers
