// SPDX-License-Identifier: BSD-3-Clause
// Limited-memory BFGS by Ceres's GradientProblem, on whitened variables z. Ceres knows no bounds
// here, so a free interval is replaced by an angle (whitened_point.cc).
//
// Statuses are Ceres's own: convergence, iteration limit. A failed line search is convergence only
// if the decrease |g|^2/2 that the metric still promises is negligible.

#include "solvers/ceres/ceres_lbfgs.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "solvers/backend/whitened_point.h"
#include "solvers/ceres/quiet_glog.h"

namespace touchdown::solvers {

namespace {

/// The objective in Ceres's variables.
class WhitenedObjective : public ceres::FirstOrderFunction {
 public:
  WhitenedObjective(WhitenedPoint* point, Evaluator* evaluator)
      : point_(point), evaluator_(evaluator) {}

  int NumParameters() const override { return point_->size(); }

  bool Evaluate(const double* z, double* cost, double* gradient) const override {
    const ShareScope scope(evaluator_, Share::kAdapter);
    if (evaluator_->must_stop()) return false;  // ends the line search at once
    if (!point_->Evaluate(z, gradient != nullptr)) return false;
    *cost = point_->value();
    if (!gradient) return true;
    point_->Gradient(gradient);
    // The metric or the interval's angle may overflow; Ceres ends the process on what is not
    // finite.
    return std::all_of(gradient, gradient + point_->size(),
                       [](double g) { return std::isfinite(g); });
  }

 private:
  WhitenedPoint* point_;
  Evaluator* evaluator_;
};

/// Hands every iteration to the evaluator.
class IterationWatch : public ceres::IterationCallback {
 public:
  IterationWatch(WhitenedPoint* point, Evaluator* evaluator)
      : point_(point), evaluator_(evaluator) {}

  void BeginLeg(const MetricLegs& legs) {
    leg_end_ = legs.endless() ? std::numeric_limits<int>::max()
                              : evaluator_->evaluations() + legs.length();
    leg_over_ = false;
  }
  bool leg_over() const { return leg_over_; }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const ShareScope scope(evaluator_, Share::kAdapter);
    double step = 0.0;
    if (summary.iteration > 0) {
      point_->Improved(&step);
      evaluator_->FinishIteration(step, summary.gradient_max_norm);
    }
    leg_over_ = evaluator_->evaluations() >= leg_end_;
    return evaluator_->CheckStop() || leg_over_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                : ceres::SOLVER_CONTINUE;
  }

 private:
  WhitenedPoint* point_;
  Evaluator* evaluator_;
  int leg_end_ = 0;
  bool leg_over_ = false;
};

class CeresLbfgs : public SolverBackend {
 public:
  CeresLbfgs()
      : SolverBackend(
            "ceres-lbfgs",
            SolverOptions({
                {"function_tolerance", 1e-7, 0.0, 1.0, false,
                 "relative decrease that ends a solve"},
                {"gradient_tolerance", 1e-10, 0.0, 1.0, false,
                 "largest gradient that ends a solve"},
                {"parameter_tolerance", 0.0, 0.0, 1.0, false, "relative step that ends a solve"},
                {"vector_storage", 10.0, 1.0, 1000.0, true, "gradients remembered"},
                MetricLegs::Option(),
                {"whiten", 1.0, 0.0, 1.0, true,
                 "1: solve in whitened variables, where their metric is regular"},
            })) {}

  Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const View& view) override {
    point_.Prepare(view);
    z_.assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& stop, Evaluator* evaluator,
               SolverResult* result) override {
    const WhitenedPoint::Settings settings{.whiten = options().Get("whiten") != 0.0,
                                           .interval_as_angle = true};
    if (!point_.Begin(view, warm.y.data(), settings, evaluator)) {
      result->status = SolveStatus::kEvaluationFailed;
      return;
    }
    if (evaluator->must_stop()) {
      result->status = evaluator->stop_status();
      return;
    }
    first_cost_ = point_.value();

    const ceres::GradientProblem problem(new WhitenedObjective(&point_, evaluator));
    ceres::GradientProblemSolver::Options solver = Options(stop);
    IterationWatch watch(&point_, evaluator);
    solver.callbacks.push_back(&watch);
    ceres::GradientProblemSolver::Summary summary;
    MetricLegs legs(point_.whitened() ? options().Get("metric_evaluations") : 0.0);
    for (;; legs.Next()) {
      std::copy(point_.z(), point_.z() + point_.size(), z_.begin());
      watch.BeginLeg(legs);
      const ShareScope scope(evaluator, Share::kNative);
      const QuietGlog quiet;
      ceres::Solve(solver, problem, z_.data(), &summary);
      if (!watch.leg_over() || evaluator->must_stop()) break;
      point_.RenewMetric(view, z_.data());
    }
    // Ceres does not call back after the step that meets its stop test.
    double step = 0.0;
    if (!evaluator->must_stop() && point_.Improved(&step)) {
      evaluator->FinishIteration(step, summary.iterations.back().gradient_max_norm);
    }
    result->native_status = summary.termination_type;
    result->message = summary.message;
    result->status = Status(summary.termination_type, evaluator);
  }

  ceres::GradientProblemSolver::Options Options(const Stop& stop) const {
    ceres::GradientProblemSolver::Options o;
    o.line_search_direction_type = ceres::LBFGS;
    o.max_lbfgs_rank = static_cast<int>(options().Get("vector_storage"));
    o.function_tolerance = options().Get("function_tolerance");
    o.gradient_tolerance = options().Get("gradient_tolerance");
    o.parameter_tolerance = options().Get("parameter_tolerance");
    o.max_num_iterations = stop.max_iterations;
    o.logging_type = ceres::SILENT;
    return o;
  }

  SolveStatus Status(ceres::TerminationType type, Evaluator* evaluator) {
    if (evaluator->must_stop()) return evaluator->stop_status();
    switch (type) {
      case ceres::CONVERGENCE:
        return SolveStatus::kConverged;
      case ceres::NO_CONVERGENCE:
        return SolveStatus::kIterationLimit;
      default:
        break;
    }
    if (point_.StationaryAtBest(first_cost_)) return SolveStatus::kConverged;
    return evaluator->failures() > 0 ? SolveStatus::kEvaluationFailed
                                     : SolveStatus::kNumericalFailure;
  }

  WhitenedPoint point_;
  std::vector<double> z_;
  double first_cost_ = 0.0;
};

}  // namespace

std::unique_ptr<SolverBackend> MakeCeresLbfgs() { return std::make_unique<CeresLbfgs>(); }

}  // namespace touchdown::solvers
