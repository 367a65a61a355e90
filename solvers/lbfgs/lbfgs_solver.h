// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// The backend `lbfgs`: our limited-memory BFGS (lbfgs.h) on the whitened view, with the stop test
/// of EGO-Planner's. Soft terms only. Solve does not allocate.
std::unique_ptr<SolverBackend> MakeLbfgsSolver();

}  // namespace touchdown::solvers
