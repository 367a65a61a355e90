// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/bordered_cholesky.h"
#include "touchdown/solvers/constraint_rows.h"
#include "touchdown/solvers/solver_result.h"
#include "touchdown/solvers/view.h"

namespace touchdown::solvers {

/// Judges the points that backends return, whatever they say of them.
class OptimalityCheck {
 public:
  /// Allocates for views of this structure.
  void Prepare(const View& view);

  /// Looks at y. `multipliers` ([term][window x output]) are the backend's, and may be empty: where they do not make
  /// the point stationary, they are estimated from the rows at their bounds. `first_cost`: where the solve began.
  /// `storage` was sized by the view, and holds the evaluation at y after it. Does not allocate.
  Optimality Look(const View& view, const Eigen::VectorXd& y,
                  const std::vector<std::vector<double>>& multipliers, double first_cost,
                  ViewEvaluation* storage);

 private:
  /// At which of its bounds a row is, by its multiplier's sign.
  enum class Side : signed char { kLower = -1, kNone = 0, kUpper = 1, kBoth = 2 };

  bool TakeMultipliers(const std::vector<std::vector<double>>& multipliers);
  bool Estimate();
  Optimality Weigh();
  double Violation() const;
  double WayTo(int row, double multiplier) const;
  Side SideOf(int row) const;
  bool EvaluateHessian(const double* multipliers, const double* weights, double cost_factor);
  void Residual(const double* lambda);
  bool HoldRows(double curvature);
  bool Factor(double shift, double largest, bool* shifted);
  bool CurvesDown(double largest);

  const View* view_ = nullptr;
  const Eigen::VectorXd* y_ = nullptr;
  ViewEvaluation* at_ = nullptr;
  double first_cost_ = 0.0;
  double size_ = 1.0;
  ConstraintRows rows_;
  bool has_factor_ = true;  // the band is not too wide
  BorderedCholesky factor_;
  std::vector<double> gradient_, residual_, step_;
  std::vector<double> u_, jacobian_, norm_, lambda_, weight_;
  std::vector<Side> side_;
  std::vector<std::vector<double>> by_term_, weights_by_term_;
  std::vector<RowWeights> row_weights_;
};

}  // namespace touchdown::solvers
