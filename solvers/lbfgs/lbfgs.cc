// SPDX-License-Identifier: BSD-3-Clause
// Nocedal and Wright, algorithms 7.4 and 7.5. A pair whose curvature s'y is not positive is not
// stored: the inverse Hessian stays positive definite where a line search could not ensure it.

#include "solvers/lbfgs/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

const char* ToString(LbfgsStatus status) {
  switch (status) {
    case LbfgsStatus::kConverged:
      return "converged";
    case LbfgsStatus::kAlreadyMinimized:
      return "already minimized";
    case LbfgsStatus::kIterationLimit:
      return "iteration limit";
    case LbfgsStatus::kCancelled:
      return "cancelled";
    case LbfgsStatus::kLineSearchFailed:
      return "line search failed";
    case LbfgsStatus::kEvaluationFailed:
      return "evaluation failed";
  }
  return "unknown";
}

void Lbfgs::Prepare(int n, int memory) {
  if (n < 1) throw std::invalid_argument("Lbfgs: n is " + std::to_string(n) + ", it must be >= 1");
  if (memory < 1) {
    throw std::invalid_argument("Lbfgs: memory is " + std::to_string(memory) + ", it must be >= 1");
  }
  memory_ = memory;
  s_.setZero(n, memory);
  y_.setZero(n, memory);
  rho_.setZero(memory);
  alpha_.setZero(memory);
  x_before_.setZero(n);
  g_.setZero(n);
  g_before_.setZero(n);
  direction_.setZero(n);
}

LbfgsResult Lbfgs::Minimize(const LbfgsOptions& options, LbfgsFunction* function,
                            Eigen::VectorXd* x) {
  if (memory_ == 0 || x->size() != g_.size()) {
    throw std::invalid_argument("Lbfgs: x has " + std::to_string(x->size()) +
                                " variables, prepared for " + std::to_string(g_.size()));
  }
  LbfgsResult result;
  stored_ = newest_ = 0;
  const auto small = [&] {
    return g_.norm() <= options.gradient_tolerance * std::max(1.0, x->norm());
  };
  const auto end = [&result](LbfgsStatus status) {
    result.status = status;
    return result;
  };

  if (function->Cancelled()) return end(LbfgsStatus::kCancelled);
  result.value = function->Evaluate(*x, &g_);
  result.evaluations = 1;
  if (!std::isfinite(result.value) || !g_.allFinite()) return end(LbfgsStatus::kEvaluationFailed);
  if (small()) return end(LbfgsStatus::kAlreadyMinimized);
  direction_ = -g_;
  double first_step = 1.0 / direction_.norm();
  for (;;) {
    x_before_ = *x;
    g_before_ = g_;
    const double value_before = result.value;
    result.line_search = Search(options, first_step, function, x, &result);
    if (result.line_search != LineSearchState::kConverged) {
      *x = x_before_;
      result.value = value_before;
      if (result.status != LbfgsStatus::kCancelled) result.status = LbfgsStatus::kLineSearchFailed;
      return result;
    }
    ++result.iterations;
    function->Accepted(result.value, g_);
    if (small()) return end(LbfgsStatus::kConverged);
    if (options.max_iterations > 0 && result.iterations >= options.max_iterations) {
      return end(LbfgsStatus::kIterationLimit);
    }
    Remember(*x);
    SetDirection();
    first_step = 1.0;
  }
}

/// The line search along direction_ from x_before_; kEvaluate with status kCancelled if cancelled.
LineSearchState Lbfgs::Search(const LbfgsOptions& options, double first_step,
                              LbfgsFunction* function, Eigen::VectorXd* x, LbfgsResult* result) {
  const double slope = g_before_.dot(direction_);
  if (!(slope < 0.0)) return LineSearchState::kRounding;
  MoreThuente search;
  search.Begin(result->value, slope, first_step, options.line_search);
  while (search.state() == LineSearchState::kEvaluate) {
    if (function->Cancelled()) {
      result->status = LbfgsStatus::kCancelled;
      break;
    }
    *x = x_before_ + search.step() * direction_;
    result->value = function->Evaluate(*x, &g_);
    ++result->evaluations;
    search.Observe(result->value, g_.dot(direction_));
  }
  return search.state();
}

void Lbfgs::Remember(const Eigen::VectorXd& x) {
  const int column = stored_ == 0 ? 0 : (newest_ + 1) % memory_;
  s_.col(column) = x - x_before_;
  y_.col(column) = g_ - g_before_;
  const double curvature = s_.col(column).dot(y_.col(column));
  if (!(curvature > 0.0)) {
    // Its column may have held the oldest pair.
    stored_ = std::min(stored_, memory_ - 1);
    return;
  }
  rho_[column] = 1.0 / curvature;
  newest_ = column;
  stored_ = std::min(stored_ + 1, memory_);
}

/// direction_ = -H g by the two-loop recursion.
void Lbfgs::SetDirection() {
  direction_ = -g_;
  if (stored_ == 0) return;
  const auto column = [this](int age) { return (newest_ - age + memory_) % memory_; };
  for (int age = 0; age < stored_; ++age) {
    const int i = column(age);
    alpha_[i] = rho_[i] * s_.col(i).dot(direction_);
    direction_ -= alpha_[i] * y_.col(i);
  }
  direction_ *= 1.0 / (rho_[newest_] * y_.col(newest_).squaredNorm());
  for (int age = stored_ - 1; age >= 0; --age) {
    const int i = column(age);
    const double beta = rho_[i] * y_.col(i).dot(direction_);
    direction_ += (alpha_[i] - beta) * s_.col(i);
  }
}

}  // namespace touchdown::solvers
