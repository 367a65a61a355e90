// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// The backend `banded`. The Hessian is block-banded with at most one border row (a free interval),
/// and is factored in time linear in the number of blocks. Newton's method without constraint rows;
/// with them a primal-dual interior point, elastic where they cannot be met. Solve does not
/// allocate.
std::unique_ptr<SolverBackend> MakeBandedSolver();

}  // namespace touchdown::solvers
