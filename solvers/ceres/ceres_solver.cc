// SPDX-License-Identifier: BSD-3-Clause
// Trust-region least squares by Ceres Solver. There is one residual block per window and term, on
// the reduced blocks that the window reaches. Ceres's evaluation callback computes all numbers of a
// point in one pass over the Problem, and the residual blocks only copy their slice. So the problem
// is never evaluated twice, and no term knows of Ceres. The trust region starts so wide that the
// first step is Gauss-Newton's: the landing problem is nearly quadratic once its pairs are fixed.
// Inside the region Powell's dogleg is the default. Levenberg-Marquardt's damping measures steps in
// the unwhitened variables. Where it has to act on a long spline, it needs many iterations (a
// hundred times as many on one problem in fifty). A rejected dogleg step needs no new
// factorisation.

#include "solvers/ceres/ceres_solver.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <vector>

#include "solvers/ceres/quiet_glog.h"

namespace touchdown::solvers {

namespace {

/// The residuals of one window of one term and their Jacobian by reduced block, as Ceres wants
/// them. Bound anew for every solve, filled at every point.
class WindowResidual : public ceres::CostFunction {
 public:
  void Bind(const View& view, int term, int window, int first_block, double* y) {
    view_ = &view;
    term_ = term;
    window_ = window;
    first_block_ = first_block;
    const TermShape& shape = view.problem().term(term).shape();
    const int d = view.block_size();
    set_num_residuals(shape.outputs);
    residuals_.resize(shape.outputs);
    int reduced[kMaxWindow];
    const int count = view.WindowBlocks(first_block, shape.window, reduced);
    stride_ = count * d + (view.free_interval() ? 1 : 0);
    jacobian_.resize(shape.outputs * stride_);
    jacobian_is_known_ = valid_ = false;
    mutable_parameter_block_sizes()->assign(count, d);
    parameters_.clear();
    for (int b = 0; b < count; ++b) parameters_.push_back(y + reduced[b] * d);
    if (view.free_interval()) {
      mutable_parameter_block_sizes()->push_back(1);
      parameters_.push_back(y + view.num_variables() - 1);
    }
  }

  const std::vector<double*>& parameters() const { return parameters_; }

  void Fill(const ViewEvaluation& point, bool with_jacobian) {
    const TermShape& shape = view_->problem().term(term_).shape();
    const TermBlock& block = point.full.terms[term_];
    const int first = shape.row(window_, 0);
    std::copy_n(&block.r[first], shape.outputs, residuals_.data());
    if (!with_jacobian || jacobian_is_known_) return;
    jacobian_is_known_ = shape.quadratic && !view_->free_interval();
    double* row = jacobian_.data();
    for (int i = first; i < first + shape.outputs; ++i, row += stride_) {
      const double* du = block.slopes(i);
      view_->WindowJacobian(du, first_block_, shape.window, block.dr[i], row);
      if (!view_->free_interval()) continue;
      row[stride_ - 1] = block.dr[i] * view_->IntervalDerivative(du, block.du_dh[i], first_block_,
                                                                 shape.window, point);
    }
  }

  void SetValid(bool valid) { valid_ = valid; }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    if (!valid_) return false;
    std::copy(residuals_.begin(), residuals_.end(), residuals);
    if (!jacobians) return true;
    int begin = 0;
    for (std::size_t b = 0; b < parameters_.size(); ++b) {
      const int size = parameter_block_sizes()[b];
      for (int i = 0; jacobians[b] && i < num_residuals(); ++i) {
        std::copy_n(&jacobian_[i * stride_ + begin], size, jacobians[b] + i * size);
      }
      begin += size;
    }
    return true;
  }

 private:
  const View* view_ = nullptr;
  int term_ = 0;
  int window_ = 0;
  int first_block_ = 0;
  int stride_ = 0;  // of a row of the Jacobian
  bool jacobian_is_known_ = false;
  bool valid_ = false;
  std::vector<double*> parameters_;
  std::vector<double> residuals_;
  std::vector<double> jacobian_;  // row by row: its parameter blocks, then h if free
};

/// All active windows of a view, evaluated in one pass whenever Ceres moves to a new point.
class WindowResiduals : public ceres::EvaluationCallback {
 public:
  /// The windows that are active at the evaluator's last point. Those of eliminated blocks only are
  /// constants and left out.
  void Bind(const View& view, Evaluator* evaluator, double* y) {
    evaluator_ = evaluator;
    y_ = y;
    bound_ = 0;
    for (int i = 0; i < view.problem().num_terms(); ++i) {
      const TermBlock& block = evaluator->last().full.terms[i];
      for (int k = 0; k < block.windows; ++k) {
        if (bound_ == windows_.size()) windows_.emplace_back();
        windows_[bound_].Bind(view, i, k, block.first_block[k], y);
        if (!windows_[bound_].parameters().empty()) ++bound_;
      }
    }
  }

