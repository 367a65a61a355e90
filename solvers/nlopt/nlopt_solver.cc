// SPDX-License-Identifier: BSD-3-Clause
// NLopt's gradient-based methods, one adapter for all. They see the whitened view: in the landing
// problem's own variables none of them converges in useful time. NLopt has no iteration callback:
// every evaluation that improves on the best point counts as an iteration. An evaluation that fails
// is +infinity to NLopt, so that its line search backs off; many in a row end the solve.
//
// Statuses. A positive code is convergence if the rows are met. Otherwise the problem is infeasible
// as far as the method can tell. A negative code (roundoff, a failed subproblem, a loop that does
// not move) is convergence only if the best point is stationary. Without rows the test is the
// decrease |g|^2/2 that the metric still promises there, with rows the last improvement.

#include "solvers/nlopt/nlopt_solver.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "solvers/backend/whitened_point.h"
#include "touchdown/solvers/backend/constraint_rows.h"

namespace touchdown::solvers {

namespace {

constexpr int kMostFailures = 20;  // evaluations that may fail one after the other
/// Largest number of calls in a row for the same point: CCSAQ's inner loop never ends where
/// rounding keeps its approximation below the objective.
constexpr int kMostRepeats = 50;
constexpr double kCloser = 0.9;  // share of the violation that a repeated run must get below
/// A method that gives up counts as converged if the remaining gain is less than this share of the
/// cost, or of the gain so far.
constexpr double kStationary = 1e-9;

/// CCSAQ solves a dual problem of one variable a row, to rounding and without asking the caller.
/// Where rows pinch each other, this never ends. Three times this limit finds 1 optimum in 30 more,
/// in six times the time.
constexpr int kMostDualEvaluations = 1000;

struct Method {
  const char* name;
  nlopt_algorithm algorithm;
  Capabilities capabilities;
  bool stores_vectors;
  /// CCSAQ starts with steps of half the distance between the bounds. For the interval that is a
  /// whole flight.
  bool interval_as_angle;
  double function_tolerance;
};

SolverOptions OptionsOf(const Method& method) {
  std::vector<OptionSpec> specs = {
      {"function_tolerance", method.function_tolerance, 0.0, 1.0, false,
       "relative decrease that ends a solve"},
      {"parameter_tolerance", 0.0, 0.0, 1.0, false, "relative step that ends a solve; 0: none"},
      {"whiten", 1.0, 0.0, 1.0, true,
       "1: solve in whitened variables, where their metric is regular"},
  };
  if (method.stores_vectors) {
    specs.push_back({"vector_storage", 10.0, 1.0, 1000.0, true, "gradients remembered"});
    specs.push_back(MetricLegs::Option());
  }
  if (method.capabilities.hard_rows) {
    specs.push_back({"violation_tolerance", 1e-8, 1e-14, Evaluator::kFeasible, false,
                     "violation of a hard row at which a solve may end"});
  }
  return SolverOptions(specs);
}

class NloptSolver : public SolverBackend {
 public:
  explicit NloptSolver(const Method& method)
      : SolverBackend(method.name, OptionsOf(method)), method_(method) {}
  ~NloptSolver() override { nlopt_destroy(opt_); }
  NloptSolver(const NloptSolver&) = delete;
  NloptSolver& operator=(const NloptSolver&) = delete;

  Capabilities capabilities() const override { return method_.capabilities; }

 private:
  /// One of NLopt's constraints: sign (u_row - bound), <= 0 or = 0.
  struct Side {
    int row;
    double sign;
    double bound;
  };

