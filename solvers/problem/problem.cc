// SPDX-License-Identifier: BSD-3-Clause
// One pass over all terms: values, the gradient, and the block-banded Hessian
//   sum_k rho''(u) du du^T + rho'(u) d2u   (costs),   sum_k lambda d2u + w du du^T   (constraints).
// At a fixed interval the share of quadratic terms is constant. It is computed once per solve and
// copied.

#include "touchdown/solvers/problem/problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

namespace {

constexpr int kMostScalars = 100000000;  // indices into a band are int

/// The first block of a window that is not inside `blocks`.
std::optional<int> StrayWindow(const TermBlock& block, int window, int blocks) {
  for (int k = 0; k < block.windows; ++k) {
    const int first = block.first_block[k];
    if (first < 0 || first + window > blocks) return first;
  }
  return std::nullopt;
}

}  // namespace

Problem::Problem(const ProblemShape& shape) : shape_(shape) {
  if (shape.blocks < 1 || shape.block_size < 1) {
    throw std::invalid_argument("Problem: " + std::to_string(shape.blocks) + " blocks of " +
                                std::to_string(shape.block_size) + " scalars, both must be >= 1");
  }
  if (shape.block_size > kMostScalars / shape.blocks) {
    throw std::invalid_argument("Problem: " + std::to_string(shape.blocks) + " blocks of " +
                                std::to_string(shape.block_size) +
                                " scalars, together they must be at most 1e8");
  }
  if (!(shape.interval_min > 0.0 && shape.interval_max >= shape.interval_min &&
        std::isfinite(shape.interval_max))) {
    throw std::invalid_argument("Problem: interval bounds [" + std::to_string(shape.interval_min) +
                                ", " + std::to_string(shape.interval_max) +
                                "], they must satisfy 0 < min <= max, both finite");
  }
}

void Problem::AddTerm(std::shared_ptr<const Term> term, Role role) {
  if (!term) throw std::invalid_argument("Problem: the term is a null pointer");
  const TermShape& t = term->shape();
  const int longest = std::min(kMaxWindow, shape_.blocks);
  if (t.block_size != shape_.block_size || t.window < 1 || t.window > longest) {
    throw std::invalid_argument(
        "Problem: term " + term->info().name + " has windows of " + std::to_string(t.window) +
        " blocks of " + std::to_string(t.block_size) + ", it must be 1 to " +
        std::to_string(longest) + " blocks of " + std::to_string(shape_.block_size));
  }
  const LossBounds bounds = term->bounds();
  if (role == Role::kConstraint && !(bounds.lo <= bounds.hi)) {
    throw std::invalid_argument("Problem: rows of term " + term->info().name + " have bounds [" +
                                std::to_string(bounds.lo) + ", " + std::to_string(bounds.hi) +
                                "], they must satisfy lo <= hi");
  }
  if (role == Role::kConstraint && bounds.lo == -kInfinity && bounds.hi == kInfinity) {
    throw std::invalid_argument("Problem: rows of term " + term->info().name +
                                " have no bounds: a loss that is zero on an interval makes rows, "
                                "as RangeLoss and SquareLoss do");
  }
  TermBlock block;
  block.Resize(t);
  term->Place(&block);
  if (const std::optional<int> first = StrayWindow(block, t.window, shape_.blocks)) {
    throw std::invalid_argument("Problem: term " + term->info().name + " has a window of blocks " +
                                std::to_string(*first) + " to " +
                                std::to_string(*first + t.window - 1) + ", they must be 0 to " +
                                std::to_string(shape_.blocks - 1));
  }
  half_bandwidth_ = std::max(half_bandwidth_, t.window - 1);
  terms_.push_back({std::move(term), role});
}

void Problem::SetBounds(std::vector<double> lower, std::vector<double> upper) {
  const auto n = static_cast<std::size_t>(shape_.blocks * shape_.block_size);
  if (lower.size() != n || upper.size() != n) {
    throw std::invalid_argument("Problem: " + std::to_string(lower.size()) + " lower and " +
                                std::to_string(upper.size()) + " upper bounds, it has " +
                                std::to_string(n) + " scalars in blocks");
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (lower[i] <= upper[i] && lower[i] < kInfinity && upper[i] > -kInfinity) continue;
    throw std::invalid_argument("Problem: scalar " + std::to_string(i) + " has bounds [" +
                                std::to_string(lower[i]) + ", " + std::to_string(upper[i]) +
                                "], they must satisfy lower <= upper");
  }
  lower_ = std::move(lower);
  upper_ = std::move(upper);
  for (double& bound : lower_) bound = bound <= -kNoBound ? -kInfinity : bound;
  for (double& bound : upper_) bound = bound >= kNoBound ? kInfinity : bound;
}

