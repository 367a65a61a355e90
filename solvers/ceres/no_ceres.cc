// SPDX-License-Identifier: BSD-3-Clause
// Stands in for the Ceres sources where the build has no Ceres.

#include "solvers/backend/missing_backend.h"
#include "solvers/ceres/ceres_lbfgs.h"
#include "solvers/ceres/ceres_solver.h"

namespace touchdown::solvers {

std::unique_ptr<SolverBackend> MakeCeresSolver() { return MakeMissingBackend("ceres"); }
std::unique_ptr<SolverBackend> MakeCeresLbfgs() { return MakeMissingBackend("ceres-lbfgs"); }

}  // namespace touchdown::solvers
