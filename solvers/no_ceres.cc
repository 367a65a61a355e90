// SPDX-License-Identifier: BSD-3-Clause
// Stands in for the Ceres sources where the build has no Ceres.

#include "touchdown/solvers/ceres_lbfgs.h"
#include "touchdown/solvers/ceres_solver.h"
#include "touchdown/solvers/missing_backend.h"

namespace touchdown::solvers {

std::unique_ptr<SolverBackend> MakeCeresSolver() { return MakeMissingBackend("ceres"); }
std::unique_ptr<SolverBackend> MakeCeresLbfgs() { return MakeMissingBackend("ceres-lbfgs"); }

}  // namespace touchdown::solvers
