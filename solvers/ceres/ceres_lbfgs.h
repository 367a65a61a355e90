// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// `ceres-lbfgs`: Ceres's limited-memory BFGS with a Wolfe line search, on the whitened view. Soft
/// terms only. The same class, from no_ceres.cc, where Ceres was left out.
std::unique_ptr<SolverBackend> MakeCeresLbfgs();

}  // namespace touchdown::solvers
