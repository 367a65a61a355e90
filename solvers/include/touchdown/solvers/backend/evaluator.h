// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "touchdown/solvers/backend/gap_rule.h"
#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/backend/stop.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// What a moment of a solve is charged to; see SolveShares.
enum class Share { kAdapter, kEvaluation, kWhitening, kNative };

/// Every evaluation of a solve goes through here, whatever the backend. It counts, caches the last
/// point, asks Stop, and keeps the best feasible iterate. No backend has to be trusted with this.
class Evaluator {
 public:
  /// A point counts as feasible up to this constraint violation.
  static constexpr double kFeasible = 1e-6;

  /// Libraries count iterations as they like: so many evaluations stand for one at least.
  static constexpr int kMostPerIteration = 20;

  /// Sizes all storage for views of this structure. The only call that allocates.
  void Prepare(const View& view);
  /// Starts a solve. All arguments outlive it. `rule`: asked after each iteration, if there is one.
  void Begin(const View& view, const Stop& stop, GapRule* rule = nullptr);

  /// Evaluates the objective and all rows at y; false if a term could not. A backend may ask for
  /// value, gradient and Hessian one by one. Known numbers of the last point are kept, and only a
  /// new point counts as an evaluation.
  bool Evaluate(const double* y, Want want);
  /// As Evaluate with gradient and Hessian, of this Lagrangian; the Hessian is not cached.
  bool EvaluateLagrangian(const double* y, const Lagrangian& lagrangian);
  const ViewEvaluation& last() const { return storage_; }
  /// The same, for products with its rows (View::MultiplyRows and its transpose).
  ViewEvaluation* mutable_last() { return &storage_; }

  /// Reports one finished iteration: counts it, and records it where Stop asks for a trace. Pass
  /// NaN for what the backend does not know.
  void FinishIteration(double step_norm, double gradient_max_norm);

  /// Makes the last evaluated point the one to return, even if another violated less, or cost less
  /// within the tolerance. For a backend that knows it to be the optimum.
  void PreferLast();
  /// The same, if it is feasible: another may only cost less because of a violation within the
  /// tolerance.
  void PreferLastIfFeasible();

  /// Charges the time from now on to `share`; returns what it was charged to before.
  Share SwitchShare(Share share);

  /// The status that ends the solve now. It is kConverged while the solve may go on, and where the
  /// best point is near enough to the optimum.
  SolveStatus stop_status() const { return stop_status_; }
  bool must_stop() const { return near_enough_ || stop_status_ != SolveStatus::kConverged; }
  /// The rule ended the solve.
  bool near_enough() const { return near_enough_; }
  /// For a backend that keeps Stop::gap itself: its best point is near enough.
  void EndNear() { near_enough_ = true; }
  /// Asks the rule again.
  void CheckGap();
  /// Asks the budgets and the clock again; the callback is asked once at each evaluation.
  bool CheckStop();
  /// Asks the clock alone, whatever other budget is used up: for work after a solve. Also true if
  /// the callback has stopped it.
  bool CheckClock();

  int evaluations() const { return evaluations_; }
  int iterations() const { return iterations_; }
  /// How many evaluations could not be done, and where the last was tried.
  int failures() const { return failures_; }
  const Eigen::VectorXd& last_failure() const { return failed_; }
  double elapsed_s() const;

  bool has_best() const { return has_best_; }
  const Eigen::VectorXd& best() const { return best_; }
  double best_cost() const { return best_cost_; }
  /// Of the first point that could be evaluated.
  double first_cost() const { return first_cost_; }
  double best_violation() const { return best_violation_; }
  /// Of that violation; -1: none, or a bound.
  int worst_term() const { return worst_term_; }
  const std::vector<double>& best_cost_by_term() const { return best_cost_by_term_; }

  std::vector<IterationRecord> TakeTrace() { return std::move(trace_); }
  const SolveShares& shares() const { return shares_; }

 private:
  bool AtCachedPoint(const double* y) const;
  /// Evaluates and keeps the books. `new_point`: y is not the cached one.
  bool Run(const double* y, bool new_point, Want want, const Lagrangian& lagrangian);
  void Track();
  void Keep();
  void AskCallback();

  const View* view_ = nullptr;
  const Stop* stop_ = nullptr;
  GapRule* rule_ = nullptr;
  bool near_enough_ = false;
  ViewEvaluation storage_;
  Eigen::VectorXd cached_;
  bool cache_valid_ = false;
  Want cached_want_;
  int evaluations_ = 0;
  int iterations_ = 0;
  int failures_ = 0;
  Eigen::VectorXd failed_;
  SolveStatus stop_status_ = SolveStatus::kConverged;
  bool has_best_ = false;
  Eigen::VectorXd best_;
  std::vector<double> best_cost_by_term_;
  double best_cost_ = 0.0;
  double first_cost_ = 0.0;
  double best_violation_ = 0.0;
  int worst_term_ = -1;
  std::vector<IterationRecord> trace_;
  SolveShares shares_;
  Share share_ = Share::kAdapter;
  std::chrono::steady_clock::time_point share_start_;
  std::chrono::steady_clock::time_point start_;
};

/// Charges a scope to one share.
class ShareScope {
 public:
  ShareScope(Evaluator* evaluator, Share share)
      : evaluator_(evaluator), before_(evaluator->SwitchShare(share)) {}
  ~ShareScope() { evaluator_->SwitchShare(before_); }
  ShareScope(const ShareScope&) = delete;
  ShareScope& operator=(const ShareScope&) = delete;

 private:
  Evaluator* evaluator_;
  Share before_;
};

}  // namespace touchdown::solvers
