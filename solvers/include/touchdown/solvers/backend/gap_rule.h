// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/backend/optimality.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// Ends a solve near enough to the optimum (Stop::gap), by a measure that no backend makes: so different
/// backends end at points that are equally good. It is what a Newton step of the Lagrangian
/// promises, plus what rows are off their bounds times their multipliers, which are estimated. That is a bound
/// where the problem is convex and quadratic. Elsewhere it is an estimate: a stiff term that is hardly touched
/// hides what is left of the others.
///
/// A look costs a Hessian and its factor; with rows, up to four of each and those of the estimates. So the next waits
/// until the cost has fallen by half of what the last found too much, or twice as many points have come. Looks are not
/// among a solve's evaluations.
class GapRule {
 public:
  /// Allocates for views of this structure. `check` was prepared for it, too, and outlives this.
  void Prepare(const View& view, OptimalityCheck* check);
  /// Starts a solve; `gap` is a share of the cost.
  void Begin(const View& view, double gap);
  /// A point of this cost and violation is near enough. Does not allocate.
  bool Met(const Eigen::VectorXd& y, double cost, double violation);

 private:
  double Promised(const Eigen::VectorXd& y);

  OptimalityCheck* check_ = nullptr;
  const View* view_ = nullptr;
  ViewEvaluation storage_;
  BorderedCholesky factor_;
  std::vector<double> step_;
  double gap_ = 0.0;
  double look_below_ = 0.0;      // costs
  int points_ = 0, looked_ = 0;  // points that came, and had come at the last look
};

}  // namespace touchdown::solvers
