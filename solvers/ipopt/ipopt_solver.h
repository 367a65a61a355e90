// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// Ipopt's interior point, equality and inequality rows included. The same classes, from
/// no_ipopt.cc, where Ipopt was left out. Solves of one process run one at a time: the MUMPS under
/// Ipopt is not thread safe.
/// `ipopt`: with the exact sparse Hessian of the Lagrangian.
std::unique_ptr<SolverBackend> MakeIpopt();
/// `ipopt-lm`: with a limited-memory Hessian, on the whitened view. It is here because other
/// frameworks default to it.
std::unique_ptr<SolverBackend> MakeIpoptLm();

}  // namespace touchdown::solvers
