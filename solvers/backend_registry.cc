// SPDX-License-Identifier: BSD-3-Clause
// The list of backends. A new one is one line here.

#include "touchdown/solvers/backend_registry.h"

#include <stdexcept>

#include "solvers/banded/banded_solver.h"
#include "solvers/ceres/ceres_lbfgs.h"
#include "solvers/ceres/ceres_solver.h"
#include "solvers/ipopt/ipopt_solver.h"
#include "solvers/lbfgs/lbfgs_solver.h"
#include "solvers/nlopt/nlopt_solver.h"

namespace touchdown::solvers {

BackendRegistry StandardBackends() {
  return {
      {"banded", "own Newton and interior point on the arrowhead band; soft and hard limits",
       MakeBandedSolver},
      {"lbfgs", "own limited-memory BFGS with a More-Thuente line search, whitened; soft limits",
       MakeLbfgsSolver},
      {"ceres", "Ceres trust region on residuals, sparse normal equations; soft limits",
       MakeCeresSolver},
      {"ceres-lbfgs", "Ceres limited-memory BFGS, whitened; soft limits", MakeCeresLbfgs},
      {"nlopt-lbfgs", "NLopt limited-memory BFGS, whitened; soft limits", MakeNloptLbfgs},
      {"nlopt-tnewton", "NLopt truncated Newton, whitened; soft limits", MakeNloptTnewton},
      {"nlopt-ccsaq",
       "NLopt conservative convex separable approximation, whitened; soft limits, few hard rows",
       MakeNloptCcsaq},
      {"nlopt-slsqp",
       "NLopt sequential quadratic programming, dense, whitened; small hard problems",
       MakeNloptSlsqp},
      {"ipopt", "Ipopt interior point, exact sparse Hessian; the oracle for soft and hard problems",
       MakeIpopt},
      {"ipopt-lm", "Ipopt with a limited-memory Hessian, whitened; what others default to",
       MakeIpoptLm},
  };
}

BackendRegistry Overheard(const BackendRegistry& registry, const SolveListener& listener) {
  BackendRegistry overheard = registry;
  for (BackendEntry& entry : overheard) {
    entry.make = [make = entry.make, listener] {
      std::unique_ptr<SolverBackend> backend = make();
      backend->set_listener(listener);
      return backend;
    };
  }
  return overheard;
}

std::unique_ptr<SolverBackend> MakeBackend(const BackendRegistry& registry,
                                           const std::string& name) {
  std::string known;
  for (const BackendEntry& entry : registry) {
    if (entry.name == name) return entry.make();
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("solver backend " + name + " is unknown; known: " + known);
}

}  // namespace touchdown::solvers
