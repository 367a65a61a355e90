// SPDX-License-Identifier: BSD-3-Clause
// Stands in for ipopt_solver.cc where the build has no Ipopt.

#include "solvers/backend/missing_backend.h"
#include "solvers/ipopt/ipopt_solver.h"

namespace touchdown::solvers {

std::unique_ptr<SolverBackend> MakeIpopt() { return MakeMissingBackend("ipopt"); }
std::unique_ptr<SolverBackend> MakeIpoptLm() { return MakeMissingBackend("ipopt-lm"); }

}  // namespace touchdown::solvers
