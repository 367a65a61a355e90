// SPDX-License-Identifier: BSD-3-Clause
// Right-looking Cholesky of a block band, by L D L^T with L scaled in the end. The border follows
// by one triangular solve. The factor is stored column by column as panels. Scalar column c of
// block column j holds the rows of blocks j .. j + half one after another, padded with zeros. So
// every update of the trailing matrix is a run of whole vector registers and needs no tail.
// Diagonal elements are stored inverted.

#include "touchdown/solvers/linear/bordered_cholesky.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace touchdown::solvers {

namespace {

constexpr int RoundUp(int n) { return (n + 3) / 4 * 4; }

/// Columns of blocks of d scalars, padded with zeros to `stride` rows.
template <int d>
void LoadBlocks(const BorderedBandMatrix& A, double shift, int stride, double* band) {
  const int n = A.blocks();
  for (int j = 0; j < n; ++j) {
    const int last = std::min(A.half_bandwidth(), n - 1 - j);
    for (int c = 0; c < d; ++c) {
      double* column = band + static_cast<std::ptrdiff_t>(j * d + c) * stride;
      int row = 0;
      for (int k = 0; k <= last; ++k) {
        const double* block = A.block(j, k) + c * d;
        for (int r = 0; r < d; ++r) column[row++] = block[r];
      }
      for (; row < stride; ++row) column[row] = 0.0;
      column[c] += shift;
    }
  }
}

/// Columns of scalars in groups of d, each from the first row of its group on. Columns of the
/// identity follow them, up to a whole group.
void LoadScalars(const BorderedBandMatrix& A, double shift, int d, int stride, double* band) {
  const int size = A.block_size(), n = A.blocks();
  for (int j = 0; j < n; ++j) {
    const int last = std::min(A.half_bandwidth(), n - 1 - j);
    for (int c = 0; c < size; ++c) {
      const int at = j * size + c;
      double* column = band + static_cast<std::ptrdiff_t>(at) * stride;
      double* const end = column + stride;
      double* const diagonal = column + at % d;
      column = std::fill_n(column, at % d, 0.0);
      for (int k = 0; k <= last; ++k) {
        const double* block = A.block(j, k) + c * size;
        column = std::copy(block + (k == 0 ? c : 0), block + size, column);
      }
      std::fill(column, end, 0.0);
      *diagonal += shift;
    }
  }
  for (int at = n * size; at % d != 0; ++at) {
    double* column = band + static_cast<std::ptrdiff_t>(at) * stride;
    std::fill_n(column, stride, 0.0);
    column[at % d] = 1.0;
  }
}

/// Kernels for d scalars in a block and a compile-time half bandwidth.
template <int d, int half>
struct Panels {
  static constexpr int kRows = d * (half + 1);
  /// A run that starts in row d b and is rounded up ends before this.
  static constexpr int kStride = RoundUp(kRows) + 4;
  static constexpr int kPad = RoundUp(kRows) + 4;

  static double* Column(double* band, int j, int c) { return band + (j * d + c) * kStride; }
  static const double* Column(const double* band, int j, int c) {
    return band + (j * d + c) * kStride;
  }

  static constexpr int group() { return d; }
  static constexpr int stride() { return kStride; }
  static constexpr int pad() { return kPad; }

  static void Load(const BorderedBandMatrix& A, double shift, double* band) {
    if (A.block_size() == d) {
      LoadBlocks<d>(A, shift, kStride, band);
    } else {
      LoadScalars(A, shift, d, kStride, band);
    }
  }

  template <int rows>
  using Run = Eigen::Array<double, rows, 1>;

  /// out -= sum_m factor[m] panel_m, of `rows` rows of the panel's d columns.
  template <int rows>
  static void SubtractColumns(const double* panel, const double* factor, double* out) {
    Eigen::Map<Run<rows>> of(out);
    Run<rows> rest = of;
    for (int m = 0; m < d; ++m) {
      rest -= factor[m] * Eigen::Map<const Run<rows>>(panel + m * kStride);
    }
    of = rest;
  }

  /// Subtracts panel D^-1 panel^T from what is right of the panel.
  template <int b>
  static void UpdateTrailing(double* band, int j, const double* inverse) {
    if constexpr (b <= half) {
      const double* panel = Column(band, j, 0) + b * d;
      for (int c = 0; c < d; ++c) {
        double factor[d];
        for (int m = 0; m < d; ++m) factor[m] = panel[m * kStride + c] * inverse[m];
        SubtractColumns<RoundUp(kRows - b * d)>(panel, factor, Column(band, j + b, c));
      }
      UpdateTrailing<b + 1>(band, j, inverse);
    }
  }

