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

  /// `storage` is sized for `view` already. All three outlive the evaluator.
  Evaluator(const View& view, const Stop& stop, ViewEvaluation* storage);

  /// Evaluates at y; false if a term could not. A repeated question at the same point is answered
  /// from the cache. Does not allocate.
  bool Evaluate(const double* y, Want want);
  const ViewEvaluation& last() const { return *storage_; }

  /// Tells of one finished iteration; the budget of iterations is counted here.
  void CountIteration() { ++iterations_; }

  /// The status that ends the solve now, or kConverged while it may go on.
  SolveStatus stop_status() const { return stop_status_; }
  bool must_stop() const { return stop_status_ != SolveStatus::kConverged; }
  /// Asks the budgets and the clock again, without an evaluation.
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
  void Track(const double* y);

  const View& view_;
  const Stop& stop_;
  ViewEvaluation* storage_;
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
