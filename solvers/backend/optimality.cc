// SPDX-License-Identifier: BSD-3-Clause
// The KKT conditions at one point. Each variable is divided by its own size, 1 + |y_i|. The
// Lagrangian's Hessian measures what a residual of its gradient is worth. With a backend's
// multipliers this Hessian leaves out the rows' weights: a metric with large weights is blind to
// slopes across the rows. Multipliers are estimated as the least squares of the residual over the
// rows at their bounds, without those of the wrong sign. No residual is then left across the rows
// that are kept, so weights may hold them. Shifts are relative to the diagonal, variable by
// variable: a stiff variable must not hide a soft one. (J. Nocedal, S. Wright, Numerical
// Optimization, 2nd ed., chapters 12 and 18).

#include "touchdown/solvers/backend/optimality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "touchdown/solvers/backend/newton_step.h"

namespace touchdown::solvers {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAtBound = 1e-5;                      // way of a row to its bound, along its slope
constexpr double kRemoteProbe[] = {1e-5, 1e-3, 1e-1};  // the same, far from the optimum
constexpr double kRowWeight = 1e7;  // beside the curvature, of rows that are to be kept
constexpr int kRefinements = 4;
constexpr double kLeastCurvature = 1e-8;  // of a cost's slope
constexpr double kBoundRounding = 1e-12;
constexpr double kLeastCost = 0.1;
constexpr double kLastShift = 1e6;
// Steps onto the rows.
constexpr double kNudges[] = {0.0, 1e-2, -2e-2};  // of the sizes: from where the last ones ended
constexpr int kMostRowSteps = 40;                 // at a double root they halve the way
constexpr double kReaches[] = {1.0, 0.1, 0.01};  // shares of a step
constexpr double kCloser = 0.1;                  // share of it by which the squares fall at least

}  // namespace

void OptimalityCheck::Prepare(const View& view) {
  const auto n = static_cast<std::size_t>(view.num_variables());
  rows_.Prepare(view, true);
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  across_.Prepare(shape);
  for (auto* vector : {&size_, &diagonal_, &gradient_, &residual_, &step_, &way_, &soft_, &near_,
                       &slope_, &sink_, &soft_share_}) {
    vector->assign(n, 0.0);
  }
  order_.assign(n, 0);
  foot_.resize(view.num_variables());
  ConstraintRows::Size(view, &by_term_);
  ConstraintRows::Size(view, &weights_by_term_);
  row_weights_.assign(by_term_.size(), {});
  multipliers_.clear();
  for (const std::vector<double>& of_term : by_term_) multipliers_.push_back(of_term.data());
  std::size_t rows = 0;
  for (const std::vector<double>& of_term : by_term_) rows += of_term.size();
  rows += n;
  for (auto* vector : {&u_, &u_near_, &off_, &norm_, &lambda_, &weight_}) vector->reserve(rows);
  side_.reserve(rows);
  jacobian_.reserve(static_cast<std::size_t>(rows_.most_nonzeros()));
}

Optimality OptimalityCheck::Look(const View& view, const Eigen::VectorXd& y,
                                 const SolverResult& told, double first_cost,
                                 const MustStop& must_stop, ViewEvaluation* storage) {
  first_cost_ = first_cost;
  Optimality found;
  if (Begin(view, y, must_stop, storage)) {
    TakeMultipliers(told);
    found = Weigh();
    const double shift = shift_;
    if (rows_.size() > 0 && !(shift <= kFirstShift && found.stationary()) && Estimate()) {
      const Optimality estimated = Weigh();
      const auto rank = [](const Optimality& at, double of_shift) {
        return std::tuple(!at.stationary(), of_shift, at.left + at.gap_left);
      };
      if (rank(estimated, shift_) <= rank(found, shift)) {
        found = estimated;
      } else {
        TakeMultipliers(told);
        found = Weigh();
      }
    }
    if (found.feasible() && found.stationary()) LookAround(&found);
  }
  found.evaluations = evaluations_;
  return found;
}

double OptimalityCheck::Above(const View& view, const Eigen::VectorXd& y, ViewEvaluation* storage) {
  static const MustStop kNever;
  first_cost_ = 0.0;
  if (!Begin(view, y, kNever, storage)) return kInfinity;
  TakeMultipliers(SolverResult());
  double least = kInfinity;
  const auto weigh = [&] {
    if (Weigh().evaluated && shift_ <= kFirstShift) least = std::min(least, left_);
  };
  weigh();
  // Rows that push may be as far off their bounds as the point is off the optimum. Several
  // distances are tried to find these rows.
  for (const double reach : kRemoteProbe) {
    if (rows_.size() == 0) break;
    at_bound_ = reach;
    if (!Estimate()) continue;
    // A row that may be left is not held: with its multiplier it is in the Lagrangian.
    for (Side& side : side_) side = side == Side::kBoth ? side : Side::kNone;
    weigh();
  }
  return least;
}

