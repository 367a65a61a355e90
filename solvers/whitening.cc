// SPDX-License-Identifier: BSD-3-Clause
// The metric of the whitened view. Its Hessian is positive semidefinite by construction; where terms
// leave directions free (an explicit endpoint's spline without its rows), a small multiple of the
// mean diagonal makes it definite.

#include "touchdown/solvers/whitening.h"

#include <algorithm>
#include <cmath>

namespace touchdown::solvers {

namespace {

constexpr double kFirstShift = 1e-9;  // of the mean diagonal
constexpr double kShiftGrowth = 100.0;
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
  const double unit = std::max(MeanDiagonal(evaluation->hessian), 1e-12);
  double shift = 0.0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const BorderedCholesky::Status status = factor_.Factor(evaluation->hessian, shift, shift);
    if (status != BorderedCholesky::Status::kIndefinite && factor_.corner() > 1e-9 * unit) {
      regular_ = shift == 0.0;
      return true;
    }
    shift = shift == 0.0 ? kFirstShift * unit : kShiftGrowth * shift;
  }
  return false;
}

void Whitening::ToWhite(const double* y, double* z) const { factor_.MultiplyUpper(y, z); }

void Whitening::FromWhite(const double* z, double* y) const {
  std::copy(z, z + size(), y);
  factor_.SolveUpper(y);
}

}  // namespace touchdown::solvers
