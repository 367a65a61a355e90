// SPDX-License-Identifier: BSD-3-Clause
// Storage of an arrowhead of a block-banded symmetric matrix: the Hessian of every windowed
// problem.

#include "touchdown/solvers/linear/bordered_band_matrix.h"

#include <algorithm>

namespace touchdown::solvers {

void BorderedBandMatrix::Resize(int blocks, int block_size, int half_bandwidth, bool bordered) {
  blocks_ = blocks;
  d_ = block_size;
  half_ = half_bandwidth;
  bordered_ = bordered;
  const auto band = static_cast<std::size_t>(blocks) * static_cast<std::size_t>(half_ + 1) *
                    static_cast<std::size_t>(d_ * d_);
  band_.assign(band, 0.0);
  border_.assign(static_cast<std::size_t>(blocks * d_), 0.0);
  corner_ = 0.0;
}

void BorderedBandMatrix::SetZero() {
  std::fill(band_.begin(), band_.end(), 0.0);
  std::fill(border_.begin(), border_.end(), 0.0);
  corner_ = 0.0;
}

bool BorderedBandMatrix::BandIsZero() const {
  const auto zero = [](double element) { return element == 0.0; };
  return corner_ == 0.0 && std::all_of(band_.begin(), band_.end(), zero);
}

namespace {

/// out += the symmetric band times in; kSize 0 stands for any block size.
template <int kSize>
void AddBandProduct(const BorderedBandMatrix& A, const double* in, double* out) {
  const int d = kSize > 0 ? kSize : A.block_size();
  for (int i = 0; i < A.blocks(); ++i) {
    const double* in_i = in + i * d;
    double* out_i = out + i * d;
    for (int r = 0; r < d; ++r) {
      for (int s = 0; s < d; ++s) out_i[r] += A.block(i, 0)[r * d + s] * in_i[s];
    }
    const int last = std::min(A.half_bandwidth(), A.blocks() - 1 - i);
    for (int k = 1; k <= last; ++k) {
      const double* a = A.block(i, k);
      const double* in_j = in_i + k * d;
      double* out_j = out_i + k * d;
      for (int r = 0; r < d; ++r) {
        for (int s = 0; s < d; ++s) {
          out_i[r] += a[r * d + s] * in_j[s];
          out_j[s] += a[r * d + s] * in_i[r];
        }
      }
    }
  }
}

}  // namespace

void BorderedBandMatrix::Multiply(const double* in, double* out) const {
  std::fill(out, out + size(), 0.0);
  const int d = d_;
  if (d == 3) {
    AddBandProduct<3>(*this, in, out);
  } else {
    AddBandProduct<0>(*this, in, out);
  }
  if (!bordered_) return;
  const int n = blocks_ * d;
  for (int i = 0; i < n; ++i) {
    out[i] += border_[i] * in[n];
    out[n] += border_[i] * in[i];
  }
  out[n] += corner_ * in[n];
}

void BorderedBandMatrix::Scale(const double* d) {
  for (int i = 0; i < blocks_; ++i) {
    const int last = std::min(half_, blocks_ - 1 - i);
    for (int k = 0; k <= last; ++k) {
      double* a = block(i, k);
      for (int r = 0; r < d_; ++r) {
        for (int s = 0; s < d_; ++s) a[r * d_ + s] *= d[i * d_ + r] * d[(i + k) * d_ + s];
      }
    }
  }
  if (!bordered_) return;
  const double at_corner = d[blocks_ * d_];
  for (int i = 0; i < blocks_ * d_; ++i) border_[i] *= d[i] * at_corner;
  corner_ *= at_corner * at_corner;
}

void BorderedBandMatrix::LargestInRows(double* out) const {
  std::fill(out, out + size(), 0.0);
  const auto take = [out](int row, int column, double element) {
    for (const int i : {row, column}) out[i] = std::max(out[i], std::abs(element));
  };
  for (int i = 0; i < blocks_; ++i) {
    const int last = std::min(half_, blocks_ - 1 - i);
    for (int k = 0; k <= last; ++k) {
      const double* a = block(i, k);
      for (int r = 0; r < d_; ++r) {
        for (int s = 0; s < d_; ++s) take(i * d_ + r, (i + k) * d_ + s, a[r * d_ + s]);
      }
    }
  }
  const int n = blocks_ * d_;
  for (int i = 0; i < n && bordered_; ++i) take(i, n, border_[i]);
  if (bordered_) take(n, n, corner_);
}

double BorderedBandMatrix::At(int row, int column) const {
  if (row > column) std::swap(row, column);
  const int n = blocks_ * d_;
  if (bordered_ && column == n) return row == n ? corner_ : border_[row];
  const int i = row / d_;
  const int k = column / d_ - i;
  if (k > half_) return 0.0;
  return block(i, k)[(row % d_) * d_ + column % d_];
}

}  // namespace touchdown::solvers