  void DoPrepare(const View& view) override {
    point_.Prepare(view);
    rows_.Prepare(view);
    const auto n = static_cast<std::size_t>(view.num_variables());
    z_.assign(n, 0.0);
    lower_.assign(n, -HUGE_VAL);
    upper_.assign(n, HUGE_VAL);
    nlopt_destroy(opt_);
    opt_ = nlopt_create(method_.algorithm, static_cast<unsigned>(n));
    nlopt_set_min_objective(opt_, &NloptSolver::Objective, this);
    nlopt_set_param(opt_, "dual_maxeval", kMostDualEvaluations);
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& /*stop*/, Evaluator* evaluator,
               SolverResult* result) override {
    evaluator_ = evaluator;
    failures_ = repeats_ = 0;
    lost_ = false;
    improvement_ = HUGE_VAL;
    error_ = nullptr;
    const WhitenedPoint::Settings settings{.whiten = options().Get("whiten") != 0.0,
                                           .interval_as_angle = method_.interval_as_angle};
    if (!point_.Begin(view, warm.y.data(), settings, evaluator)) {
      result->status = SolveStatus::kEvaluationFailed;
      return;
    }
    first_cost_ = point_.value();
    rows_.Set(view, point_.last());
    Configure(view);
    std::copy(point_.z(), point_.z() + point_.size(), z_.begin());
    const nlopt_result code = Run(view);
    if (error_) std::rethrow_exception(error_);
    result->native_status = code;
    const char* words = nlopt_get_errmsg(opt_);
    result->message = words ? words : nlopt_result_to_string(code);
    result->status = Status(code);
  }

  /// Calls NLopt, and again from its last point at the end of a leg. It also calls it again while
  /// NLopt says converged, the rows are not met and the violation decreases. SLSQP of version 2.7
  /// looks at its tolerances whether feasible or not.
  nlopt_result Run(const View& view) {
    nlopt_result code = NLOPT_FORCED_STOP;
    double value = 0.0;
    const bool renews = method_.stores_vectors && point_.whitened();
    MetricLegs legs(renews ? options().Get("metric_evaluations") : 0.0);
    for (double before = HUGE_VAL; !evaluator_->must_stop();) {
      const ShareScope scope(evaluator_, Share::kNative);
      nlopt_set_maxeval(opt_, legs.endless() ? 0 : legs.length());
      code = nlopt_optimize(opt_, z_.data(), &value);
      if (code == NLOPT_MAXEVAL_REACHED) {
        point_.RenewMetric(view, z_.data());
        std::copy(point_.z(), point_.z() + point_.size(), z_.begin());
        legs.Next();
        continue;
      }
      const double violation = evaluator_->best_violation();
      if (code < 0 || violation <= Evaluator::kFeasible || violation > kCloser * before) break;
      before = violation;
    }
    if (code > 0 && !evaluator_->must_stop() && point_.Evaluate(z_.data(), false)) {
      evaluator_->PreferLastIfFeasible();
    }
    return code;
  }

  void Configure(const View& view) {
    nlopt_set_ftol_rel(opt_, options().Get("function_tolerance"));
    nlopt_set_xtol_rel(opt_, options().Get("parameter_tolerance"));
    if (method_.stores_vectors) {
      nlopt_set_vector_storage(opt_, static_cast<unsigned>(options().Get("vector_storage")));
    }
    const int blocks = view.blocks() * view.block_size();
    for (int i = 0; i < blocks; ++i) {
      lower_[i] = view.lower(i);
      upper_[i] = view.upper(i);
    }
    if (view.free_interval() && !method_.interval_as_angle) {
      lower_.back() = point_.interval_scale() * view.lower(blocks);
      upper_.back() = point_.interval_scale() * view.upper(blocks);
    }
    nlopt_set_lower_bounds(opt_, lower_.data());
    nlopt_set_upper_bounds(opt_, upper_.data());
    if (!method_.capabilities.hard_rows) return;
    equalities_.clear();
    inequalities_.clear();
    for (int r = 0; r < rows_.size(); ++r) {
      if (rows_.lo(r) == rows_.hi(r)) {
        equalities_.push_back({r, 1.0, rows_.lo(r)});
        continue;
      }
      if (std::isfinite(rows_.hi(r))) inequalities_.push_back({r, 1.0, rows_.hi(r)});
      if (std::isfinite(rows_.lo(r))) inequalities_.push_back({r, -1.0, rows_.lo(r)});
    }
    u_.resize(static_cast<std::size_t>(rows_.size()));
    jacobian_.resize(static_cast<std::size_t>(rows_.nonzeros()));
    const std::vector<double> tolerances(std::max(equalities_.size(), inequalities_.size()),
                                         options().Get("violation_tolerance"));
    nlopt_remove_equality_constraints(opt_);
    nlopt_remove_inequality_constraints(opt_);
    if (!equalities_.empty()) {
      nlopt_add_equality_mconstraint(opt_, static_cast<unsigned>(equalities_.size()),
                                     &NloptSolver::Equalities, this, tolerances.data());
    }
    if (!inequalities_.empty()) {
      nlopt_add_inequality_mconstraint(opt_, static_cast<unsigned>(inequalities_.size()),
                                       &NloptSolver::Inequalities, this, tolerances.data());
    }
  }