bool OptimalityCheck::Begin(const View& view, const Eigen::VectorXd& y, const MustStop& must_stop,
                            ViewEvaluation* storage) {
  view_ = &view;
  y_ = &y;
  must_stop_ = &must_stop;
  at_ = storage;
  evaluations_ = 0;
  at_bound_ = kAtBound;
  if (!Evaluate(y.data(), {.gradient = true}, {})) return false;
  for (std::size_t i = 0; i < size_.size(); ++i) {
    size_[i] = 1.0 + std::abs(y[static_cast<Eigen::Index>(i)]);
    gradient_[i] = size_[i] * at_->gradient[i];
  }
  rows_.Set(view, *at_);
  const auto m = static_cast<std::size_t>(rows_.size());
  for (auto* vector : {&u_, &u_near_, &off_, &norm_, &lambda_, &weight_}) vector->assign(m, 0.0);
  jacobian_.assign(static_cast<std::size_t>(rows_.nonzeros()), 0.0);
  rows_.Values(*at_, u_.data());
  rows_.Jacobian(*at_, jacobian_.data());
  for (int r = 0; r < rows_.size(); ++r) {
    double sum = 0.0;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      jacobian_[k] *= size_[rows_.column(k)];
      sum += jacobian_[k] * jacobian_[k];
    }
    norm_[r] = std::sqrt(sum);
  }
  side_.assign(m, Side::kNone);
  curvature_ = 1.0;
  return true;
}

bool OptimalityCheck::Evaluate(const double* y, Want want, const Lagrangian& lagrangian) {
  if (*must_stop_ && (*must_stop_)()) return false;
  ++evaluations_;
  return view_->Evaluate(y, want, lagrangian, at_);
}

/// Multipliers that are not told, or that no bound can have, are 0.
void OptimalityCheck::TakeMultipliers(const SolverResult& told) {
  std::fill(side_.begin(), side_.end(), Side::kNone);
  if (!rows_.Gather(told.multipliers, lambda_.data())) {
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
  }
  for (int r = rows_.first_bound(); r < rows_.size() && !told.bound_multipliers.empty(); ++r) {
    lambda_[r] = told.bound_multipliers[rows_.column(rows_.start(r))];
  }
  for (int r = 0; r < rows_.size(); ++r) {
    const bool fixed = r >= rows_.first_bound() && rows_.lo(r) == rows_.hi(r);
    if (fixed || !std::isfinite(lambda_[r]) || !std::isfinite(WayTo(r, lambda_[r]))) {
      lambda_[r] = 0.0;
    }
  }
  // A fixed variable is none to many backends: its multiplier is what is left there.
  Residual(lambda_.data());
  for (int r = rows_.first_bound(); r < rows_.size(); ++r) {
    if (rows_.lo(r) == rows_.hi(r))
      lambda_[r] = -residual_[rows_.column(rows_.start(r))] / norm_[r];
  }
}

/// From a row to the bound that a multiplier of this sign belongs to.
double OptimalityCheck::WayTo(int row, double multiplier) const {
  return multiplier == 0.0 ? 0.0
                           : std::abs(u_[row] - (multiplier > 0.0 ? rows_.hi(row) : rows_.lo(row)));
}

/// How far the value u of a row is beyond its upper bound or, negative, its lower one; 0 where that
/// is rounding.
double OptimalityCheck::Beyond(int row, double u) const {
  const double bound = u > rows_.hi(row) ? rows_.hi(row) : rows_.lo(row);
  const bool between = u >= rows_.lo(row) && u <= rows_.hi(row);
  return between || std::abs(u - bound) <= kBoundRounding * std::abs(bound) ? 0.0 : u - bound;
}

/// Of the worst of rows of these values, by the slopes at y.
double OptimalityCheck::Violation(const std::vector<double>& u) const {
  double worst = rows_.constant_violation() > Optimality::kFeasible ? kInfinity : 0.0;
  for (int r = 0; r < rows_.size(); ++r) worst = std::max(worst, Violation(r, u[r]));
  return worst;
}

/// Over all of them, the sum of squares.
double OptimalityCheck::SquaredViolation(const std::vector<double>& u) const {
  double sum = rows_.constant_violation() > Optimality::kFeasible ? kInfinity : 0.0;
  for (int r = 0; r < rows_.size(); ++r) sum += Violation(r, u[r]) * Violation(r, u[r]);
  return sum;
}

double OptimalityCheck::Violation(int row, double u) const {
  const double beyond = std::abs(Beyond(row, u));
  return beyond > 0.0 ? beyond / norm_[row] : 0.0;
}

