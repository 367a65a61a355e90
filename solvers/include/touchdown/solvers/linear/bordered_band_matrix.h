// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace touchdown::solvers {

/// Symmetric arrowhead matrix of `blocks` x `blocks` blocks of d x d scalars. It is zero beyond
/// `half_bandwidth` block diagonals, except for at most one border row (the knot interval). Only
/// the upper blocks (i, i + k), k = 0..half_bandwidth, are stored, each row-major.
class BorderedBandMatrix {
 public:
  BorderedBandMatrix() = default;

  /// Sizes and zeroes. Allocates.
  void Resize(int blocks, int block_size, int half_bandwidth, bool bordered);
  void SetZero();
  /// Whatever is in the border.
  bool BandIsZero() const;

  int blocks() const { return blocks_; }
  int block_size() const { return d_; }
  int half_bandwidth() const { return half_; }
  bool bordered() const { return bordered_; }
  int size() const { return blocks_ * d_ + (bordered_ ? 1 : 0); }

  /// Block (i, i + k), d x d, row-major.
  double* block(int i, int k) { return &band_[((i * (half_ + 1)) + k) * d_ * d_]; }
  const double* block(int i, int k) const { return &band_[((i * (half_ + 1)) + k) * d_ * d_]; }
  /// Column of the border, blocks x d.
  double* border() { return border_.data(); }
  const double* border() const { return border_.data(); }
  double& corner() { return corner_; }
  double corner() const { return corner_; }

  /// Element (i, i).
  double& Diagonal(int i) {
    return bordered_ && i == blocks_ * d_ ? corner_ : block(i / d_, 0)[i % d_ * (d_ + 1)];
  }

  /// out[i] = the largest element of row i by its absolute value, of size(). Does not allocate.
  void LargestInRows(double* out) const;

  /// A becomes D A D, with D = diag(d), of size(). Does not allocate.
  void Scale(const double* d);

  /// out = A in, both of size(). Does not allocate.
  void Multiply(const double* in, double* out) const;

  /// Element (row, column) of the whole symmetric matrix; zero outside the band.
  double At(int row, int column) const;

 private:
  int blocks_ = 0;
  int d_ = 0;
  int half_ = 0;
  bool bordered_ = false;
  std::vector<double> band_;
  std::vector<double> border_;
  double corner_ = 0.0;
};

}  // namespace touchdown::solvers
