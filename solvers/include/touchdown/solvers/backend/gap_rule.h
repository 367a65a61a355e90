// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/backend/optimality.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// Ends a solve near enough to the optimum (Stop::gap). The measure does not come from a backend,
/// so different backends end at points that are equally good. It is the gain that a Newton step of
/// the Lagrangian promises, plus the rows' distances from their bounds times estimated multipliers.
/// That is a bound if the problem is convex and quadratic. Otherwise it is an estimate: a stiff
/// term that hardly acts hides the remaining gain of the others.
///
/// A check costs a Hessian and its factor; with rows, up to four of each and those of the
/// estimates. So the next one waits until the cost falls by half of the excess that the last one
/// found, or until twice as many points have come. Checks are not among a solve's evaluations.
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
