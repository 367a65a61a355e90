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
  const int longest = std::min(kMaxWindow, shape_.blocks);
  if (t.block_size != shape_.block_size || t.window < 1 || t.window > longest) {
    throw std::invalid_argument(
        "Problem: term " + term->info().name + " has windows of " + std::to_string(t.window) +
        " blocks of " + std::to_string(t.block_size) + ", it must be 1 to " +
        std::to_string(longest) + " blocks of " + std::to_string(shape_.block_size));
  }
  half_bandwidth_ = std::max(half_bandwidth_, t.window - 1);
  terms_.push_back({std::move(term), role});
}

bool Problem::convex() const {
  return !shape_.free_interval && std::all_of(terms_.begin(), terms_.end(),
                                              [](const Entry& e) { return e.term->info().convex; });
}

void Problem::Resize(Evaluation* evaluation) const {
  const int n = shape_.blocks * shape_.block_size + (shape_.free_interval ? 1 : 0);
  evaluation->gradient.assign(static_cast<std::size_t>(n), 0.0);
  evaluation->lagrangian_gradient.assign(static_cast<std::size_t>(n), 0.0);
  evaluation->hessian.Resize(shape_.blocks, shape_.block_size, half_bandwidth_,
                             shape_.free_interval);
  evaluation->cost_by_term.assign(terms_.size(), 0.0);
  evaluation->terms.resize(terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    evaluation->terms[i].Resize(terms_[i].term->shape());
  }
}

bool Problem::WindowsFit(const TermShape& shape, const TermBlock& block) const {
  for (int k = 0; k < block.windows; ++k) {
    const int first = block.first_block[k];
    if (first < 0 || first + shape.window > shape_.blocks) return false;
  }
  return true;
}

bool Problem::Evaluate(const double* x, double h, Want want, const Lagrangian& lagrangian,
                       Evaluation* evaluation) const noexcept {
  const TermInput input{x, h, t0_, shape_.free_interval};
  evaluation->ok = false;
  evaluation->value = 0.0;
  evaluation->max_violation = 0.0;
  const auto zero = [](std::vector<double>* array) {
    std::fill(array->begin(), array->end(), 0.0);
  };
  if (want.gradient) zero(&evaluation->gradient);
  if (want.hessian) {
    zero(&evaluation->lagrangian_gradient);
    evaluation->hessian.SetZero();
  }
  try {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Entry& entry = terms_[i];
      TermBlock& block = evaluation->terms[i];
      const TermShape& shape = entry.term->shape();
      const bool cost = entry.role == Role::kCost;
      const double* row_multipliers =
          cost || !lagrangian.multipliers ? nullptr : lagrangian.multipliers[i];
      entry.term->Evaluate(input, want, row_multipliers, &block);
      if (!WindowsFit(shape, block)) return false;
      if (!(cost ? AddCost(i, evaluation) : AddViolation(i, evaluation))) return false;
      if (want.gradient && cost) {
        AddGradient(shape, block, 1.0, block.drho.data(), &evaluation->gradient);
      }
      // A row without multipliers is no part of the Lagrangian.
      if (!want.hessian || (!cost && !row_multipliers)) continue;
      const double factor = cost ? lagrangian.objective_factor : 1.0;
      AddGradient(shape, block, factor, cost ? block.drho.data() : row_multipliers,
                  &evaluation->lagrangian_gradient);
      AddHessian(entry, block, factor, evaluation);
    }
  } catch (...) {
    return false;  // a term that throws cannot be evaluated here: the caller sees a status
  }
  return evaluation->ok = true;
}

bool Problem::AddCost(std::size_t i, Evaluation* evaluation) const {
  const TermBlock& block = evaluation->terms[i];
  const int outputs = block.windows * terms_[i].term->shape().outputs;
  double sum = 0.0;
  for (int j = 0; j < outputs; ++j) sum += block.rho[j];
  evaluation->cost_by_term[i] = sum;
  evaluation->value += sum;
  return std::isfinite(sum);
}

bool Problem::AddViolation(std::size_t i, Evaluation* evaluation) const {
  const TermBlock& block = evaluation->terms[i];
  const int outputs = block.windows * terms_[i].term->shape().outputs;
  const LossBounds bounds = terms_[i].term->bounds();
  for (int j = 0; j < outputs; ++j) {
    const double violation = std::max(bounds.lo - block.u[j], block.u[j] - bounds.hi);
    if (std::isnan(violation)) return false;
    evaluation->max_violation = std::max(evaluation->max_violation, violation);
  }
  return true;
}

void Problem::AddGradient(const TermShape& t, const TermBlock& block, double factor,
                          const double* weights, std::vector<double>* gradient) const {
  const int v = t.window * t.block_size;
  for (int k = 0; k < block.windows; ++k) {
    double* g = &(*gradient)[block.first_block[k] * t.block_size];
    for (int c = k * t.outputs; c < (k + 1) * t.outputs; ++c) {
      const double weight = factor * weights[c];
      if (weight == 0.0) continue;
      const double* du = &block.du[c * v];
      for (int i = 0; i < v; ++i) g[i] += weight * du[i];
      if (shape_.free_interval) gradient->back() += weight * block.du_dh[c];
    }
  }
}

void Problem::AddHessian(const Entry& entry, const TermBlock& block, double factor,
                         Evaluation* evaluation) const {
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
      if (cost) {
        for (int c = k * t.outputs; c < (k + 1) * t.outputs; ++c) {
          const double left = i < v ? block.du[c * v + i] : block.du_dh[c];
          const double right = j < v ? block.du[c * v + j] : block.du_dh[c];
          sum += block.d2rho[c] * left * right;
        }
      }
      return factor * sum;
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
