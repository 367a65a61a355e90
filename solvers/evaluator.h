// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "touchdown/solvers/solver_result.h"
#include "touchdown/solvers/stop.h"
#include "touchdown/solvers/view.h"

namespace touchdown::solvers {

/// Every evaluation of a solve goes through here, whatever the backend: it counts, caches the last
/// point, asks Stop, and keeps the best feasible iterate, so that no backend has to be trusted with
/// any of this.
class Evaluator {
 public:
  /// A point counts as feasible up to this constraint violation.
  static constexpr double kFeasible = 1e-6;

  /// Sizes all storage for views of this structure. The only call that allocates.
  void Prepare(const View& view);
  /// Starts a solve. Both arguments outlive it.
  void Begin(const View& view, const Stop& stop);

  /// Evaluates the objective and all rows at y; false if a term could not. A backend may ask for
  /// value, gradient and Hessian one by one: what is known of the last point is not forgotten, and
  /// only a new point counts as an evaluation.
  bool Evaluate(const double* y, Want want);
  /// The Hessian of the Lagrangian at y, in last().hessian.
  bool EvaluateLagrangian(const double* y, const Lagrangian& lagrangian);
  const ViewEvaluation& last() const { return storage_; }

  /// Tells of one finished iteration; the budget of iterations is counted here.
  void CountIteration() { ++iterations_; }

  /// The status that ends the solve now, or kConverged while it may go on.
  SolveStatus stop_status() const { return stop_status_; }
  bool must_stop() const { return stop_status_ != SolveStatus::kConverged; }
  /// Asks the budgets, the clock and the callback again, without an evaluation.
  bool CheckStop();

  int evaluations() const { return evaluations_; }
  int iterations() const { return iterations_; }
  bool evaluation_failed() const { return failed_; }
  double elapsed_s() const;

  bool has_best() const { return has_best_; }
  const Eigen::VectorXd& best() const { return best_; }
  double best_cost() const { return best_cost_; }
  double best_violation() const { return best_violation_; }
  const std::vector<double>& best_cost_by_term() const { return best_cost_by_term_; }

 private:
  bool AtCachedPoint(const double* y) const;
  void Track(const double* y);

  const View* view_ = nullptr;
  const Stop* stop_ = nullptr;
  ViewEvaluation storage_;
  Eigen::VectorXd cached_;
  bool cache_valid_ = false;
  Want cached_want_;
  int evaluations_ = 0;
  int iterations_ = 0;
  bool failed_ = false;
  SolveStatus stop_status_ = SolveStatus::kConverged;
  bool has_best_ = false;
  Eigen::VectorXd best_;
  std::vector<double> best_cost_by_term_;
  double best_cost_ = 0.0;
  double best_violation_ = 0.0;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace touchdown::solvers
