// SPDX-License-Identifier: BSD-3-Clause
// Whitened evaluation. The first point keeps the caller's own y. A point that is asked for again is
// not transformed again, because the evaluator recognises repeated points by their bits.
//
// A free interval h in [lo, hi], of scale s in z, can be replaced by an angle:
//   s h = s mid + s half sin(z_n / c),   c = s half cos(angle at the start).
// Its slope is 1 at the start, and each bound is a stationary point. So an active bound is found
// like any other minimum (as in F. James, M. Roos, "Minuit", Comput. Phys. Commun. 10 (1975) 343).
// A start at a bound is moved slightly inside: its slope would vanish.

#include "solvers/backend/whitened_point.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace touchdown::solvers {

namespace {

constexpr double kNearestAngle = 1e-3;  // to a bound, at the start [rad]

}  // namespace

void WhitenedPoint::Prepare(const View& view) {
  whitening_.Prepare(view);
  view.Resize(&metric_);
  z_.assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  y_ = plain_ = z_;
  best_.resize(view.num_variables());
}

bool WhitenedPoint::Begin(const View& view, const double* y, const Settings& settings,
                          Evaluator* evaluator) {
  view_ = &view;
  evaluator_ = evaluator;
  whiten_ = settings.whiten && !view.bounded();
  angle_ = settings.interval_as_angle && view.free_interval();
  slope_ = 1.0;
  std::copy(y, y + y_.size(), y_.begin());
  z_ = y_;
  if (!evaluator->Evaluate(y, {.gradient = true})) return false;
  best_ = evaluator->best();
  best_cost_ = evaluator->best_cost();
  best_violation_ = evaluator->best_violation();
  if (whiten_) {
    const ShareScope scope(evaluator, Share::kWhitening);
    if (!whitening_.Set(view, y, &metric_)) return false;
    whiten_ = whitening_.regular();
    if (whiten_) whitening_.ToWhite(y, z_.data());
  }
  if (angle_) StartAngle();
  return true;
}

void WhitenedPoint::RenewMetric(const View& view, const double* z) {
  MoveTo(z);
  const ShareScope scope(evaluator_, Share::kWhitening);
  if (!whitening_.Set(view, y_.data(), &metric_)) return;
  whitening_.ToWhite(y_.data(), z_.data());
  if (angle_) StartAngle();
}

void WhitenedPoint::StartAngle() {
  const double least = view_->lower(size() - 1), most_h = view_->upper(size() - 1);
  middle_ = 0.5 * interval_scale() * (most_h + least);
  half_ = 0.5 * interval_scale() * (most_h - least);
  double angle = 0.0;
  unit_ = 1.0;
  if (half_ > 0.0) {
    const double most = 0.5 * M_PI - kNearestAngle;
    const double sine = std::clamp((z_.back() - middle_) / half_, -1.0, 1.0);
    angle = std::clamp(std::asin(sine), -most, most);
    unit_ = half_ * std::cos(angle);
  }
  z_.back() = angle * unit_;
  slope_ = half_ * std::cos(angle) / unit_;
}

void WhitenedPoint::MoveTo(const double* z) {
  if (std::memcmp(z, z_.data(), z_.size() * sizeof(double)) == 0) return;
  std::copy(z, z + z_.size(), z_.begin());
  plain_ = z_;
  if (angle_) {
    const double angle = z_.back() / unit_;
    plain_.back() = middle_ + half_ * std::sin(angle);
    slope_ = half_ * std::cos(angle) / unit_;
  }
  if (whiten_) {
    const ShareScope scope(evaluator_, Share::kWhitening);
    whitening_.FromWhite(plain_.data(), y_.data());
  } else {
    y_ = plain_;
  }
  // Bounds were kept in z. Division by the scale may have lost the last bit, and Ipopt relaxes
  // bounds.
  view_->MoveIntoBounds(y_.data());
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
  if (whiten_) {
    const ShareScope scope(evaluator_, Share::kWhitening);
    whitening_.GradientToWhite(row);
  }
  if (angle_) row[size() - 1] *= slope_;
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

bool WhitenedPoint::StationaryAtBest(double first_cost) {
  constexpr double kNegligible = 1e-8, kOfFirst = 1e-4;
  if (!whiten_ || !evaluator_->Evaluate(evaluator_->best().data(), {.gradient = true}))
    return false;
  std::copy(last().gradient.begin(), last().gradient.end(), plain_.begin());
  whitening_.GradientToWhite(plain_.data());
  if (view_->free_interval()) {
    const bool outwards = plain_.back() > 0.0 ? last().h <= view_->lower(size() - 1)
                                              : last().h >= view_->upper(size() - 1);
    if (outwards) plain_.back() = 0.0;
  }
  double sum = 0.0;
  for (const double g : plain_) sum += g * g;
  const double cost = std::max(std::abs(evaluator_->best_cost()), kOfFirst * std::abs(first_cost));
  return 0.5 * sum <= kNegligible * cost;
}

}  // namespace touchdown::solvers