  /// False where a pivot is not positive. The updates use L D L^T, so each pivot waits for one
  /// division after the last pivot, not for its square root.
  static bool Factor(int n, double* band) {
    using Whole = Run<RoundUp(kRows)>;
    for (int j = 0; j < n; ++j) {
      double inverse[d];  // of the pivots
      for (int c = 0; c < d; ++c) {
        Eigen::Map<Whole> column(Column(band, j, c));
        for (int m = 0; m < c; ++m) {
          const Eigen::Map<const Whole> earlier(Column(band, j, m));
          column -= earlier[c] * inverse[m] * earlier;
        }
        inverse[c] = 1.0 / column[c];
        if (!(inverse[c] > 0.0) || !std::isfinite(inverse[c])) return false;
      }
      UpdateTrailing<1>(band, j, inverse);
      for (int c = 0; c < d; ++c) {
        Eigen::Map<Whole> column(Column(band, j, c));
        const double scale = std::sqrt(inverse[c]);
        column *= scale;
        column[c] = scale;
        // Rows above the diagonal hold what the loads and updates left there: not part of L.
        for (int r = 0; r < c; ++r) column[r] = 0.0;
      }
    }
    return true;
  }

  /// `x` has kPad numbers of room behind its end.
  static void SolveLower(int n, const double* band, double* __restrict x) {
    for (int j = 0; j < n; ++j) {
      double* at = x + j * d;
      for (int c = 0; c < d; ++c) {
        const double* __restrict column = Column(band, j, c);
        const double value = at[c] * column[c];
#ifndef __clang__  // which sees by itself that nothing overlaps
#pragma GCC ivdep
#endif
        for (int r = 0; r < kStride - 4; ++r) at[r] -= value * column[r];
        at[c] = value;
      }
    }
  }

  /// The sums begin with the terms known for longest: the next block waits only for the last terms.
  static void SolveUpper(int n, const double* band, double* __restrict x) {
    for (int j = n - 1; j >= 0; --j) {
      double* at = x + j * d;
      double sums[d];
      for (int c = 0; c < d; ++c) {
        const double* __restrict column = Column(band, j, c);
        double sum = 0.0;
        for (int r = kRows - 1; r >= d; --r) sum += column[r] * at[r];
        sums[c] = sum;
      }
      for (int c = d - 1; c >= 0; --c) {
        const double* column = Column(band, j, c);
        double sum = sums[c];
        for (int r = c + 1; r < d; ++r) sum += column[r] * at[r];
        at[c] = (at[c] - sum) * column[c];
      }
    }
  }

  /// `size`: of the matrix, without padding.
  static void MultiplyUpper(int size, const double* band, const double* x, double* out) {
    for (int i = 0; i < size; ++i) {
      const int c = i % d, first = i - c;
      const double* column = band + static_cast<std::ptrdiff_t>(i) * kStride;
      double sum = x[i] / column[c];
      const int rows = std::min(kRows, size - first);
      for (int r = c + 1; r < rows; ++r) sum += column[r] * x[first + r];
      out[i] = sum;
    }
  }
};

/// The same for a band of scalars that is as wide as it is.
class WideBand {
 public:
  explicit WideBand(int half) : half_(half) {}

  int group() const { return 1; }
  int stride() const { return half_ + 1; }
  int pad() const { return half_ + 1; }

  void Load(const BorderedBandMatrix& A, double shift, double* band) const {
    LoadScalars(A, shift, 1, stride(), band);
  }

  bool Factor(int n, double* band) const {
    for (int j = 0; j < n; ++j) {
      double* column = band + Start(j);
      const double inverse = 1.0 / column[0];
      if (!(inverse > 0.0) || !std::isfinite(inverse)) return false;
      column[0] = std::sqrt(inverse);
      Column(column + 1, half_) *= column[0];
      for (int b = 1; b <= half_; ++b) {
        if (column[b] == 0.0) continue;
        const int rows = half_ + 1 - b;
        Column(band + Start(j + b), rows) -= column[b] * Column(column + b, rows);
      }
    }
    return true;
  }

  void SolveLower(int n, const double* band, double* x) const {
    for (int j = 0; j < n; ++j) {
      const double* column = band + Start(j);
      x[j] *= column[0];
      Column(x + j + 1, half_) -= x[j] * Column(column + 1, half_);
    }
  }

  void SolveUpper(int n, const double* band, double* x) const {
    for (int j = n - 1; j >= 0; --j) {
      const double* column = band + Start(j);
      const double sum = (Column(column + 1, half_) * Column(x + j + 1, half_)).sum();
      x[j] = (x[j] - sum) * column[0];
    }
  }

  void MultiplyUpper(int n, const double* band, const double* x, double* out) const {
    for (int j = 0; j < n; ++j) {
      const double* column = band + Start(j);
      double sum = x[j] / column[0];
      for (int r = 1; r <= std::min(half_, n - 1 - j); ++r) sum += column[r] * x[j + r];
      out[j] = sum;
    }
  }

