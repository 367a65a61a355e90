// SPDX-License-Identifier: BSD-3-Clause
// The same sums as WindowTerm's, over sizes that are known at run time.

#include "touchdown/solvers/problem/function_term.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

namespace {

template <class Loss>
constexpr bool kHasResidual = requires(const Loss& loss) {
  loss.Residual(0.0);
};

}  // namespace

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
  shape_.has_residual =
      std::visit([](const auto& l) { return kHasResidual<std::decay_t<decltype(l)>>; }, loss_);
}

LossBounds FunctionTerm::bounds() const {
  return std::visit([](const auto& loss) { return loss.bounds(); }, loss_);
}

double FunctionTerm::nominal_row_weight() const {
  return std::visit([](const auto& loss) { return loss.NominalCurvature(0.0); }, loss_);
}

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
    if (request.role == Role::kCost) EvaluateLoss(k, request, block);
    if (request.want.gradient) AddGradient(k, request, *block, sums);
    if (request.want.hessian && !request.hessian_known) {
      AddHessian(k, q, request, *block, sums.hessian);
    }
  }
}

void FunctionTerm::RefuseOutput() const {
  const std::string m = std::to_string(shape_.outputs);
  throw std::invalid_argument("FunctionTerm " + info_.name + ": the function writes u[" + m +
                              "], and FunctionShape::outputs is " + m);
}

void FunctionTerm::EvaluateFunction(int window, const double* q, bool derivatives, double* u,
                                    double* du) const {
  // An output that the function forgets must not count as 0; one that it invents is written behind the others.
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

void FunctionTerm::EvaluateLoss(int window, const TermRequest& request, TermBlock* block) const {
  std::visit(
      [&](const auto& loss) {
        const int m = shape_.outputs;
        for (int i = window * m; i < (window + 1) * m; ++i) {
          const LossValue value = loss.Value(block->u[i]);
          block->rho[i] = value.rho;
          block->drho[i] = value.drho;
          block->d2rho[i] =
              request.nominal_curvature ? loss.NominalCurvature(block->u[i]) : value.d2rho;
          if constexpr (kHasResidual<std::decay_t<decltype(loss)>>) {
            if (!request.want.residual) continue;
            const LossResidual residual = loss.Residual(block->u[i]);
            block->r[i] = residual.r;
            block->dr[i] = residual.dr;
          }
        }
      },
      loss_);
}

void FunctionTerm::AddGradient(int window, const TermRequest& request, const TermBlock& block,
                               const TermSums& sums) const {
  const int m = shape_.outputs;
  const bool cost = request.role == Role::kCost;
  const double* weights = cost ? &block.drho[window * m] : nullptr;
  if (!cost && request.rows.multiplier) weights = request.rows.multiplier + window * m;
  if (!weights) return;
  double* out =
      (cost ? sums.gradient : sums.row_gradient) + block.first_block[window] * shape_.block_size;
  for (int c = 0; c < m; ++c) {
    if (weights[c] == 0.0) continue;
    const double* du = block.slopes(shape_.row(window, c));
    for (int i = 0; i < variables_; ++i) out[i] += weights[c] * du[i];
  }
}

/// Adds sum_c (weight_c du_c du_c^T + slope_c d2u_c) of one window.
void FunctionTerm::AddHessian(int window, const double* q, const TermRequest& request,
                              const TermBlock& block, BorderedBandMatrix* hessian) const {
  const int m = shape_.outputs, n = variables_, d = shape_.block_size;
  std::array<double, kMostOutputs> weight{}, slope{};
  bool bends = false;
  for (int c = 0; c < m; ++c) {
    const int i = shape_.row(window, c);
    if (request.role == Role::kCost) {
      weight[c] = request.objective_factor * block.d2rho[i];
      slope[c] = request.objective_factor * block.drho[i];
    } else {
      if (request.rows.weight) weight[c] = request.rows.weight[i];
      if (request.rows.multiplier) slope[c] = request.rows.multiplier[i];
    }
    bends = bends || slope[c] != 0.0;
  }
  std::array<Second, kMostOutputs> out;
  bends = bends && !request.nominal_curvature;
  if (bends) {
    std::array<Second, kMostVariables> in;
    for (int i = 0; i < n; ++i) in[i] = Second(q[i], i);
    functions_.second(window, in.data(), out.data());
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i / d * d; j < n; ++j) {
      double sum = 0.0;
      for (int c = 0; c < m; ++c) {
        const double* du = block.slopes(shape_.row(window, c));
        sum += weight[c] * du[i] * du[j];
        if (bends && slope[c] != 0.0) sum += slope[c] * out[c].curvature(i, j);
      }
      const int a = i / d, b = j / d;
      hessian->block(block.first_block[window] + a, b - a)[i % d * d + j % d] += sum;
    }
  }
}

}  // namespace touchdown::solvers
