// SPDX-License-Identifier: BSD-3-Clause
// The KKT conditions at one point. What a residual of the Lagrangian's gradient is worth is told by its Hessian,
// for a backend's multipliers without the rows' weights: a metric with large weights is blind to what lies across the rows. Multipliers
// are estimated as the least squares of that residual over the rows at their bounds, without those of the wrong sign: across
// the rows that are kept nothing is left then, and weights hold them.
// (J. Nocedal, S. Wright, Numerical Optimization, 2nd ed., chapters 12 and 18).

#include "touchdown/solvers/optimality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "touchdown/solvers/newton_step.h"

namespace touchdown::solvers {

namespace {

constexpr double kAtBound = 1e-5;   // way of a row to its bound, share of the point's size
constexpr double kRowWeight = 1e8;  // beside the identity, of rows that are to be kept
constexpr int kRefinements = 3;
constexpr double kLeastCurvature = 1e-8;  // of a cost's slope over the point's size
constexpr double kFirstShift = 1e-6;      // of the largest element
constexpr double kShiftGrowth = 10.0;
constexpr int kMostShifts = 16;
constexpr double kRounding = 1e-12;

double LargestOf(const BorderedBandMatrix& H) {
  const int d = H.block_size();
  double largest = H.bordered() ? std::abs(H.corner()) : 0.0;
  for (int i = 0; i < H.blocks(); ++i) {
    const int last = std::min(H.half_bandwidth(), H.blocks() - 1 - i);
    const double* block = H.block(i, 0);
    for (int k = 0; k < (last + 1) * d * d; ++k) largest = std::max(largest, std::abs(block[k]));
  }
  return largest;
}

}  // namespace

void OptimalityCheck::Prepare(const View& view) {
  const auto n = static_cast<std::size_t>(view.num_variables());
  rows_.Prepare(view);
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  has_factor_ = BorderedCholesky::Takes(shape);
  if (has_factor_) factor_.Prepare(shape);
  for (auto* vector : {&gradient_, &residual_, &step_}) vector->assign(n, 0.0);
  ConstraintRows::Size(view, &by_term_);
  ConstraintRows::Size(view, &weights_by_term_);
  row_weights_.assign(by_term_.size(), {});
  std::size_t rows = 0;
  for (const std::vector<double>& of_term : by_term_) rows += of_term.size();
  for (auto* vector : {&u_, &norm_, &lambda_, &weight_}) vector->reserve(rows);
  side_.reserve(rows);
  jacobian_.reserve(static_cast<std::size_t>(rows_.most_nonzeros()));
}

Optimality OptimalityCheck::Look(const View& view, const Eigen::VectorXd& y,
                                 const std::vector<std::vector<double>>& multipliers,
                                 double first_cost, ViewEvaluation* storage) {
  view_ = &view;
  y_ = &y;
  at_ = storage;
  first_cost_ = first_cost;
  size_ = 1.0 + y.lpNorm<Eigen::Infinity>();
  if (!view.Evaluate(y.data(), {.gradient = true}, {}, at_)) return {};
  gradient_ = at_->gradient;
  rows_.Set(view, *at_);
  const auto m = static_cast<std::size_t>(rows_.size());
  for (auto* vector : {&u_, &norm_, &lambda_, &weight_}) vector->assign(m, 0.0);
  jacobian_.assign(static_cast<std::size_t>(rows_.nonzeros()), 0.0);
  rows_.Values(*at_, u_.data());
  rows_.Jacobian(*at_, jacobian_.data());
  for (int r = 0; r < rows_.size(); ++r) {
    double sum = 0.0;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) sum += jacobian_[k] * jacobian_[k];
    norm_[r] = std::sqrt(sum);
  }
  if (m == 0) return Weigh();
  Optimality told;
  side_.assign(m, Side::kNone);
  if (TakeMultipliers(multipliers)) told = Weigh();
  if (told.stationary() || !Estimate()) return told;
  const Optimality estimated = Weigh();
  return told.evaluated && told.gain + told.gap < estimated.gain + estimated.gap ? told : estimated;
}

