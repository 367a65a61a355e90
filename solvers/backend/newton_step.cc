// SPDX-License-Identifier: BSD-3-Clause
// The linear algebra that Newton's method and the interior point share.

#include "touchdown/solvers/backend/newton_step.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace touchdown::solvers {

namespace {

constexpr double kFirstShift = 1e-6;  // of the curvature
constexpr double kShiftGrowth = 10.0;
constexpr double kMostShift = 1e4;  // of the largest element

}  // namespace

double Largest(const std::vector<double>& numbers) {
  double largest = 0.0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  return largest;
}

double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double LargestDiagonal(const BorderedBandMatrix& H) {
  const int d = H.block_size();
  double largest = 1e-300;
  for (int i = 0; i < H.blocks(); ++i) {
    for (int r = 0; r < d; ++r) largest = std::max(largest, std::abs(H.block(i, 0)[r * d + r]));
  }
  return largest;
}

double LargestElement(const BorderedBandMatrix& H) {
  const int d = H.block_size();
  double largest = H.bordered() ? std::abs(H.corner()) : 0.0;
  for (int i = 0; i < H.blocks(); ++i) {
    const int last = std::min(H.half_bandwidth(), H.blocks() - 1 - i);
    const double* block = H.block(i, 0);
    for (int k = 0; k < (last + 1) * d * d; ++k) largest = std::max(largest, std::abs(block[k]));
  }
  return largest;
}

bool FactorDefinite(const BorderedBandMatrix& H, BorderedCholesky* factor, double curvature,
                    double* taken) {
  using Status = BorderedCholesky::Status;
  const double first = taken != nullptr ? *taken : 0.0;
  for (double shift = first, most = HUGE_VAL; shift < most;) {
    const Status status = factor->Factor(H, shift, shift);
    if (taken != nullptr) *taken = shift;
    if (status != Status::kIndefinite && factor->corner() > 0.0) return true;
    most = kMostShift * std::max(LargestElement(H), curvature);
    const double size = curvature > 0.0 ? curvature : LargestDiagonal(H);
    shift = shift > 0.0 ? kShiftGrowth * shift : kFirstShift * size;
  }
  return false;
}

double NewtonStep(const View& view, const double* y, const double* gradient,
                  const BorderedCholesky& factor, double* step) {
  const int n = view.num_variables();
  for (int i = 0; i < n; ++i) step[i] = -gradient[i];
  factor.Solve(step);
  const auto promise = [&] { return -0.5 * std::inner_product(step, step + n, gradient, 0.0); };
  if (!view.free_interval()) return promise();
  const ProblemShape& shape = view.problem().shape();
  const double h = y[n - 1];
  const double inside = std::clamp(h + step[n - 1], shape.interval_min, shape.interval_max);
  if (inside == h + step[n - 1]) return promise();
  for (int i = 0; i < n - 1; ++i) step[i] = -gradient[i];
  step[n - 1] = inside - h;
  factor.SolveWithBorder(step);
  return promise();
}

}  // namespace touchdown::solvers
