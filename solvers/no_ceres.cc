// SPDX-License-Identifier: BSD-3-Clause
// Stands in for ceres_solver.cc where the build has no Ceres: listed, and refuses with a sentence.

#include <stdexcept>

#include "touchdown/solvers/ceres_solver.h"

namespace touchdown::solvers {

namespace {

class NoCeresSolver : public SolverBackend {
 public:
  NoCeresSolver() : SolverBackend("ceres", {}) {}
  Capabilities capabilities() const override { return {.compiled = false}; }

 private:
  void DoPrepare(const View& view) override { throw std::invalid_argument(Refusal(view)); }
  void DoSolve(const View& view, const WarmStart&, const Stop&, Evaluator*,
               SolverResult*) override {
    throw std::invalid_argument(Refusal(view));
  }
};

}  // namespace

std::unique_ptr<SolverBackend> MakeCeresSolver() { return std::make_unique<NoCeresSolver>(); }

}  // namespace touchdown::solvers
