// SPDX-License-Identifier: BSD-3-Clause
#include "solvers/problem/run_time_term.h"

#include <variant>

namespace touchdown::solvers {

namespace {

template <class Loss>
constexpr bool kHasResidual = requires(const Loss& loss) {
  loss.Residual(0.0);
};

}  // namespace

LossBounds BoundsOf(const AnyLoss& loss) {
  return std::visit([](const auto& l) { return l.bounds(); }, loss);
}

double NominalRowWeight(const AnyLoss& loss) {
  return std::visit([](const auto& l) { return l.NominalCurvature(0.0); }, loss);
}

bool LossHasResidual(const AnyLoss& loss) {
  return std::visit([](const auto& l) { return kHasResidual<std::decay_t<decltype(l)>>; }, loss);
}

bool IsQuadratic(const AnyLoss& loss) {
  return std::visit([](const auto& l) { return std::decay_t<decltype(l)>::kQuadratic; }, loss);
}

void EvaluateLoss(const AnyLoss& loss, int window, const TermShape& shape,
                  const TermRequest& request, TermBlock* block) {
  std::visit(
      [&](const auto& l) {
        const int m = shape.outputs;
        for (int i = window * m; i < (window + 1) * m; ++i) {
          const LossValue value = l.Value(block->u[i]);
          block->rho[i] = value.rho;
          block->drho[i] = value.drho;
          block->d2rho[i] =
              request.nominal_curvature ? l.NominalCurvature(block->u[i]) : value.d2rho;
          if constexpr (kHasResidual<std::decay_t<decltype(l)>>) {
            if (!request.want.residual) continue;
            const LossResidual residual = l.Residual(block->u[i]);
            block->r[i] = residual.r;
            block->dr[i] = residual.dr;
          }
        }
      },
      loss);
}

double SlopeOf(int row, const TermRequest& request, const TermBlock& block) {
  if (request.role == Role::kCost) return request.objective_factor * block.drho[row];
  return request.rows.multiplier ? request.rows.multiplier[row] : 0.0;
}

void AddGradient(int window, const TermShape& shape, const TermInput& input,
                 const TermRequest& request, const TermBlock& block, const TermSums& sums) {
  const bool cost = request.role == Role::kCost;
  const double* weights = cost ? block.drho.data() : request.rows.multiplier;
  if (!weights) return;
  double* out = cost ? sums.gradient : sums.row_gradient;
  double* blocks = out + block.first_block[window] * shape.block_size;
  for (int c = 0; c < shape.outputs; ++c) {
    const int row = shape.row(window, c);
    if (weights[row] == 0.0) continue;
    const double* du = block.slopes(row);
    for (int i = 0; i < shape.variables(); ++i) blocks[i] += weights[row] * du[i];
    if (input.free_interval) out[sums.interval_index] += weights[row] * block.du_dh[row];
  }
}

void AddHessian(int window, const TermShape& shape, const TermInput& input,
                const TermRequest& request, const TermBlock& block, const double* curvature,
                const TermSums& sums) {
  const int d = shape.block_size, v = shape.variables(), n = v + 1;
  const int first = block.first_block[window];
  BorderedBandMatrix& hessian = *sums.hessian;
  const auto weight_of = [&](int row) {
    if (request.role == Role::kCost) return request.objective_factor * block.d2rho[row];
    return request.rows.weight ? request.rows.weight[row] : 0.0;
  };
  for (int c = 0; c < shape.outputs; ++c) {
    const int row = shape.row(window, c);
    const double weight = weight_of(row);
    if (weight == 0.0) continue;
    const double* du = block.slopes(row);
    const double du_dh = block.du_dh[row];
    for (int i = 0; i < v; ++i) {
      for (int j = i / d * d; j < v; ++j) {
        hessian.block(first + i / d, j / d - i / d)[i % d * d + j % d] += weight * du[i] * du[j];
      }
      if (input.free_interval) hessian.border()[first * d + i] += weight * du[i] * du_dh;
    }
    if (input.free_interval) hessian.corner() += weight * du_dh * du_dh;
  }
  if (curvature == nullptr) return;
  for (int i = 0; i < v; ++i) {
    for (int j = i / d * d; j < v; ++j) {
      hessian.block(first + i / d, j / d - i / d)[i % d * d + j % d] += curvature[i * n + j];
    }
    if (input.free_interval) hessian.border()[first * d + i] += curvature[i * n + v];
  }
  if (input.free_interval) hessian.corner() += curvature[n * n - 1];
}

}  // namespace touchdown::solvers
