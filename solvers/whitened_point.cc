// SPDX-License-Identifier: BSD-3-Clause
// Whitened evaluation. The first point keeps the caller's own y, and a point that is asked for again
// is not transformed again: the evaluator recognises repeated points by their bits.

#include "touchdown/solvers/whitened_point.h"

#include <algorithm>
#include <cstring>

namespace touchdown::solvers {

void WhitenedPoint::Prepare(const View& view) {
  whitening_.Prepare(view);
  view.Resize(&metric_);
  z_.assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  y_ = z_;
  best_.resize(view.num_variables());
}

bool WhitenedPoint::Begin(const View& view, const double* y, bool whiten, Evaluator* evaluator) {
  evaluator_ = evaluator;
  whiten_ = whiten;
  free_interval_ = view.free_interval();
  interval_min_ = view.problem().shape().interval_min;
  interval_max_ = view.problem().shape().interval_max;
  std::copy(y, y + y_.size(), y_.begin());
  z_ = y_;
  if (!evaluator->Evaluate(y, {.gradient = true})) return false;
  best_ = evaluator->best();
  best_cost_ = evaluator->best_cost();
  best_violation_ = evaluator->best_violation();
  if (!whiten) return true;
  const ShareScope scope(evaluator, Share::kWhitening);
  if (!whitening_.Set(view, y, &metric_)) return false;
  whiten_ = whitening_.regular();
  if (whiten_) whitening_.ToWhite(y, z_.data());
  return true;
}

void WhitenedPoint::MoveTo(const double* z) {
  if (std::memcmp(z, z_.data(), z_.size() * sizeof(double)) == 0) return;
  std::copy(z, z + z_.size(), z_.begin());
  if (whiten_) {
    const ShareScope scope(evaluator_, Share::kWhitening);
    whitening_.FromWhite(z, y_.data());
  } else {
    y_ = z_;
  }
  // Bounds were kept in z; dividing by the scale may have lost the last bit, and Ipopt relaxes them.
  if (free_interval_) y_.back() = std::clamp(y_.back(), interval_min_, interval_max_);
}

bool WhitenedPoint::Evaluate(const double* z, bool gradient) {
  MoveTo(z);
  return evaluator_->Evaluate(y_.data(), {.gradient = gradient});
}

bool WhitenedPoint::EvaluateLagrangian(const double* z, const Lagrangian& lagrangian) {
  MoveTo(z);
  return evaluator_->EvaluateLagrangian(y_.data(), lagrangian);
}

void WhitenedPoint::Gradient(double* out) const {
  std::copy(last().gradient.begin(), last().gradient.end(), out);
  RowToWhite(out);
}

void WhitenedPoint::RowToWhite(double* row) const {
  if (!whiten_) return;
  const ShareScope scope(evaluator_, Share::kWhitening);
  whitening_.GradientToWhite(row);
}

bool WhitenedPoint::Improved(double* step) {
  if (evaluator_->best_cost() == best_cost_ && evaluator_->best_violation() == best_violation_) {
    return false;
  }
  best_cost_ = evaluator_->best_cost();
  best_violation_ = evaluator_->best_violation();
  *step = (evaluator_->best() - best_).norm();
  best_ = evaluator_->best();
  return true;
}

}  // namespace touchdown::solvers