  void AddTo(ceres::Problem* problem) {
    for (std::size_t i = 0; i < bound_; ++i) {
      problem->AddResidualBlock(&windows_[i], nullptr, windows_[i].parameters());
    }
  }

  /// Gradients come with every point: almost every trial step is accepted, and a second pass for
  /// them would cost more than they do. Past a budget no further point is evaluated.
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override {
    const ShareScope scope(evaluator_, Share::kAdapter);
    const bool valid = !(new_evaluation_point && evaluator_->must_stop()) &&
                       evaluator_->Evaluate(y_, {.gradient = true, .residual = true});
    for (std::size_t i = 0; i < bound_; ++i) {
      windows_[i].SetValid(valid);
      if (valid) windows_[i].Fill(evaluator_->last(), evaluate_jacobians);
    }
  }

 private:
  Evaluator* evaluator_ = nullptr;
  const double* y_ = nullptr;
  std::deque<WindowResidual> windows_;  // Ceres keeps their addresses
  std::size_t bound_ = 0;               // those of this solve
};

/// Hands every iteration to the evaluator. Shrinking a dogleg's region may leave the rejected step
/// as it was: nothing is evaluated then, and it does not count.
class ProgressWatch : public ceres::IterationCallback {
 public:
  explicit ProgressWatch(Evaluator* evaluator)
      : evaluator_(evaluator),
        told_cost_(evaluator->best_cost()),
        told_evaluations_(evaluator->evaluations()) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const ShareScope scope(evaluator_, Share::kAdapter);
    if (summary.iteration > 0 && evaluator_->evaluations() > told_evaluations_) {
      Tell(summary.step_norm, summary.gradient_max_norm);
    }
    return evaluator_->CheckStop() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  /// After a solve: Ceres does not call back after the step that meets its stop test.
  void Finish() {
    const ShareScope scope(evaluator_, Share::kAdapter);
    if (evaluator_->must_stop() || evaluator_->best_cost() == told_cost_) return;
    const double hidden = std::numeric_limits<double>::quiet_NaN();
    Tell(hidden, hidden);
  }

 private:
  void Tell(double step_norm, double gradient_max_norm) {
    evaluator_->FinishIteration(step_norm, gradient_max_norm);
    told_cost_ = evaluator_->best_cost();
    told_evaluations_ = evaluator_->evaluations();
  }

  Evaluator* evaluator_;
  double told_cost_;
  int told_evaluations_;
};

/// How often a free interval may be held at a bound or released.
constexpr int kMostRounds = 4;

class CeresSolver : public SolverBackend {
 public:
  CeresSolver()
      : SolverBackend(
            "ceres",
            SolverOptions({
                {"function_tolerance", 1e-7, 1e-16, 1.0, false,
                 "relative decrease that ends a solve"},
                {"gradient_tolerance", 1e-10, 1e-16, 1.0, false,
                 "largest gradient that ends a solve"},
                {"parameter_tolerance", 1e-8, 1e-16, 1.0, false, "relative step that ends a solve"},
                {"dogleg", 1.0, 0.0, 1.0, true, "1: Powell's dogleg; 0: Levenberg-Marquardt"},
                {"initial_trust_region_radius", 1e8, 1e-3, 1e16, false, "1e8: nearly Gauss-Newton"},
            })) {}

  Capabilities capabilities() const override { return {.needs_residuals = true}; }

