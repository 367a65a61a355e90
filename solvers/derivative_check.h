// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/solvers/view.h"

namespace touchdown::solvers {

/// Worst disagreement between derivatives and central differences, relative to the size of the
/// compared array: max |a - b| / (1 + max |b|).
struct DerivativeErrors {
  bool evaluated = false;          ///< false: the point could not be evaluated
  double gradient = 0.0;           ///< of the objective
  double hessian = 0.0;            ///< of the Lagrangian, against differences of its gradient
  double residual_jacobian = 0.0;  ///< of every residual, in reduced variables
  double row_jacobian = 0.0;       ///< of every u, in reduced variables
  double worst() const;            ///< infinite where nothing was evaluated
};

/// Checks every derivative that `view` offers at y by central differences with the given relative
/// step. Allocates.
DerivativeErrors CheckDerivatives(const View& view, const Eigen::VectorXd& y,
                                  const Lagrangian& lagrangian = {}, double step = 1e-6);

}  // namespace touchdown::solvers
