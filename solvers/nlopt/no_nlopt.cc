// SPDX-License-Identifier: BSD-3-Clause
// Stands in for nlopt_solver.cc where the build has no NLopt.

#include "solvers/backend/missing_backend.h"
#include "solvers/nlopt/nlopt_solver.h"

namespace touchdown::solvers {

std::unique_ptr<SolverBackend> MakeNloptLbfgs() { return MakeMissingBackend("nlopt-lbfgs"); }
std::unique_ptr<SolverBackend> MakeNloptTnewton() { return MakeMissingBackend("nlopt-tnewton"); }
std::unique_ptr<SolverBackend> MakeNloptCcsaq() { return MakeMissingBackend("nlopt-ccsaq"); }
std::unique_ptr<SolverBackend> MakeNloptSlsqp() { return MakeMissingBackend("nlopt-slsqp"); }

}  // namespace touchdown::solvers