/// The nearer one, where it is near.
OptimalityCheck::Side OptimalityCheck::SideOf(int row) const {
  if (rows_.lo(row) == rows_.hi(row)) return Side::kBoth;
  const double to_upper = rows_.hi(row) - u_[row], to_lower = u_[row] - rows_.lo(row);
  if (std::min(to_upper, to_lower) > at_bound_ * norm_[row]) return Side::kNone;
  return to_upper <= to_lower ? Side::kUpper : Side::kLower;
}

/// Rows that are not kept weigh nothing.
void OptimalityCheck::WeighRows(Kept kept) {
  for (int r = 0; r < rows_.size(); ++r) {
    const Side side = kept == Kept::kHeld ? side_[r] : SideOf(r);
    const bool holds = side != Side::kNone && norm_[r] > 0.0;
    weight_[r] = holds ? kRowWeight * curvature_ / (norm_[r] * norm_[r]) : 0.0;
  }
}

/// curvature I + J^T weight J.
bool OptimalityCheck::FactorRows() {
  return EvaluateHessian(nullptr, weight_.data(), 0.0) &&
         factor_.Factor(at_->hessian, curvature_, curvature_) ==
             BorderedCholesky::Status::kDefinite;
}

/// step_ = the shortest way onto the rows that weigh, which are off_ by so much.
void OptimalityCheck::ShortestStep() {
  std::fill(step_.begin(), step_.end(), 0.0);
  for (int r = 0; r < rows_.size(); ++r) {
    if (weight_[r] == 0.0) continue;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      step_[rows_.column(k)] -= weight_[r] * jacobian_[k] * off_[r];
    }
  }
  factor_.Solve(step_.data());
}

OptimalityCheck::Foot OptimalityCheck::StepOntoRows(const View& view, const Eigen::VectorXd& y,
                                                    const MustStop& must_stop,
                                                    ViewEvaluation* storage) {
  foot_ = y;
  bool least = false;
  // Where slopes vanish no step leads on. Beside such a point they do not.
  for (const double beside : kNudges) {
    for (double& x : foot_) x += beside * (1.0 + std::abs(x));
    view.MoveIntoBounds(foot_.data());
    for (int i = 0; i < kMostRowSteps && Begin(view, foot_, must_stop, storage); ++i) {
      if (Violation(u_) <= Optimality::kFeasible) return Foot::kMeets;
      if (rows_.constant_violation() > Optimality::kFeasible) return Foot::kLeast;
      if (!StepsCloser(&least)) break;
      std::copy(near_.begin(), near_.end(), foot_.data());
    }
  }
  return least ? Foot::kLeast : Foot::kUnknown;
}

/// near_ = a step from y that meets the rows better, or a part of it. `least` is set where even the shortest does not.
bool OptimalityCheck::StepsCloser(bool* least) {
  const double before = SquaredViolation(u_);
  for (int r = 0; r < rows_.size(); ++r) off_[r] = Beyond(r, u_[r]);
  WeighRows(Kept::kAtBounds);
  ReleaseBounds();
  if (!std::isfinite(before) || !FactorRows()) return false;
  ShortestStep();
  bool seen = false;
  for (const double reach : kReaches) {
    MoveAway(reach, step_);
    view_->MoveIntoBounds(near_.data());
    seen = Evaluate(near_.data(), {}, {});
    if (!seen) continue;
    rows_.Values(*at_, u_near_.data());
    if (SquaredViolation(u_near_) <= (1.0 - kCloser * reach) * before) return true;
  }
  *least = *least || seen;
  return false;
}

/// Bounds of variables that meet the rows better within them do not weigh.
void OptimalityCheck::ReleaseBounds() {
  std::fill(step_.begin(), step_.end(), 0.0);  // down the slope of what rows are off
  for (int r = 0; r < rows_.first_bound(); ++r) {
    if (weight_[r] == 0.0) continue;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      step_[rows_.column(k)] -= weight_[r] * jacobian_[k] * off_[r];
    }
  }
  for (int r = rows_.first_bound(); r < rows_.size(); ++r) {
    const double way = step_[rows_.column(rows_.start(r))];
    const Side side = SideOf(r);
    if ((side == Side::kLower && way > 0.0) || (side == Side::kUpper && way < 0.0))
      weight_[r] = 0.0;
  }
}

/// near_ = y + share x way, which is in variables over their sizes.
void OptimalityCheck::MoveAway(double share, const std::vector<double>& way) {
  for (std::size_t i = 0; i < near_.size(); ++i) {
    near_[i] = (*y_)[static_cast<Eigen::Index>(i)] + share * size_[i] * way[i];
  }
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
  if (!Evaluate(y_->data(), {.gradient = true, .hessian = true}, lagrangian)) return false;
  for (int r = rows_.first_bound(); r < rows_.size() && weights; ++r) {
    at_->hessian.Diagonal(rows_.column(rows_.start(r))) += weights[r];
  }
  at_->hessian.Scale(size_.data());
  return true;
}