/// Multipliers that no bound can have are none.
bool OptimalityCheck::TakeMultipliers(const std::vector<std::vector<double>>& multipliers) {
  if (multipliers.empty() || !rows_.Gather(multipliers, lambda_.data())) return false;
  for (int r = 0; r < rows_.size(); ++r) {
    if (!std::isfinite(lambda_[r])) return false;
    if (!std::isfinite(WayTo(r, lambda_[r]))) lambda_[r] = 0.0;
  }
  return true;
}

/// From a row to the bound that a multiplier of this sign belongs to.
double OptimalityCheck::WayTo(int row, double multiplier) const {
  return multiplier == 0.0 ? 0.0
                           : std::abs(u_[row] - (multiplier > 0.0 ? rows_.hi(row) : rows_.lo(row)));
}

double OptimalityCheck::Violation() const {
  double worst = 0.0;
  for (int r = 0; r < rows_.size(); ++r) {
    const double beyond = std::max(rows_.lo(r) - u_[r], u_[r] - rows_.hi(r));
    const double bound = u_[r] > rows_.hi(r) ? rows_.hi(r) : rows_.lo(r);
    if (beyond <= kRounding * std::abs(bound)) continue;
    worst = std::max(worst, beyond / (norm_[r] * size_));
  }
  const bool constant = rows_.constant_violation() > Optimality::kFeasible;
  return constant ? std::numeric_limits<double>::infinity() : worst;
}

OptimalityCheck::Side OptimalityCheck::SideOf(int row) const {
  if (rows_.lo(row) == rows_.hi(row)) return Side::kBoth;
  const double near = kAtBound * norm_[row] * size_;
  if (u_[row] >= rows_.hi(row) - near) return Side::kUpper;
  return u_[row] <= rows_.lo(row) + near ? Side::kLower : Side::kNone;
}

/// H of cost_factor x cost + multipliers x rows, and weight x J^T J.
bool OptimalityCheck::EvaluateHessian(const double* multipliers, const double* weights,
                                      double cost_factor) {
  if (multipliers) rows_.Spread(multipliers, &by_term_);
  if (weights) rows_.Spread(weights, &weights_by_term_);
  for (std::size_t i = 0; i < row_weights_.size(); ++i) {
    row_weights_[i] = {multipliers ? by_term_[i].data() : nullptr,
                       weights ? weights_by_term_[i].data() : nullptr};
  }
  const Lagrangian lagrangian{.objective_factor = cost_factor, .rows = row_weights_.data()};
  return view_->Evaluate(y_->data(), {.gradient = true, .hessian = true}, lagrangian, at_);
}

/// residual_ = grad f + J^T lambda, but for what the bounds of a free interval take.
void OptimalityCheck::Residual(const double* lambda) {
  residual_ = gradient_;
  for (int r = 0; r < rows_.size(); ++r) {
    if (lambda[r] == 0.0) continue;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      residual_[rows_.column(k)] += lambda[r] * jacobian_[k];
    }
  }
  if (!view_->free_interval()) return;
  const ProblemShape& shape = view_->problem().shape();
  const double h = (*y_)[y_->size() - 1], near = Optimality::kFeasible * h;
  double& last = residual_.back();
  if (h <= shape.interval_min + near) last = std::min(last, 0.0);
  if (h >= shape.interval_max - near) last = std::max(last, 0.0);
}

bool OptimalityCheck::Estimate() {
  if (!has_factor_) return false;
  for (int r = 0; r < rows_.size(); ++r) side_[r] = SideOf(r);
  for (int dropped = 0; dropped <= rows_.size(); ++dropped) {
    for (int r = 0; r < rows_.size(); ++r) {
      const bool kept = side_[r] != Side::kNone && norm_[r] > 0.0;
      weight_[r] = kept ? kRowWeight / (norm_[r] * norm_[r]) : 0.0;
    }
    if (!EvaluateHessian(nullptr, weight_.data(), 0.0)) return false;
    if (factor_.Factor(at_->hessian, 1.0, 1.0) != BorderedCholesky::Status::kDefinite) return false;
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    for (int i = 0; i < kRefinements; ++i) {
      Residual(lambda_.data());
      factor_.Solve(residual_.data());  // -d
      for (int r = 0; r < rows_.size(); ++r) {
        for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
          lambda_[r] -= weight_[r] * jacobian_[k] * residual_[rows_.column(k)];
        }
      }
    }
    int worst = -1;
    double most = 0.0;
    for (int r = 0; r < rows_.size(); ++r) {
      if (side_[r] == Side::kNone || side_[r] == Side::kBoth) continue;
      const double wrong = -(side_[r] == Side::kUpper ? 1.0 : -1.0) * lambda_[r] * norm_[r];
      if (wrong <= most) continue;
      most = wrong;
      worst = r;
    }
    if (worst < 0) return true;
    side_[worst] = Side::kNone;
  }
  return true;
}