 private:
  static Eigen::Map<Eigen::ArrayXd> Column(double* first, int rows) { return {first, rows}; }
  static Eigen::Map<const Eigen::ArrayXd> Column(const double* first, int rows) {
    return {first, rows};
  }
  std::ptrdiff_t Start(int j) const { return static_cast<std::ptrdiff_t>(j) * stride(); }

  int half_;
};

/// Calls `visit` with kernels. Blocks of three have their own. Any other size becomes a band of
/// scalars in groups of four. Its half bandwidth is rounded up to a compiled one, if there is one.
template <class Visit>
auto Dispatch(int d, int half, Visit&& visit) {
  if (d == 3) {
    switch (half) {
      case 0:
      case 1:
        return visit(Panels<3, 1>());
      case 2:
        return visit(Panels<3, 2>());
      case 3:
        return visit(Panels<3, 3>());
      case 4:
        return visit(Panels<3, 4>());
      default:
        return visit(Panels<3, 5>());
    }
  }
  if (half <= 8) return visit(Panels<4, 2>());
  if (half <= 16) return visit(Panels<4, 4>());
  if (half <= 24) return visit(Panels<4, 6>());
  if (half <= 32) return visit(Panels<4, 8>());
  return visit(WideBand(half));
}

}  // namespace

void BorderedCholesky::Prepare(const BorderedBandMatrix& shape) {
  const int size = shape.block_size();
  d_ = size == 3 ? 3 : 1;  // what half_ counts
  half_ = size == 3 ? shape.half_bandwidth() : size * (shape.half_bandwidth() + 1) - 1;
  n_ = shape.blocks() * size;
  bordered_ = shape.bordered();
  const auto n = static_cast<std::size_t>(n_);
  Dispatch(d_, half_, [&](auto panels) {
    blocks_ = (n_ + panels.group() - 1) / panels.group();
    const auto pad = static_cast<std::size_t>(panels.pad());
    band_.assign((n + pad) * static_cast<std::size_t>(panels.stride()), 0.0);
    scratch_.assign(n + pad, 0.0);
  });
  border_.assign(n, 0.0);
  corner_ = 1.0;
}

BorderedCholesky::Status BorderedCholesky::Factor(const BorderedBandMatrix& A, double shift,
                                                  double border_shift) {
  const bool definite = Dispatch(d_, half_, [&](auto panels) {
    panels.Load(A, shift, band_.data());
    return panels.Factor(blocks_, band_.data());
  });
  if (!definite) return Status::kIndefinite;
  corner_ = 1.0;
  if (!bordered_) return Status::kDefinite;
  std::copy(A.border(), A.border() + n_, border_.begin());
  SolveBandLower(border_.data());
  double schur = A.corner() + border_shift;
  for (const double w : border_) schur -= w * w;
  corner_ = std::sqrt(std::abs(schur));
  return schur > 0.0 ? Status::kDefinite : Status::kBorderIndefinite;
}

void BorderedCholesky::SolveBandLower(double* x) const {
  std::copy(x, x + n_, scratch_.begin());
  Dispatch(d_, half_,
           [&](auto panels) { panels.SolveLower(blocks_, band_.data(), scratch_.data()); });
  std::copy(scratch_.begin(), scratch_.begin() + n_, x);
}

void BorderedCholesky::SolveLower(double* x) const {
  SolveBandLower(x);
  if (!bordered_) return;
  double sum = x[n_];
  for (int i = 0; i < n_; ++i) sum -= border_[i] * x[i];
  x[n_] = sum / corner_;
}

void BorderedCholesky::SolveBandUpper(double* x) const {
  std::copy(x, x + n_, scratch_.begin());
  std::fill(scratch_.begin() + n_, scratch_.end(), 0.0);
  Dispatch(d_, half_,
           [&](auto panels) { panels.SolveUpper(blocks_, band_.data(), scratch_.data()); });
  std::copy(scratch_.begin(), scratch_.begin() + n_, x);
}

void BorderedCholesky::SolveUpper(double* x) const {
  if (bordered_) {
    x[n_] /= corner_;
    for (int i = 0; i < n_; ++i) x[i] -= border_[i] * x[n_];
  }
  SolveBandUpper(x);
}

void BorderedCholesky::SolveWithBorder(double* x) const {
  SolveBandLower(x);
  for (int i = 0; i < n_; ++i) x[i] -= border_[i] * x[n_];
  SolveBandUpper(x);
}

void BorderedCholesky::MultiplyUpper(const double* x, double* out) const {
  Dispatch(d_, half_, [&](auto panels) { panels.MultiplyUpper(n_, band_.data(), x, out); });
  if (!bordered_) return;
  for (int i = 0; i < n_; ++i) out[i] += border_[i] * x[n_];
  out[n_] = corner_ * x[n_];
}

}  // namespace touchdown::solvers
