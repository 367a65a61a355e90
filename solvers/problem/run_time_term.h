// SPDX-License-Identifier: BSD-3-Clause
// The sums of WindowTerm for terms whose sizes are known at run time.
#pragma once

#include "touchdown/solvers/problem/loss.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

LossBounds BoundsOf(const AnyLoss& loss);
double NominalRowWeight(const AnyLoss& loss);
bool LossHasResidual(const AnyLoss& loss);
bool IsQuadratic(const AnyLoss& loss);

/// The window's losses, of a cost.
void EvaluateLoss(const AnyLoss& loss, int window, const TermShape& shape,
                  const TermRequest& request, TermBlock* block);

/// The factor of an output's curvature in the Hessian.
double SlopeOf(int row, const TermRequest& request, const TermBlock& block);

/// Adds the window's gradient.
void AddGradient(int window, const TermShape& shape, const TermInput& input,
                 const TermRequest& request, const TermBlock& block, const TermSums& sums);

/// Adds sum_c weight_c du_c du_c^T of a window and, unless null, its `curvature` sum_c SlopeOf(c)
/// d2u_c. That is row-major (v + 1) x (v + 1) with h last. Its upper part is read, blocks on the
/// diagonal whole.
void AddHessian(int window, const TermShape& shape, const TermInput& input,
                const TermRequest& request, const TermBlock& block, const double* curvature,
                const TermSums& sums);

}  // namespace touchdown::solvers
