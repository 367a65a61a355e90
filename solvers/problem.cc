// SPDX-License-Identifier: BSD-3-Clause
// One pass over all terms: values, the gradient, and the block-banded Hessian
//   sum_k rho''(u) du du^T + rho'(u) d2u   (costs),   sum_k lambda d2u   (constraints),
// assembled from each term's plain arrays. Terms never learn their place in x.

#include "touchdown/solvers/problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

Problem::Problem(const ProblemShape& shape) : shape_(shape) {
  if (shape.blocks < 1 || shape.block_size < 1) {
    throw std::invalid_argument("Problem: " + std::to_string(shape.blocks) + " blocks of " +
                                std::to_string(shape.block_size) + " scalars, both must be >= 1");
  }
  if (!(shape.interval_min > 0.0 && shape.interval_max >= shape.interval_min)) {
    throw std::invalid_argument("Problem: interval bounds [" + std::to_string(shape.interval_min) +
                                ", " + std::to_string(shape.interval_max) +
                                "], they must satisfy 0 < min <= max");
  }
}

void Problem::AddTerm(std::shared_ptr<const Term> term, Role role) {
  const TermShape& t = term->shape();
  if (t.block_size != shape_.block_size || t.window < 1 || t.window > shape_.blocks) {
    throw std::invalid_argument(
        "Problem: term " + term->info().name + " has windows of " + std::to_string(t.window) +
        " blocks of " + std::to_string(t.block_size) + ", the problem has " +
        std::to_string(shape_.blocks) + " blocks of " + std::to_string(shape_.block_size));
  }
  half_bandwidth_ = std::max(half_bandwidth_, t.window - 1);
  terms_.push_back({std::move(term), role});
}

bool Problem::has_constraints() const {
  return std::any_of(terms_.begin(), terms_.end(),
                     [](const Entry& e) { return e.role == Role::kConstraint; });
}

bool Problem::convex() const {
  return !shape_.free_interval && std::all_of(terms_.begin(), terms_.end(),
                                              [](const Entry& e) { return e.term->info().convex; });
}

void Problem::Resize(Evaluation* evaluation) const {
  const int n = shape_.blocks * shape_.block_size + (shape_.free_interval ? 1 : 0);
  evaluation->gradient.assign(static_cast<std::size_t>(n), 0.0);
  evaluation->hessian.Resize(shape_.blocks, shape_.block_size, half_bandwidth_,
                             shape_.free_interval);
  evaluation->cost_by_term.assign(terms_.size(), 0.0);
  evaluation->terms.resize(terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    evaluation->terms[i].Resize(terms_[i].term->shape());
  }
}

bool Problem::Evaluate(const double* x, double h, Want want, const double* const* multipliers,
                       Evaluation* evaluation) const noexcept {
  const TermInput input{x, h, t0_, shape_.free_interval};
  evaluation->ok = false;
  evaluation->value = 0.0;
  evaluation->max_violation = 0.0;
  if (want.gradient) std::fill(evaluation->gradient.begin(), evaluation->gradient.end(), 0.0);
  if (want.hessian) evaluation->hessian.SetZero();
  try {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Entry& entry = terms_[i];
      TermBlock& block = evaluation->terms[i];
      const bool cost = entry.role == Role::kCost;
      entry.term->Evaluate(input, want, multipliers && !cost ? multipliers[i] : nullptr, &block);
      const int outputs = block.windows * entry.term->shape().outputs;
      double sum = 0.0;
      const LossBounds bounds = entry.term->bounds();
      for (int j = 0; j < outputs; ++j) {
        sum += cost ? block.rho[j] : 0.0;
        if (!cost) {
          const double violation = std::max(bounds.lo - block.u[j], block.u[j] - bounds.hi);
          evaluation->max_violation = std::max(evaluation->max_violation, violation);
          if (std::isnan(violation)) return false;
        }
      }
      if (!std::isfinite(sum)) return false;
      evaluation->cost_by_term[i] = sum;
      evaluation->value += sum;
      if (want.gradient && cost) AddGradient(entry, block, evaluation);
      if (want.hessian && (cost || multipliers)) AddHessian(entry, block, evaluation);
    }
  } catch (...) {
    return false;  // a term that throws cannot be evaluated here: the caller sees a status
  }
  return evaluation->ok = true;
}

void Problem::AddGradient(const Entry& entry, const TermBlock& block,
                          Evaluation* evaluation) const {
  const TermShape& t = entry.term->shape();
  const int v = t.window * t.block_size;
  for (int k = 0; k < block.windows; ++k) {
    double* g = &evaluation->gradient[block.first_block[k] * t.block_size];
    for (int c = k * t.outputs; c < (k + 1) * t.outputs; ++c) {
      const double slope = block.drho[c];
      if (slope == 0.0) continue;
      const double* du = &block.du[c * v];
      for (int i = 0; i < v; ++i) g[i] += slope * du[i];
      if (shape_.free_interval) evaluation->gradient.back() += slope * block.du_dh[c];
    }
  }
}

void Problem::AddHessian(const Entry& entry, const TermBlock& block, Evaluation* evaluation) const {
  const TermShape& t = entry.term->shape();
  const int d = t.block_size;
  const int v = t.window * d;
  const bool cost = entry.role == Role::kCost;
  BorderedBandMatrix& hessian = evaluation->hessian;
  for (int k = 0; k < block.windows; ++k) {
    const int first = block.first_block[k];
    const double* curvature = &block.curvature[k * (v + 1) * (v + 1)];
    const auto element = [&](int i, int j) {
      double sum = curvature[i * (v + 1) + j];
      if (!cost) return sum;
      for (int c = k * t.outputs; c < (k + 1) * t.outputs; ++c) {
        const double left = i < v ? block.du[c * v + i] : block.du_dh[c];
        const double right = j < v ? block.du[c * v + j] : block.du_dh[c];
        sum += block.d2rho[c] * left * right;
      }
      return sum;
    };
    for (int a = 0; a < t.window; ++a) {
      for (int b = a; b < t.window; ++b) {
        double* out = hessian.block(first + a, b - a);
        for (int i = 0; i < d; ++i) {
          for (int j = 0; j < d; ++j) out[i * d + j] += element(a * d + i, b * d + j);
        }
      }
    }
    if (shape_.free_interval) {
      for (int i = 0; i < v; ++i) hessian.border()[first * d + i] += element(i, v);
      hessian.corner() += element(v, v);
    }
  }
}

}  // namespace touchdown::solvers
