// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace touchdown::solvers {

/// How a solve ended. "Did not converge" is a status, never an exception.
enum class SolveStatus {
  kConverged,         ///< an optimum: the backend says so, and its point passes OptimalityCheck
                      ///< (unless Stop::confirm is false)
  kIterationLimit,    ///< iteration or evaluation budget used up
  kTimeLimit,         ///< the wall-clock deadline passed
  kStopped,           ///< the caller's callback asked to stop
  kUnconfirmed,       ///< the backend says converged, and the check does not find it so
  kSaddle,            ///< stationary, but a point near that keeps all rows costs less: no minimum
  kUnbounded,         ///< the cost seems to fall without end
  kInfeasible,        ///< constraints cannot be met from here, or so it seems
  kEvaluationFailed,  ///< a term returned NaN or threw
  kNumericalFailure,  ///< the backend gave up
};
const char* ToString(SolveStatus status);

/// One iteration of a solve, as every backend can report it. Cost and violation are those of the
/// best point so far.
struct IterationRecord {
  int iteration = 0;
  double cost = 0.0;
  std::vector<double> cost_by_term;  ///< in the order of the problem's terms
  double max_violation = 0.0;
  double step_norm = 0.0;          ///< in the view's variables; NaN where the backend hides it
  double gradient_max_norm = 0.0;  ///< as the backend measures it; NaN where it hides it
  double time_s = 0.0;             ///< wall time since the start of the solve
};

/// Where the wall time of a solve went. Exclusive: the parts add up to the whole.
struct SolveShares {
  double evaluation_s = 0.0;  ///< View::Evaluate
  double whitening_s = 0.0;   ///< factor and triangular solves of the whitening
  double native_s = 0.0;      ///< the solver library, its own problem built; or our algorithm
  double adapter_s = 0.0;     ///< all else: copies, set-up, checks, bookkeeping
};

/// Cost of one term at the returned point.
struct TermCost {
  std::string name;
  double cost = 0.0;
};

/// Where a solve starts: variables of the view, and multipliers of an earlier result for backends
/// that can use them (empty: none).
struct WarmStart {
  WarmStart(Eigen::VectorXd point) : y(std::move(point)) {}  // NOLINT: a point is a warm start
  WarmStart(Eigen::VectorXd point, std::vector<std::vector<double>> duals)
      : y(std::move(point)), multipliers(std::move(duals)) {}
  Eigen::VectorXd y;
  std::vector<std::vector<double>> multipliers;
};

/// The conditions of Karush, Kuhn and Tucker at a point y. Lengths are measured with each variable
/// divided by its own size, 1 + |y_i|. The cost's size is the gain of the solve, or its slope if
/// that is larger. So the results do not change with a factor of a row, or with the unit of a
/// variable that is large beside 1. A constant in the cost changes `left` alone, and so does a
/// factor of a cost whose optimum is near 0.
struct Optimality {
  bool evaluated = false;  ///< false: a term or its derivatives are not finite there
  double violation = 0.0;  ///< way to the bound of the worst row along its slope
  double step = 0.0;       ///< Newton's, of the Lagrangian
  double gain = 0.0;       ///< what it promises, share of the cost's size
  double left = 0.0;       ///< the same, share of the cost's value, or of 0.1 where that is less
  double gap = 0.0;        ///< multipliers times the way to their bounds, share of the cost's size
  double gap_left = 0.0;   ///< the same, share of the cost's value, or of 0.1 where that is less
  /// A point near that keeps all rows costs less, by more than what may be left.
  bool saddle = false;
  int evaluations = 0;  ///< that the check took; they are not among the solve's

  bool feasible() const { return evaluated && violation <= kFeasible; }
  bool stationary() const {
    const bool near = step <= kStep && left <= kMostLeft;
    const bool met = gap <= kGap && gap_left <= kGap;
    return evaluated && (near || (gain <= kGain && left <= kLeft)) && met;
  }

  static constexpr double kFeasible = 1e-6;
  static constexpr double kStep = 1e-6;
  static constexpr double kGain = 1e-8;
  static constexpr double kLeft = 1e-7;
  static constexpr double kMostLeft = 1e-6;  // far out a small share of a variable is a long way
  static constexpr double kGap = 5e-7;  // of both; rows that are met to kFeasible leave as much
};

/// What a solve came to, without its point: of one size for all problems.
struct SolverSummary {
  SolveStatus status = SolveStatus::kNumericalFailure;
  double cost = 0.0;
  std::vector<TermCost> cost_by_term;
  double max_violation = 0.0;  ///< worst constraint violation at the point
  /// The term whose row that is, or with kEvaluationFailed the one that failed, by its place in
  /// cost_by_term; -1: none, or a bound of a variable.
  int worst_term = -1;
  int iterations = 0;
  int evaluations = 0;  ///< evaluations of value, gradient or residuals
  double wall_s = 0.0;
  double cpu_s = 0.0;     ///< thread CPU time
  int native_status = 0;  ///< the backend's own code
  Optimality optimality;  ///< of the point, where the backend says converged

  /// The point may be used: it was evaluated, whether or not the solve converged.
  bool usable() const {
    return status == SolveStatus::kConverged || status == SolveStatus::kIterationLimit ||
           status == SolveStatus::kTimeLimit || status == SolveStatus::kStopped ||
           status == SolveStatus::kUnconfirmed || status == SolveStatus::kSaddle;
  }
};

struct SolverResult : SolverSummary {
  Eigen::VectorXd x;  ///< best feasible point, variables of the solved view
  /// [term][row] (TermShape::row) of constraint terms at the backend's last point (x, where it
  /// converged), empty where the backend has none.
  std::vector<std::vector<double>> multipliers;
  /// Of the variables' bounds, including the interval's: positive at an upper one, negative at a
  /// lower one. Empty if the backend has none. For a fixed variable it may be 0: some backends
  /// leave it out.
  std::vector<double> bound_multipliers;
  std::string message;                 ///< the backend's own words
  std::vector<IterationRecord> trace;  ///< filled if Stop::trace asks for it
  SolveShares shares;                  ///< filled if Stop::shares asks for it
};

}  // namespace touchdown::solvers