  static double Objective(unsigned /*n*/, const double* z, double* gradient, void* self) {
    return static_cast<NloptSolver*>(self)->EvaluateObjective(z, gradient);
  }
  static void Equalities(unsigned /*m*/, double* values, unsigned /*n*/, const double* z,
                         double* gradient, void* self) {
    auto* solver = static_cast<NloptSolver*>(self);
    solver->EvaluateSides(solver->equalities_, z, values, gradient);
  }
  static void Inequalities(unsigned /*m*/, double* values, unsigned /*n*/, const double* z,
                           double* gradient, void* self) {
    auto* solver = static_cast<NloptSolver*>(self);
    solver->EvaluateSides(solver->inequalities_, z, values, gradient);
  }

  /// Moves to z; no exception may pass through NLopt, which is C. Some methods ask once more after
  /// they were stopped: past a budget nothing is evaluated.
  bool MoveTo(const double* z, bool gradient) {
    if (error_ || evaluator_->must_stop()) {
      nlopt_force_stop(opt_);
      return false;
    }
    // A library may ask for a point that is not finite: that is no failure of the terms.
    lost_ = lost_ || !std::all_of(z, z + point_.size(), [](double x) { return std::isfinite(x); });
    if (lost_) {
      nlopt_force_stop(opt_);
      return false;
    }
    bool ok = false;
    try {
      ok = point_.Evaluate(z, gradient);
    } catch (...) {
      error_ = std::current_exception();
    }
    failures_ = ok ? 0 : failures_ + 1;
    if (error_ || evaluator_->must_stop() || failures_ >= kMostFailures) nlopt_force_stop(opt_);
    return ok;
  }

  double EvaluateObjective(const double* z, double* gradient) {
    const ShareScope scope(evaluator_, Share::kAdapter);
    const double best_before = evaluator_->best_cost();
    const int evaluations_before = evaluator_->evaluations();
    const bool ok = MoveTo(z, gradient != nullptr);
    repeats_ = evaluator_->evaluations() == evaluations_before ? repeats_ + 1 : 0;
    if (repeats_ >= kMostRepeats) nlopt_force_stop(opt_);
    double norm = std::nan("");
    if (gradient && ok) {
      point_.Gradient(gradient);
      norm = 0.0;
      for (int i = 0; i < point_.size(); ++i) norm = std::max(norm, std::abs(gradient[i]));
    } else if (gradient) {
      std::fill(gradient, gradient + point_.size(), 0.0);
    }
    double step = 0.0;
    if (ok && point_.Improved(&step)) {
      improvement_ = std::abs(evaluator_->best_cost() - best_before);
      evaluator_->FinishIteration(step, norm);
      if (evaluator_->CheckStop()) nlopt_force_stop(opt_);
    }
    return ok ? point_.value() : HUGE_VAL;
  }

