// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"

namespace touchdown::solvers {

/// Newton's method with a line search on a problem without constraint rows.
class BandedNewton {
 public:
  /// `gap`: ends when half the Newton decrement, the expected distance to the optimum, falls below
  /// this share of the cost.
  struct Tolerances {
    double gap = 1e-9;  ///< expected decrease, share of the cost
    double own = 1e-9;  ///< the backend's own gap, <= `gap`: where the Hessian had to be shifted it
                        ///< alone counts, for a promise is worth less there
    bool of_gain = false;  ///< or of what was gained, where that is less
  };

  void Prepare(const View& view);
  /// The last run ended by the gap, before its promise was as small as `own` demands.
  bool ended_near() const { return ended_near_; }
  /// Does not allocate.
  SolveStatus Run(const View& view, const double* start, const Tolerances& tolerances,
                  Evaluator* evaluator);

 private:
  double Shorten();
  double LineSearch(double value, double slope, bool derivatives, Evaluator* evaluator);

  bool ended_near_ = false;
  BorderedCholesky factor_;
  std::vector<double> y_, gradient_, step_, trial_;
};

}  // namespace touchdown::solvers
