// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// `ceres`: a trust region (dogleg or Levenberg-Marquardt) on the residuals of every window, sparse
/// normal equations, one thread. Soft terms only. The same class, from no_ceres.cc, where Ceres was
/// left out.
std::unique_ptr<SolverBackend> MakeCeresSolver();

}  // namespace touchdown::solvers
