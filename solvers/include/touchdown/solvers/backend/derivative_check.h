// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/solvers/backend/whitening.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// Worst disagreement between derivatives and central differences. It is relative to the largest
/// number of the two compared arrays, or to the differences' own resolution where that is larger.
/// It is infinite where a number is not finite. A residual whose u changes sign between the two
/// points is compared with the one-sided differences.
struct DerivativeErrors {
  bool evaluated = false;          ///< false: the point could not be evaluated
  double gradient = 0.0;           ///< of the objective
  double hessian = 0.0;            ///< of the Lagrangian, against differences of its gradient;
                                   ///< diagonal blocks whole, others as they are stored
  double residual_jacobian = 0.0;  ///< of every residual, in reduced variables
  double row_jacobian = 0.0;       ///< of every u, in reduced variables
  double worst() const;            ///< infinite where nothing was evaluated
};

/// Checks every derivative that `view` offers at y by central differences. No variable moves by
/// more than `step`, nor beyond its bounds: nearer to one, the point checked is a step inside. With
/// a `whitening` (set for this view) it checks those of the Whitened view at z = L^T y. Allocates.
DerivativeErrors CheckDerivatives(const View& view, const Eigen::VectorXd& y,
                                  const Lagrangian& lagrangian = {}, double step = 1e-6,
                                  const Whitening* whitening = nullptr);

}  // namespace touchdown::solvers
