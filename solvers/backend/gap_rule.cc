// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/backend/gap_rule.h"

#include <algorithm>
#include <cmath>

#include "touchdown/solvers/backend/newton_step.h"

namespace touchdown::solvers {

namespace {

constexpr double kFallen = 0.5;  // of what a look found too much, before the next

}  // namespace

void GapRule::Prepare(const View& view, OptimalityCheck* check) {
  check_ = check;
  view.Resize(&storage_);
  factor_.Prepare(storage_.hessian);
  step_.assign(static_cast<std::size_t>(view.num_variables()), 0.0);
}

void GapRule::Begin(const View& view, double gap) {
  view_ = &view;
  gap_ = gap;
  look_below_ = Problem::kInfinity;
  points_ = looked_ = 0;
  storage_.HoldParameters();
}

bool GapRule::Met(const Eigen::VectorXd& y, double cost, double violation) {
  ++points_;
  // Far from the optimum a model may promise more than there is to gain.
  const bool late = points_ >= 2 * looked_;
  if (violation > Optimality::kFeasible || !(cost <= look_below_ || late)) return false;
  looked_ = points_;
  const double allowed = gap_ * std::max(std::abs(cost), kSmallestCost);
  const double above = view_->constrained() ? check_->Above(*view_, y, &storage_) : Promised(y);
  if (above <= allowed) return true;
  // Without a bound the cost has to fall by the allowed gap.
  const double fall = std::isfinite(above) ? kFallen * (above - allowed) : allowed;
  look_below_ = std::min(cost - fall, std::nextafter(cost, -Problem::kInfinity));
  return false;
}

/// By a Newton step; infinite where the cost does not curve upwards.
double GapRule::Promised(const Eigen::VectorXd& y) {
  if (!view_->Evaluate(y.data(), {.gradient = true, .hessian = true}, {}, &storage_)) {
    return Problem::kInfinity;
  }
  if (factor_.Factor(storage_.hessian) != BorderedCholesky::Status::kDefinite)
    return Problem::kInfinity;
  return NewtonStep(*view_, y.data(), storage_.gradient.data(), factor_, step_.data());
}

}  // namespace touchdown::solvers
