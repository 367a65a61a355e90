// SPDX-License-Identifier: BSD-3-Clause
// The metric of the whitened view. Its Hessian is positive semidefinite by construction. Terms may
// leave directions free (an explicit endpoint's spline without its rows). A small multiple of the
// mean diagonal then makes it definite.

#include "touchdown/solvers/backend/whitening.h"

#include <algorithm>
#include <cmath>

namespace touchdown::solvers {

namespace {

constexpr double kWhiteningFirstShift = 1e-9;  // of the mean diagonal, and of the corner
constexpr double kLeastCorner = 1e-10;  // of the corner: less is rounding of what was subtracted
constexpr double kWhiteningShiftGrowth = 100.0;
constexpr int kAttempts = 8;

double MeanDiagonal(const BorderedBandMatrix& A) {
  const int d = A.block_size();
  double sum = 0.0;
  for (int i = 0; i < A.blocks(); ++i) {
    for (int r = 0; r < d; ++r) sum += A.block(i, 0)[r * d + r];
  }
  return sum / (A.blocks() * d);
}

}  // namespace

void Whitening::Prepare(const View& view) {
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  const auto terms = static_cast<std::size_t>(view.problem().num_terms());
  weights_.assign(terms, {});
  rows_.assign(terms, {});
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    const Term& term = view.problem().term(i);
    const LossBounds bounds = term.bounds();
    if (view.problem().role(i) != Role::kConstraint || bounds.lo != bounds.hi) continue;
    const TermShape& shape_i = term.shape();
    weights_[i].assign(static_cast<std::size_t>(shape_i.max_windows * shape_i.outputs),
                       term.nominal_row_weight());
    rows_[i].weight = weights_[i].data();
  }
}

bool Whitening::Set(const View& view, const double* y, ViewEvaluation* evaluation) {
  const Lagrangian nominal{.rows = rows_.data(), .nominal_curvature = true};
  if (!view.Evaluate(y, {.gradient = true, .hessian = true}, nominal, evaluation)) return false;
  const BorderedBandMatrix& H = evaluation->hessian;
  const double unit = MeanDiagonal(H);
  const double corner = H.bordered() ? H.corner() : 1.0;
  double shift = 0.0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const auto status = factor_.Factor(H, shift * unit, shift * corner);
    const bool border_ok =
        !H.bordered() || (status == BorderedCholesky::Status::kDefinite &&
                          factor_.corner() * factor_.corner() > kLeastCorner * corner);
    if (status != BorderedCholesky::Status::kIndefinite && border_ok) {
      regular_ = shift == 0.0;
      return true;
    }
    shift = shift == 0.0 ? kWhiteningFirstShift : kWhiteningShiftGrowth * shift;
  }
  regular_ = false;
  return true;
}

void Whitening::ToWhite(const double* y, double* z) const { factor_.MultiplyUpper(y, z); }

void Whitening::FromWhite(const double* z, double* y) const {
  std::copy(z, z + size(), y);
  factor_.SolveUpper(y);
}

}  // namespace touchdown::solvers
