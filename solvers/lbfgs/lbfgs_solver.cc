// SPDX-License-Identifier: BSD-3-Clause
// The backend `lbfgs` sees the whitened view; a free interval is an angle (whitened_point.cc). An
// evaluation that fails bounds the line search from above.
//
// Statuses: a gradient below its tolerance is convergence. A line search that gives up is
// convergence if the decrease |g|^2/2 that the metric still promises is negligible.

#include "solvers/lbfgs/lbfgs_solver.h"

#include <algorithm>
#include <limits>

#include "solvers/backend/whitened_point.h"
#include "solvers/lbfgs/lbfgs.h"

namespace touchdown::solvers {

namespace {

/// The objective in whitened variables, asked and told through the evaluator.
class WhitenedObjective : public LbfgsFunction {
 public:
  WhitenedObjective(WhitenedPoint* point, Evaluator* evaluator)
      : point_(point), evaluator_(evaluator) {}

  double Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* gradient) override {
    const ShareScope scope(evaluator_, Share::kAdapter);
    if (!point_->Evaluate(z.data(), true)) return std::numeric_limits<double>::infinity();
    point_->Gradient(gradient->data());
    return point_->value();
  }

  bool Cancelled() override { return leg_over_ || evaluator_->must_stop(); }

  void BeginLeg(const MetricLegs& legs) {
    leg_end_ = legs.endless() ? std::numeric_limits<int>::max()
                              : evaluator_->evaluations() + legs.length();
    leg_over_ = false;
  }
  bool leg_over() const { return leg_over_; }

  void Accepted(double /*value*/, const Eigen::VectorXd& gradient) override {
    double step = 0.0;
    point_->Improved(&step);
    evaluator_->FinishIteration(step, gradient.lpNorm<Eigen::Infinity>());
    evaluator_->CheckStop();
    leg_over_ = evaluator_->evaluations() >= leg_end_;
  }

 private:
  WhitenedPoint* point_;
  Evaluator* evaluator_;
  int leg_end_ = 0;
  bool leg_over_ = false;
};

class LbfgsSolver : public SolverBackend {
 public:
  LbfgsSolver()
      : SolverBackend("lbfgs",
                      SolverOptions({
                          {"gradient_tolerance", 1e-6, 0.0, 1.0, false,
                           "norm of the gradient that ends a solve, in units of the point's"},
                          {"vector_storage", 16.0, 1.0, 1000.0, true, "gradients remembered"},
                          {"max_line_search", 40.0, 1.0, 1000.0, true, "evaluations per step"},
                          {"sufficient_decrease", 1e-4, 1e-10, 0.5, false,
                           "of the line search: share of the linear decrease"},
                          {"curvature", 0.9, 1e-4, 0.999, false,
                           "of the line search: share of the first slope that may be left"},
                          MetricLegs::Option(),
                          {"whiten", 1.0, 0.0, 1.0, true,
                           "1: solve in whitened variables, where their metric is regular"},
                      })) {}

  Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const View& view) override {
    point_.Prepare(view);
    z_.setZero(view.num_variables());
    prepared_memory_ = static_cast<int>(options().Get("vector_storage"));
    lbfgs_.Prepare(view.num_variables(), prepared_memory_);
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& /*stop*/, Evaluator* evaluator,
               SolverResult* result) override {
    const WhitenedPoint::Settings settings{.whiten = options().Get("whiten") != 0.0,
                                           .interval_as_angle = true};
    if (!point_.Begin(view, warm.y.data(), settings, evaluator)) {
      result->status = SolveStatus::kEvaluationFailed;
      return;
    }
    const double first_cost = point_.value();
    const int memory = static_cast<int>(options().Get("vector_storage"));
    if (memory != prepared_memory_) {
      prepared_memory_ = memory;
      lbfgs_.Prepare(view.num_variables(), memory);
    }
    WhitenedObjective objective(&point_, evaluator);
    LbfgsResult run;
    MetricLegs legs(point_.whitened() ? options().Get("metric_evaluations") : 0.0);
    for (;; legs.Next()) {
      std::copy(point_.z(), point_.z() + point_.size(), z_.data());
      objective.BeginLeg(legs);
      const ShareScope scope(evaluator, Share::kNative);
      run = lbfgs_.Minimize(Options(), &objective, &z_);
      const bool cancelled = run.status == LbfgsStatus::kCancelled;
      if (!cancelled || !objective.leg_over() || evaluator->must_stop()) break;
      point_.RenewMetric(view, z_.data());
    }
    result->native_status = static_cast<int>(run.status);
    result->message = ToString(run.status);
    result->status = Status(run.status, first_cost, evaluator);
  }

  LbfgsOptions Options() const {
    LbfgsOptions o;
    o.gradient_tolerance = options().Get("gradient_tolerance");
    o.max_iterations = 0;  // the evaluator keeps the budget
    o.line_search.sufficient_decrease = options().Get("sufficient_decrease");
    o.line_search.curvature = options().Get("curvature");
    o.line_search.max_evaluations = static_cast<int>(options().Get("max_line_search"));
    return o;
  }

  SolveStatus Status(LbfgsStatus status, double first_cost, Evaluator* evaluator) {
    switch (status) {
      case LbfgsStatus::kConverged:
      case LbfgsStatus::kAlreadyMinimized:
        return SolveStatus::kConverged;
      case LbfgsStatus::kCancelled:
      case LbfgsStatus::kIterationLimit:
        return evaluator->stop_status();
      case LbfgsStatus::kEvaluationFailed:
        return SolveStatus::kEvaluationFailed;
      case LbfgsStatus::kLineSearchFailed:
        break;
    }
    if (evaluator->must_stop()) return evaluator->stop_status();
    if (point_.StationaryAtBest(first_cost)) return SolveStatus::kConverged;
    return evaluator->failures() > 0 ? SolveStatus::kEvaluationFailed
                                     : SolveStatus::kNumericalFailure;
  }

  WhitenedPoint point_;
  Lbfgs lbfgs_;
  Eigen::VectorXd z_;
  int prepared_memory_ = 0;
};

}  // namespace

std::unique_ptr<SolverBackend> MakeLbfgsSolver() { return std::make_unique<LbfgsSolver>(); }

}  // namespace touchdown::solvers