/// The Lagrangian's Hessian with the rows of side_ held by weights.
bool OptimalityCheck::HoldRows(double curvature) {
  for (int r = 0; r < rows_.size(); ++r) {
    const bool kept = side_[r] != Side::kNone && norm_[r] > 0.0;
    weight_[r] = kept ? kRowWeight * curvature / (norm_[r] * norm_[r]) : 0.0;
  }
  return EvaluateHessian(lambda_.data(), weight_.data(), 1.0);
}

/// Factors the Hessian, made definite where it is not.
bool OptimalityCheck::Factor(double shift, double largest, bool* shifted) {
  *shifted = false;
  for (int i = 0; i < kMostShifts; ++i) {
    if (factor_.Factor(at_->hessian, shift, shift) == BorderedCholesky::Status::kDefinite) {
      return true;
    }
    *shifted = true;
    shift = std::max(kShiftGrowth * shift, kFirstShift * largest);
  }
  return false;
}

/// With the rows of side_ held, which are none for a backend's multipliers.
Optimality OptimalityCheck::Weigh() {
  Optimality out;
  out.violation = Violation();
  if (!EvaluateHessian(rows_.size() > 0 ? lambda_.data() : nullptr, nullptr, 1.0)) return {};
  out.evaluated = true;
  const double largest = LargestOf(at_->hessian);
  Residual(lambda_.data());
  // Of the rows together: multipliers of a pinched pair may be large, and cancel.
  double slope = Largest(gradient_), gap = 0.0;
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    slope = std::max(slope, std::abs(residual_[i] - gradient_[i]));
  }
  for (int r = 0; r < rows_.size(); ++r) gap += std::abs(lambda_[r]) * WayTo(r, lambda_[r]);
  const double gained = std::abs(first_cost_ - at_->full.value);
  const double cost_size = std::max({gained, slope * size_, std::numeric_limits<double>::min()});
  const double least = kLeastCurvature * slope / size_ + std::numeric_limits<double>::min();
  bool shifted = false;
  step_ = residual_;
  if (has_factor_) {
    const bool holds = std::any_of(side_.begin(), side_.end(), [](Side s) { return s != Side::kNone; });
    if (holds && !HoldRows(std::max(largest, least))) return {};
    if (!Factor(least, largest, &shifted)) return {};
    factor_.Solve(step_.data());
  } else {
    const BorderedBandMatrix& H = at_->hessian;
    for (int i = 0; i < static_cast<int>(step_.size()); ++i) {
      step_[i] /= std::abs(H.At(i, i)) + least;
    }
  }
  double promised = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) promised += 0.5 * residual_[i] * step_[i];
  out.step = Largest(step_) / size_;
  out.gain = promised / cost_size;
  out.gap = gap / cost_size;
  out.saddle = shifted && CurvesDown(largest);
  return out;
}

/// The Hessian is indefinite along all rows at a bound, too, whose weights hold everything across them.
bool OptimalityCheck::CurvesDown(double largest) {
  for (int r = 0; r < rows_.size(); ++r) side_[r] = SideOf(r);
  if (rows_.size() > 0 && !HoldRows(largest)) return false;
  const double room = kFirstShift * largest;
  return factor_.Factor(at_->hessian, room, room) != BorderedCholesky::Status::kDefinite;
}

}  // namespace touchdown::solvers