  void EvaluateSides(const std::vector<Side>& sides, const double* z, double* values,
                     double* gradient) {
    const ShareScope scope(evaluator_, Share::kAdapter);
    const int n = point_.size();
    const bool ok = MoveTo(z, gradient != nullptr);
    if (ok) rows_.Values(point_.last(), u_.data());
    if (ok && gradient) rows_.Jacobian(point_.last(), jacobian_.data());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const auto [row, sign, bound] = sides[i];
      values[i] = ok ? sign * (u_[row] - bound) : 0.0;  // the objective says that it failed
      if (!gradient) continue;
      double* out = gradient + i * static_cast<std::size_t>(n);
      std::fill(out, out + n, 0.0);
      if (!ok) continue;
      for (int k = rows_.start(row); k < rows_.start(row + 1); ++k) {
        out[rows_.column(k)] = sign * jacobian_[k];
      }
      point_.RowToWhite(out);
    }
  }

  SolveStatus Status(nlopt_result code) {
    if (evaluator_->must_stop()) return evaluator_->stop_status();
    if (lost_) return SolveStatus::kNumericalFailure;
    if (failures_ >= kMostFailures) return SolveStatus::kEvaluationFailed;
    const bool gave_up = code < 0;
    if (rows_.constant_violation() > Evaluator::kFeasible ||
        evaluator_->best_violation() > Evaluator::kFeasible) {
      return code == NLOPT_INVALID_ARGS || code == NLOPT_OUT_OF_MEMORY
                 ? SolveStatus::kNumericalFailure
                 : SolveStatus::kInfeasible;
    }
    return !gave_up || Stationary() ? SolveStatus::kConverged : SolveStatus::kNumericalFailure;
  }

  bool Stationary() {
    if (rows_.size() > 0) {
      const double best = evaluator_->best_cost();
      return improvement_ <= kStationary * std::max(std::abs(best), std::abs(first_cost_ - best));
    }
    return point_.StationaryAtBest(first_cost_);
  }

  Method method_;
  nlopt_opt opt_ = nullptr;
  WhitenedPoint point_;
  ConstraintRows rows_;
  Evaluator* evaluator_ = nullptr;
  std::vector<double> z_, u_, jacobian_;
  std::vector<double> lower_, upper_;  // infinite where NLopt keeps to none
  std::vector<Side> equalities_, inequalities_;
  int failures_ = 0;
  bool lost_ = false;  // a requested point is not finite
  int repeats_ = 0;
  double first_cost_ = 0.0;
  double improvement_ = HUGE_VAL;  // of the cost, by the last better point
  std::exception_ptr error_;       // thrown by the caller's stop callback
};

std::unique_ptr<SolverBackend> Make(const Method& method) {
  return std::make_unique<NloptSolver>(method);
}

}  // namespace

std::unique_ptr<SolverBackend> MakeNloptLbfgs() {
  return Make({.name = "nlopt-lbfgs",
               .algorithm = NLOPT_LD_LBFGS,
               .capabilities = {.variable_bounds = true},
               .stores_vectors = true,
               .function_tolerance = 1e-7});
}

std::unique_ptr<SolverBackend> MakeNloptTnewton() {
  return Make({.name = "nlopt-tnewton",
               .algorithm = NLOPT_LD_TNEWTON_PRECOND_RESTART,
               .capabilities = {.variable_bounds = true},
               .stores_vectors = true,
               .function_tolerance = 1e-6});
}

std::unique_ptr<SolverBackend> MakeNloptCcsaq() {
  return Make({.name = "nlopt-ccsaq",
               .algorithm = NLOPT_LD_CCSAQ,
               .capabilities = {.hard_rows = true, .variable_bounds = true},
               .interval_as_angle = true,
               .function_tolerance = 1e-8});
}

std::unique_ptr<SolverBackend> MakeNloptSlsqp() {
  return Make({.name = "nlopt-slsqp",
               .algorithm = NLOPT_LD_SLSQP,
               .capabilities = {.hard_rows = true, .equality_rows = true, .variable_bounds = true},
               .function_tolerance = 1e-9});
}

}  // namespace touchdown::solvers
