// SPDX-License-Identifier: BSD-3-Clause
// The same sums as WindowTerm's, over sizes that are known at run time.

#include "touchdown/solvers/problem/function_term.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "solvers/problem/run_time_term.h"

namespace touchdown::solvers {

FunctionTerm::FunctionTerm(TermInfo info, const FunctionShape& shape, Loss loss,
                           Functions functions)
    : info_(std::move(info)),
      first_(shape.first),
      windows_(shape.windows),
      variables_(shape.window * shape.block_size),
      loss_(loss),
      functions_(std::move(functions)) {
  const auto require = [this](const char* name, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument("FunctionTerm " + info_.name + ": " + name + " is " +
                                std::to_string(value) + ", it must be " + std::to_string(low) +
                                " to " + std::to_string(high));
  };
  require("window", shape.window, 1, kMaxWindow);
  require("window x block_size", variables_, 1, kMostVariables);
  require("outputs", shape.outputs, 1, kMostOutputs);
  require("first", shape.first, 0, 1 << 30);
  require("windows", shape.windows, 0, 1 << 30);
  shape_.block_size = shape.block_size;
  shape_.window = shape.window;
  shape_.outputs = shape.outputs;
  shape_.max_windows = shape.windows;
  shape_.uses_interval = false;
  shape_.has_residual = LossHasResidual(loss_);
}

LossBounds FunctionTerm::bounds() const { return BoundsOf(loss_); }

double FunctionTerm::nominal_row_weight() const { return NominalRowWeight(loss_); }

void FunctionTerm::Place(TermBlock* block) const {
  block->windows = windows_;
  for (int k = 0; k < windows_; ++k) block->first_block[k] = first_ + k;
}

void FunctionTerm::Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                            const TermSums& sums) const {
  const bool derivatives =
      (request.want.gradient || request.want.residual) && !request.jacobian_known;
  const int m = shape_.outputs;
  for (int k = 0; k < block->windows; ++k) {
    const double* q = input.x + block->first_block[k] * shape_.block_size;
    const int first = shape_.row(k, 0);
    EvaluateFunction(k, q, derivatives, &block->u[first], block->slopes(first));
    if (derivatives) std::fill_n(&block->du_dh[first], m, 0.0);
    if (request.role == Role::kCost) EvaluateLoss(loss_, k, shape_, request, block);
    if (request.want.gradient) AddGradient(k, shape_, input, request, *block, sums);
    if (request.want.hessian && !request.hessian_known)
      AddHessian(k, q, input, request, *block, sums);
  }
}

void FunctionTerm::RefuseOutput() const {
  const std::string m = std::to_string(shape_.outputs);
  throw std::invalid_argument("FunctionTerm " + info_.name + ": the function writes u[" + m +
                              "], and FunctionShape::outputs is " + m);
}

void FunctionTerm::EvaluateFunction(int window, const double* q, bool derivatives, double* u,
                                    double* du) const {
  // An output that the function does not set must not count as 0; an extra one is written behind the others.
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const int m = shape_.outputs;
  if (!derivatives) {
    std::array<double, kMostOutputs + 1> out;
    std::fill_n(out.begin(), m + 1, kNone);
    functions_.value(window, q, out.data());
    if (!std::isnan(out[m])) RefuseOutput();
    std::copy_n(out.begin(), m, u);
    return;
  }
  std::array<First, kMostVariables> in;
  std::array<First, kMostOutputs + 1> out;
  for (int i = 0; i < variables_; ++i) in[i] = First(q[i], i);
  for (int c = 0; c <= m; ++c) out[c] = First(kNone);
  functions_.first(window, in.data(), out.data());
  if (!std::isnan(out[m].v)) RefuseOutput();
  for (int c = 0; c < m; ++c) {
    u[c] = out[c].v;
    std::copy_n(out[c].d.begin(), variables_, du + c * variables_);
  }
}

void FunctionTerm::AddHessian(int window, const double* q, const TermInput& input,
                              const TermRequest& request, const TermBlock& block,
                              const TermSums& sums) const {
  const int m = shape_.outputs, v = variables_, n = v + 1;
  bool bends = false;
  for (int c = 0; c < m; ++c) {
    bends = bends || SlopeOf(shape_.row(window, c), request, block) != 0.0;
  }
  if (!bends || request.nominal_curvature) {
    return solvers::AddHessian(window, shape_, input, request, block, nullptr, sums);
  }
  std::array<Second, kMostVariables> in;
  std::array<Second, kMostOutputs> out;
  for (int i = 0; i < v; ++i) in[i] = Second(q[i], i);
  functions_.second(window, in.data(), out.data());
  std::array<double, (kMostVariables + 1) * (kMostVariables + 1)> curvature;
  std::fill_n(curvature.begin(), n * n, 0.0);
  for (int c = 0; c < m; ++c) {
    const double slope = SlopeOf(shape_.row(window, c), request, block);
    if (slope == 0.0) continue;
    out[c].ForEachCurvature([&](int i, int j, double d2u) {
      curvature[i * n + j] += slope * d2u;
      if (i != j) curvature[j * n + i] += slope * d2u;
    });
  }
  solvers::AddHessian(window, shape_, input, request, block, curvature.data(), sums);
}

}  // namespace touchdown::solvers
