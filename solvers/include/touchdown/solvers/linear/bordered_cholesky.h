// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/linear/bordered_band_matrix.h"

namespace touchdown::solvers {

/// Cholesky factor of a BorderedBandMatrix A = L L^T. L is lower triangular, of the same shape.
///   A = [B b; b^T c],   B = L_B L_B^T,   L = [L_B 0; (L_B^-1 b)^T s],   s^2 = c - |L_B^-1 b|^2.
/// Vectorised kernels factor blocks of 3 x 3. Other blocks are factored as a scalar band, in time
/// linear in the scalars and quadratic in the band.
class BorderedCholesky {
 public:
  /// What a factorisation found.
  enum class Status {
    kDefinite,          ///< A is positive definite
    kBorderIndefinite,  ///< B is, A is not; s was taken from |c - |L_B^-1 b|^2|
    kIndefinite,        ///< B is not: no factor
  };

  /// Allocates for matrices of this shape.
  void Prepare(const BorderedBandMatrix& shape);

  /// Factors A + diag(shift): `shift` is added to B's diagonal, `border_shift` to c. Does not
  /// allocate.
  Status Factor(const BorderedBandMatrix& A, double shift = 0.0, double border_shift = 0.0);

  /// In place on size() numbers: x := L^-1 x, x := L^-T x, both, and x := L^T x. Do not allocate.
  void SolveLower(double* x) const;
  void SolveUpper(double* x) const;
  void Solve(double* x) const {
    SolveLower(x);
    SolveUpper(x);
  }
  /// In place, with the last number of x given: the rest becomes B^-1 (x - last b). Needs a border.
  void SolveWithBorder(double* x) const;
  void MultiplyUpper(const double* x, double* out) const;

  int size() const { return n_ + (bordered_ ? 1 : 0); }
  /// s; 1 without a border.
  double corner() const { return corner_; }

 private:
  void SolveBandLower(double* x) const;
  void SolveBandUpper(double* x) const;

  // B, by its half bandwidth in blocks of `d_` scalars: 3, or 1 with the band widened.
  int d_ = 3;
  int blocks_ = 0;  // groups of columns in the kernels
  int half_ = 0;
  int n_ = 0;
  bool bordered_ = false;
  std::vector<double> band_;             // see the .cc
  std::vector<double> border_;           // L_B^-1 b
  mutable std::vector<double> scratch_;  // a vector with room for padded runs behind its end
  double corner_ = 1.0;
};

}  // namespace touchdown::solvers
