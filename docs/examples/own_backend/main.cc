// SPDX-License-Identifier: BSD-3-Clause
// The whole program `touchdown` with its own solver backend, the chord method. This is Newton's method that keeps a
// factor of the Hessian for several steps. Each step is halved until the cost decreases.

#include <memory>
#include <utility>

#include "touchdown/evaluation/program/program.h"
#include "touchdown/solvers/backend/newton_step.h"
#include "touchdown/solvers/backend/solver_backend.h"

namespace solvers = touchdown::solvers;
using solvers::SolveStatus;

class ChordSolver : public solvers::SolverBackend {
 public:
  ChordSolver()
      : SolverBackend("chord",
                      solvers::SolverOptions({
                          {"renew", 3, 1, 100, true, "steps with one factor"},
                          {"gap", 1e-9, 1e-15, 1, false, "decrease left, share of the cost"},
                      })) {}

  // Costs and a free arrival, no constraint rows: `hard_rows` and `equality_rows` stay false.
  solvers::Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const solvers::View& view) override {
    solvers::BorderedBandMatrix shape;
    shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
                 view.free_interval());
    factor_.Prepare(shape);
    step_.setZero(view.num_variables());
  }

  void DoSolve(const solvers::View& view, const solvers::WarmStart& warm,
               const solvers::Stop& /*stop*/, solvers::Evaluator* evaluator,
               solvers::SolverResult* result) override {
    result->status = Run(view, warm.y, evaluator);
    result->message = solvers::ToString(result->status);
  }

  SolveStatus Run(const solvers::View& view, Eigen::VectorXd y, solvers::Evaluator* evaluator) {
    const solvers::ShareScope own(evaluator, solvers::Share::kNative);  // except evaluations
    const int renew = static_cast<int>(options().Get("renew"));
    Eigen::VectorXd gradient, trial;
    for (int k = 0; !evaluator->must_stop(); ++k) {
      const bool fresh = k % renew == 0;
      const bool ok = fresh ? evaluator->EvaluateLagrangian(y.data(), {})
                            : evaluator->Evaluate(y.data(), {.gradient = true});
      if (!ok) return SolveStatus::kEvaluationFailed;
      const solvers::ViewEvaluation& at = evaluator->last();
      if (fresh && !solvers::FactorDefinite(at.hessian, &factor_)) break;
      const double cost = at.full.value;
      gradient = Eigen::Map<const Eigen::VectorXd>(at.gradient.data(), y.size());
      const double promised =
          solvers::NewtonStep(view, y.data(), gradient.data(), factor_, step_.data());
      const double slope = -2.0 * promised;
      if (promised <= options().Get("gap") * cost) return SolveStatus::kConverged;

      double t = 1.0;
      for (; t > 1e-10; t *= 0.5) {
        trial = y + t * step_;
        const bool lower = evaluator->Evaluate(trial.data(), {.gradient = true}) &&
                           evaluator->last().full.value < cost + 1e-4 * t * slope;
        if (lower || evaluator->must_stop()) break;
      }
      if (t <= 1e-10) break;
      y.swap(trial);
      evaluator->FinishIteration(t * step_.norm(), gradient.lpNorm<Eigen::Infinity>());
      evaluator->CheckStop();
    }
    return evaluator->must_stop() ? evaluator->stop_status() : SolveStatus::kNumericalFailure;
  }

  solvers::BorderedCholesky factor_;
  Eigen::VectorXd step_;
};

int main(int argc, char** argv) {
  touchdown::evaluation::Registries registries = touchdown::evaluation::StandardRegistries();
  registries.backends.push_back({"chord", "Newton steps with a factor that is kept; soft limits",
                                 [] { return std::make_unique<ChordSolver>(); }});
  return touchdown::evaluation::RunProgram(argc, argv, registries);
}
