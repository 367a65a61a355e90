// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/linear/bordered_cholesky.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// Tolerances are relative to the cost, or to this where it is smaller: the cost of a hover is
/// zero.
inline constexpr double kSmallestCost = 1e-9;

/// The largest by its absolute value; 0 without any.
double Largest(const std::vector<double>& numbers);
double Dot(const std::vector<double>& a, const std::vector<double>& b);

/// The largest element of the diagonal without its border, by its absolute value.
double LargestDiagonal(const BorderedBandMatrix& H);

/// The largest of all its elements.
double LargestElement(const BorderedBandMatrix& H);

/// Factors H. If it is not positive definite, it is shifted until it is; a border that alone is
/// indefinite takes its absolute value. Shifts begin at a small share of `curvature`, or of H's
/// largest diagonal element if that is 0. With `shift` they begin at its value, and it receives the
/// shift that was used. False if no shift helps. Does not allocate.
bool FactorDefinite(const BorderedBandMatrix& H, BorderedCholesky* factor, double curvature = 0.0,
                    double* shift = nullptr);

/// step = -H^-1 gradient with the factor of H, and a free interval kept in its bounds. Where the
/// step would leave them it ends on the bound, and the other variables take the best step for that.
/// Returns how far the quadratic model falls (at least half of that, where it ends on a bound).
/// Does not allocate.
double NewtonStep(const View& view, const double* y, const double* gradient,
                  const BorderedCholesky& factor, double* step);

}  // namespace touchdown::solvers
