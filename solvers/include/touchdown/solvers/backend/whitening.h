// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// The Whitened view: variables z = L^T y, where L L^T is a nominal Hessian of the problem. It is a
/// Gauss-Newton Hessian: every loss has its nominal curvature (loss.h), equality rows that of their
/// loss. In z the landing problem's condition number no longer grows with N^6, so first-order
/// methods become usable on it. A free interval stays a variable of its own: z's last number is s
/// h, so that its bounds stay bounds.
class Whitening {
 public:
  /// Allocates for views of this structure.
  void Prepare(const View& view);
  /// Factors the nominal Hessian at y, evaluated in `evaluation` (of this view, with its parameters
  /// held or not). False if the view cannot be evaluated there. Does not allocate.
  bool Set(const View& view, const double* y, ViewEvaluation* evaluation);

  /// The nominal Hessian is definite by itself; else a shift stands in for what it leaves free.
  bool regular() const { return regular_; }
  int size() const { return factor_.size(); }
  /// z = L^T y and y = L^-T z; in and out must differ.
  void ToWhite(const double* y, double* z) const;
  void FromWhite(const double* z, double* y) const;
  /// In place: a gradient or Jacobian row in y becomes one in z, L^-1 g.
  void GradientToWhite(double* g) const { factor_.SolveLower(g); }
  /// z's last number per unit of a free interval.
  double interval_scale() const { return factor_.corner(); }

 private:
  BorderedCholesky factor_;
  bool regular_ = false;
  std::vector<std::vector<double>> weights_;  // of equality rows, [term]
  std::vector<RowWeights> rows_;
};

}  // namespace touchdown::solvers
