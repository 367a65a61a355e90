// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// The backend `banded`, which lives off the structure: a block-banded Hessian with at most one
/// border row (a free interval) is factored in time linear in the number of blocks. Newton's method
/// without constraint rows, a primal-dual interior point with them, elastic where they cannot be
/// met. Solve does not allocate.
std::unique_ptr<SolverBackend> MakeBandedSolver();

}  // namespace touchdown::solvers