/// residual_ = grad f + J^T lambda.
void OptimalityCheck::Residual(const double* lambda) {
  residual_ = gradient_;
  for (int r = 0; r < rows_.size(); ++r) {
    if (lambda[r] == 0.0) continue;
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      residual_[rows_.column(k)] += lambda[r] * jacobian_[k];
    }
  }
}

bool OptimalityCheck::Estimate() {
  for (int r = 0; r < rows_.size(); ++r) side_[r] = SideOf(r);
  for (int dropped = 0; dropped <= rows_.size(); ++dropped) {
    WeighRows(Kept::kHeld);
    if (!FactorRows()) return false;
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
    // The worst of them, and those that are nearly as bad.
    const auto wrong = [this](int r) {
      if (side_[r] == Side::kNone || side_[r] == Side::kBoth) return 0.0;
      return -(side_[r] == Side::kUpper ? 1.0 : -1.0) * lambda_[r] * norm_[r];
    };
    double worst = kBoundRounding * Largest(gradient_);
    for (int r = 0; r < rows_.size(); ++r) worst = std::max(worst, wrong(r));
    bool any = false;
    for (int r = 0; r < rows_.size(); ++r) {
      if (wrong(r) <= 0.5 * worst) continue;
      side_[r] = Side::kNone;
      any = true;
    }
    if (any) continue;
    for (int r = 0; r < rows_.size(); ++r) {
      if (wrong(r) > 0.0) lambda_[r] = 0.0;  // rounding
    }
    return true;
  }
  return true;
}

/// The Lagrangian's Hessian with the rows of side_ held by weights.
bool OptimalityCheck::HoldRows() {
  WeighRows(Kept::kHeld);
  return EvaluateHessian(lambda_.data(), weight_.data(), 1.0);
}

/// With the rows of side_ held, which are none for a backend's multipliers.
Optimality OptimalityCheck::Weigh() {
  Optimality out;
  out.violation = Violation(u_);
  shift_ = kInfinity;
  if (!EvaluateHessian(rows_.size() > 0 ? lambda_.data() : nullptr, nullptr, 1.0)) return {};
  out.evaluated = true;
  Residual(lambda_.data());
  // Of the rows together: multipliers of a pinched pair may be large, and cancel.
  double slope = Largest(gradient_), gap = 0.0;
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    slope = std::max(slope, std::abs(residual_[i] - gradient_[i]));
  }
  for (int r = 0; r < rows_.size(); ++r) gap += std::abs(lambda_[r]) * WayTo(r, lambda_[r]);
  cost_ = at_->full.value;
  cost_size_ = std::max({std::abs(first_cost_ - cost_), slope, std::numeric_limits<double>::min()});
  const double least = kLeastCurvature * slope + std::numeric_limits<double>::min();
  curvature_ = std::max(LargestElement(at_->hessian), least);
  step_ = residual_;
  const bool holds =
      std::any_of(side_.begin(), side_.end(), [](Side s) { return s != Side::kNone; });
  out.step = out.gain = out.left = kInfinity;  // until it is known
  if (holds && !HoldRows()) return out;
  for (std::size_t i = 0; i < step_.size(); ++i)
    at_->hessian.Diagonal(static_cast<int>(i)) += least;
  if (!FactorShifted()) return out;
  factor_.Solve(step_.data());
  double promised = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) promised += 0.5 * residual_[i] * step_[i];
  out.step = Largest(step_);
  out.gain = promised / cost_size_;
  out.left = promised / CostValue();
  out.gap = gap / cost_size_;
  out.gap_left = gap / CostValue();
  left_ = promised + gap;
  return out;
}

/// Of the Hessian just evaluated.
void OptimalityCheck::MeasureDiagonal() {
  at_->hessian.LargestInRows(diagonal_.data());
  const double largest = Largest(diagonal_);
  const double least = largest > 0.0 ? kFirstShift * largest : 1.0;
  for (double& element : diagonal_) element = std::max(element, least);
}

double OptimalityCheck::CostValue() const { return std::max(std::abs(cost_), kLeastCost); }

/// Factors the Hessian with the first shift, a share of the diagonal, that makes it definite. Past
/// the first one the metric says little of the softest directions.
bool OptimalityCheck::FactorShifted() {
  MeasureDiagonal();
  double taken = 0.0;
  for (double share = kFirstShift; share <= kLastShift; share *= kShiftGrowth) {
    Shift(share - taken);
    taken = share;
    if (factor_.Factor(at_->hessian) != BorderedCholesky::Status::kDefinite) continue;
    shift_ = share;
    return true;
  }
  return false;
}

void OptimalityCheck::Shift(double share) {
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    at_->hessian.Diagonal(static_cast<int>(i)) += share * diagonal_[i];
  }
}

}  // namespace touchdown::solvers
