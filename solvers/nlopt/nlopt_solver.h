// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// Gradient-based methods of NLopt on the whitened view. The same classes, from no_nlopt.cc, where
/// NLopt was left out.
/// `nlopt-lbfgs`: limited-memory BFGS (Luksan). Soft terms only.
std::unique_ptr<SolverBackend> MakeNloptLbfgs();
/// `nlopt-tnewton`: preconditioned truncated Newton with restarts (Luksan). Soft terms only.
std::unique_ptr<SolverBackend> MakeNloptTnewton();
/// `nlopt-ccsaq`: conservative convex separable approximation, quadratic (Svanberg). Inequalities.
std::unique_ptr<SolverBackend> MakeNloptCcsaq();
/// `nlopt-slsqp`: sequential least-squares quadratic programming (Kraft). Inequalities, equalities.
std::unique_ptr<SolverBackend> MakeNloptSlsqp();

}  // namespace touchdown::solvers
