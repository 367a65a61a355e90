// SPDX-License-Identifier: BSD-3-Clause
// A backend that is listed and refuses. The base's Prepare throws its refusal and its Solve misses
// a Prepare, so that neither function below is ever reached through it.

#include "solvers/backend/missing_backend.h"

#include <stdexcept>

namespace touchdown::solvers {

namespace {

class MissingBackend : public SolverBackend {
 public:
  explicit MissingBackend(const std::string& name) : SolverBackend(name, {}) {}
  Capabilities capabilities() const override { return {.compiled = false}; }

 private:
  void DoPrepare(const View& view) override { throw std::invalid_argument(Refusal(view)); }
  void DoSolve(const View& view, const WarmStart&, const Stop&, Evaluator*,
               SolverResult*) override {
    throw std::invalid_argument(Refusal(view));
  }
};

}  // namespace

std::unique_ptr<SolverBackend> MakeMissingBackend(const std::string& name) {
  return std::make_unique<MissingBackend>(name);
}

}  // namespace touchdown::solvers