bool Problem::convex() const {
  return !shape_.free_interval && std::all_of(terms_.begin(), terms_.end(),
                                              [](const Entry& e) { return e.term->info().convex; });
}

namespace {

bool IsFinite(const double* numbers, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += 0.0 * numbers[i];  // NaN if one is not finite
  return sum == 0.0;
}

}  // namespace

void Evaluation::HoldParameters() {
  hold_ = true;
  placed_ = false;
  ForgetConstants();
}

void Evaluation::ForgetConstants() {
  constant_jacobian_ = false;
  constant_factor_ = std::numeric_limits<double>::quiet_NaN();
}

void Problem::Resize(Evaluation* evaluation) const {
  const int n = shape_.blocks * shape_.block_size + (shape_.free_interval ? 1 : 0);
  evaluation->gradient.assign(static_cast<std::size_t>(n), 0.0);
  evaluation->row_gradient.assign(static_cast<std::size_t>(n), 0.0);
  for (BorderedBandMatrix* matrix : {&evaluation->hessian, &evaluation->constant_hessian_}) {
    matrix->Resize(shape_.blocks, shape_.block_size, half_bandwidth_, shape_.free_interval);
  }
  evaluation->cost_by_term.assign(terms_.size(), 0.0);
  evaluation->terms.resize(terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    evaluation->terms[i].Resize(terms_[i].term->shape());
  }
  evaluation->HoldParameters();  // forgets what an earlier structure held
  evaluation->hold_ = false;
}

bool Problem::Fits(const Evaluation& evaluation) const {
  const BorderedBandMatrix& H = evaluation.hessian;
  bool fits = evaluation.terms.size() == terms_.size() && H.blocks() == shape_.blocks &&
              H.block_size() == shape_.block_size && H.half_bandwidth() == half_bandwidth_ &&
              H.bordered() == shape_.free_interval;
  for (std::size_t i = 0; fits && i < terms_.size(); ++i) {
    fits = evaluation.terms[i].Fits(terms_[i].term->shape());
  }
  return fits;
}

bool Problem::Evaluate(const double* x, double h, Want want, const Lagrangian& lagrangian,
                       Evaluation* evaluation) const noexcept {
  evaluation->ok = EvaluateAll(x, h, want, lagrangian, evaluation);
  // Derivatives taken where a map is not finite may be wrong even if they are constant.
  if (!evaluation->ok) evaluation->ForgetConstants();
  return evaluation->ok;
}

bool Problem::EvaluateAll(const double* x, double h, Want want, const Lagrangian& lagrangian,
                          Evaluation* evaluation) const noexcept {
  const TermInput input{.x = x,
                        .h = h,
                        .t0 = t0_,
                        .free_interval = shape_.free_interval,
                        .lower = bounded() ? lower_.data() : nullptr,
                        .upper = bounded() ? upper_.data() : nullptr,
                        .h_lower = shape_.interval_min,
                        .h_upper = shape_.interval_max};
  evaluation->value = 0.0;
  evaluation->max_violation = 0.0;
  evaluation->worst_term = -1;
  evaluation->failed_term = -1;
  evaluation->failure.clear();
  want.gradient = want.gradient || want.hessian;
  if (!Fits(*evaluation)) {
    evaluation->failure = "the evaluation was not resized for this problem as it is now";
    return false;
  }
  const TermSums sums{evaluation->gradient.data(), evaluation->row_gradient.data(),
                      shape_.blocks * shape_.block_size, &evaluation->hessian};
  if (want.gradient) std::fill(evaluation->gradient.begin(), evaluation->gradient.end(), 0.0);
  if (bounded()) AddBoundViolation(x, evaluation);
  try {
    if (!Place(evaluation)) return false;
    if (want.hessian) StartHessian(lagrangian, input, sums, evaluation);
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Entry& entry = terms_[i];
      evaluation->failed_term = static_cast<int>(i);
      const bool held = HeldConstant(entry, *evaluation);
      TermRequest request{.want = want,
                          .role = entry.role,
                          .objective_factor = lagrangian.objective_factor,
                          .nominal_curvature = lagrangian.nominal_curvature,
                          .jacobian_known = held && evaluation->constant_jacobian_,
                          .hessian_known = held};
      if (lagrangian.rows && want.hessian) request.rows = lagrangian.rows[i];
      entry.term->Evaluate(input, request, &evaluation->terms[i], sums);
      const bool cost = entry.role == Role::kCost;
      if (!(cost ? AddCost(i, evaluation) : AddViolation(i, want.gradient, evaluation))) {
        return false;
      }
    }
  } catch (const std::exception& error) {  // cannot be evaluated here: the caller sees a status
    evaluation->failure = error.what();
    return false;
  } catch (...) {
    evaluation->failure = "it threw what is no std::exception";
    return false;
  }
  evaluation->failed_term = -1;
  if (want.gradient || want.residual) evaluation->constant_jacobian_ = evaluation->hold_;
  return !want.gradient || IsFinite(evaluation->gradient.data(), evaluation->gradient.size());
}

