// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/solvers/bordered_cholesky.h"
#include "touchdown/solvers/view.h"

namespace touchdown::solvers {

/// Solves H step = -gradient with H made positive definite where it is not, and a free interval kept
/// in its bounds: where the step would leave them it ends on the bound, and the other variables take
/// the best step with that. `factor` holds the factor afterwards, for further right-hand sides.
/// False if no shift makes H definite. Does not allocate.
bool FactorDefinite(const BorderedBandMatrix& H, BorderedCholesky* factor);
void NewtonStep(const View& view, const double* y, const double* gradient,
                const BorderedCholesky& factor, double* step);

}  // namespace touchdown::solvers