 private:
  void DoPrepare(const View& view) override {
    y_.resize(static_cast<std::size_t>(view.num_variables()));
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& /*stop*/, Evaluator* evaluator,
               SolverResult* result) override {
    std::copy(warm.y.data(), warm.y.data() + warm.y.size(), y_.begin());
    // The first evaluation also shows which windows are active now.
    if (!evaluator->Evaluate(y_.data(), {.gradient = true, .residual = true})) {
      result->status = SolveStatus::kEvaluationFailed;
      return;
    }
    if (evaluator->must_stop()) {
      result->status = evaluator->stop_status();
      return;
    }
    windows_.Bind(view, evaluator, y_.data());
    ProgressWatch watch(evaluator);
    ceres::Solver::Options solver = Options();
    solver.callbacks.push_back(&watch);

    const ShareScope scope(evaluator, Share::kNative);
    ceres::Problem::Options problem_options;
    problem_options.evaluation_callback = &windows_;
    problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    // The checks look for parameter blocks that repeat, differ in size or overlap. Those of a view
    // are distinct slices of y_.
    problem_options.disable_all_safety_checks = true;
    ceres::Problem problem(problem_options);
    windows_.AddTo(&problem);
    BoundInterval(view, &problem);
    ceres::Solver::Summary summary;
    bool held = false, more = false;
    for (int round = 0; round < kMostRounds; ++round) {
      const QuietGlog quiet;
      ceres::Solve(solver, &problem, &summary);
      watch.Finish();
      more = ChangeHold(view, evaluator, &held, &problem);
      if (!more) break;
    }
    result->native_status = summary.termination_type;
    result->message = summary.message;
    // Still changing its mind about the bound after all rounds is no convergence.
    result->status =
        more ? SolveStatus::kNumericalFailure : Status(summary.termination_type, *evaluator);
  }

  /// Ceres projects its steps onto bounds, but computes them as if there were none. With the
  /// interval at a bound it stops beside the optimum. So the interval is held there, and the rest
  /// is solved again. It is released where the objective falls inwards. Returns true if there is
  /// more to solve.
  bool ChangeHold(const View& view, Evaluator* evaluator, bool* held, ceres::Problem* problem) {
    const ShareScope scope(evaluator, Share::kAdapter);
    double* h = &y_.back();
    if (!view.free_interval() || evaluator->must_stop() || !problem->HasParameterBlock(h)) {
      return false;
    }
    const ProblemShape& shape = view.problem().shape();
    const bool at_min = *h <= shape.interval_min, at_max = *h >= shape.interval_max;
    if (at_min == at_max) return false;
    if (!evaluator->Evaluate(y_.data(), {.gradient = true})) return false;
    const double slope = evaluator->last().gradient.back();
    const bool outwards = at_min ? slope > 0.0 : slope < 0.0;
    if (outwards == *held) return false;
    *held = outwards;
    if (*held) {
      problem->SetParameterBlockConstant(h);
    } else {
      problem->SetParameterBlockVariable(h);
    }
    return true;
  }

  void BoundInterval(const View& view, ceres::Problem* problem) {
    double* h = &y_.back();
    if (!view.free_interval() || !problem->HasParameterBlock(h)) return;
    const ProblemShape& shape = view.problem().shape();
    if (shape.interval_min == shape.interval_max) {
      problem->SetParameterBlockConstant(h);
    } else {
      problem->SetParameterLowerBound(h, 0, shape.interval_min);
      problem->SetParameterUpperBound(h, 0, shape.interval_max);
    }
  }

  ceres::Solver::Options Options() const {
    ceres::Solver::Options o;
    o.trust_region_strategy_type =
        options().Get("dogleg") != 0.0 ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
    o.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    o.num_threads = 1;
    o.jacobi_scaling = false;
    o.initial_trust_region_radius = options().Get("initial_trust_region_radius");
    o.function_tolerance = options().Get("function_tolerance");
    o.gradient_tolerance = options().Get("gradient_tolerance");
    o.parameter_tolerance = options().Get("parameter_tolerance");
    o.max_num_iterations = std::numeric_limits<int>::max();  // ours are counted by the watch
    o.logging_type = ceres::SILENT;
    return o;
  }

  static SolveStatus Status(ceres::TerminationType type, const Evaluator& evaluator) {
    if (evaluator.must_stop()) return evaluator.stop_status();
    switch (type) {
      case ceres::CONVERGENCE:
        return SolveStatus::kConverged;
      case ceres::NO_CONVERGENCE:
        return SolveStatus::kIterationLimit;
      default:
        return evaluator.failures() > 0 ? SolveStatus::kEvaluationFailed
                                        : SolveStatus::kNumericalFailure;
    }
  }

  std::vector<double> y_;
  WindowResiduals windows_;
};

}  // namespace

std::unique_ptr<SolverBackend> MakeCeresSolver() { return std::make_unique<CeresSolver>(); }

}  // namespace touchdown::solvers