bool Problem::Place(Evaluation* evaluation) const {
  if (evaluation->placed_) return true;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    TermBlock& block = evaluation->terms[i];
    terms_[i].term->Place(&block);
    if (StrayWindow(block, terms_[i].term->shape().window, shape_.blocks)) return false;
  }
  evaluation->placed_ = evaluation->hold_;
  return true;
}

bool Problem::HeldConstant(const Entry& entry, const Evaluation& evaluation) const {
  return evaluation.hold_ && !shape_.free_interval && entry.role == Role::kCost &&
         entry.term->shape().quadratic;
}

void Problem::StartHessian(const Lagrangian& lagrangian, const TermInput& input,
                           const TermSums& sums, Evaluation* evaluation) const {
  std::fill(evaluation->row_gradient.begin(), evaluation->row_gradient.end(), 0.0);
  if (!evaluation->hold_ || shape_.free_interval) {
    evaluation->hessian.SetZero();
    return;
  }
  if (evaluation->constant_factor_ != lagrangian.objective_factor ||
      evaluation->constant_nominal_ != lagrangian.nominal_curvature) {
    evaluation->constant_hessian_.SetZero();
    TermSums constant = sums;  // the gradient that this adds to is cleared below
    constant.hessian = &evaluation->constant_hessian_;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (!HeldConstant(terms_[i], *evaluation)) continue;
      terms_[i].term->Evaluate(input,
                               {.want = {.gradient = true, .hessian = true},
                                .objective_factor = lagrangian.objective_factor,
                                .nominal_curvature = lagrangian.nominal_curvature,
                                .jacobian_known = evaluation->constant_jacobian_},
                               &evaluation->terms[i], constant);
    }
    std::fill(evaluation->gradient.begin(), evaluation->gradient.end(), 0.0);
    evaluation->constant_factor_ = lagrangian.objective_factor;
    evaluation->constant_nominal_ = lagrangian.nominal_curvature;
  }
  evaluation->hessian = evaluation->constant_hessian_;
}

bool Problem::AddCost(std::size_t i, Evaluation* evaluation) const {
  const TermBlock& block = evaluation->terms[i];
  double sum = 0.0;
  for (int j = 0; j < block.rows(); ++j) sum += block.rho[j];
  evaluation->cost_by_term[i] = sum;
  evaluation->value += sum;
  return std::isfinite(sum);
}

void Problem::AddBoundViolation(const double* x, Evaluation* evaluation) const {
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    evaluation->max_violation =
        std::max({evaluation->max_violation, lower_[i] - x[i], x[i] - upper_[i]});
  }
}

bool Problem::AddViolation(std::size_t i, bool gradient, Evaluation* evaluation) const {
  const TermBlock& block = evaluation->terms[i];
  const LossBounds bounds = terms_[i].term->bounds();
  for (int j = 0; j < block.rows(); ++j) {
    const double violation = std::max(bounds.lo - block.u[j], block.u[j] - bounds.hi);
    if (!std::isfinite(block.u[j])) return false;
    if (violation <= evaluation->max_violation) continue;
    evaluation->max_violation = violation;
    evaluation->worst_term = static_cast<int>(i);
  }
  // A row may have a value where its slope has none.
  const auto rows = static_cast<std::size_t>(block.rows());
  const auto slopes = rows * static_cast<std::size_t>(terms_[i].term->shape().variables());
  return !gradient || (IsFinite(block.du.data(), slopes) && IsFinite(block.du_dh.data(), rows));
}

}  // namespace touchdown::solvers
