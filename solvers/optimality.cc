// SPDX-License-Identifier: BSD-3-Clause
// The KKT conditions at one point, in variables that are each over their own size, 1 + |y_i|. What a residual of the Lagrangian's gradient is worth is told by its Hessian,
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

constexpr double kAtBound = 1e-5;   // way of a row to its bound, along its slope
constexpr double kRowWeight = 1e8;  // beside the identity, of rows that are to be kept
constexpr int kRefinements = 3;
constexpr double kLeastCurvature = 1e-8;  // of a cost's slope
constexpr double kFirstShift = 1e-6;      // of the largest element
constexpr double kShiftGrowth = 10.0;
constexpr int kMostShifts = 16;
constexpr double kRounding = 1e-12;
constexpr double kLeastCost = 0.1;
// Of neighbours.
constexpr double kNeighbour = 1e-2;  // so far away
constexpr double kNearest = 1e-8;      // where the cost does not rise, down to this
constexpr double kClearlyLess = 1e-8;  // share of the cost, or of kLeastCost
constexpr double kClearlyMore = 10.0;  // than what the conditions leave
constexpr double kNeighbourViolation = 1e-10;
constexpr int kMostCorrections = 40;  // a row and its opposite go half the way each time
constexpr int kInverseIterations = 40;  // a shift may be ten times what it need be
constexpr int kFewInverseIterations = 5;
constexpr double kPushes = 1e-6;  // multiplier of a row, share of the slopes

}  // namespace

void OptimalityCheck::Prepare(const View& view) {
  const auto n = static_cast<std::size_t>(view.num_variables());
  rows_.Prepare(view, true);
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  for (auto* vector : {&size_, &gradient_, &residual_, &step_, &soft_, &near_}) vector->assign(n, 0.0);
  ConstraintRows::Size(view, &by_term_);
  ConstraintRows::Size(view, &weights_by_term_);
  row_weights_.assign(by_term_.size(), {});
  std::size_t rows = 0;
  for (const std::vector<double>& of_term : by_term_) rows += of_term.size();
  rows += n;
  for (auto* vector : {&u_, &u_near_, &norm_, &lambda_, &weight_}) vector->reserve(rows);
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
    if (rows_.size() > 0 && !found.stationary() && Estimate()) {
      const Optimality estimated = Weigh();
      if (estimated.left + estimated.gap_left < found.left + found.gap_left || !found.evaluated) {
        found = estimated;
      }
    }
    if (found.feasible() && found.stationary()) found.saddle = NeighbourCostsLess();
  }
  found.evaluations = evaluations_;
  return found;
}

bool OptimalityCheck::Begin(const View& view, const Eigen::VectorXd& y, const MustStop& must_stop,
                            ViewEvaluation* storage) {
  view_ = &view;
  y_ = &y;
  must_stop_ = &must_stop;
  at_ = storage;
  evaluations_ = 0;
  if (!Evaluate(y.data(), {.gradient = true}, {})) return false;
  for (std::size_t i = 0; i < size_.size(); ++i) {
    size_[i] = 1.0 + std::abs(y[static_cast<Eigen::Index>(i)]);
    gradient_[i] = size_[i] * at_->gradient[i];
  }
  rows_.Set(view, *at_);
  const auto m = static_cast<std::size_t>(rows_.size());
  for (auto* vector : {&u_, &u_near_, &norm_, &lambda_, &weight_}) vector->assign(m, 0.0);
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
  return true;
}

bool OptimalityCheck::Evaluate(const double* y, Want want, const Lagrangian& lagrangian) {
  if (*must_stop_ && (*must_stop_)()) return false;
  ++evaluations_;
  return view_->Evaluate(y, want, lagrangian, at_);
}

/// Multipliers that are not told, or that no bound can have, are 0.
void OptimalityCheck::TakeMultipliers(const SolverResult& told) {
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
    if (rows_.lo(r) == rows_.hi(r)) lambda_[r] = -residual_[rows_.column(rows_.start(r))] / norm_[r];
  }
}

/// From a row to the bound that a multiplier of this sign belongs to.
double OptimalityCheck::WayTo(int row, double multiplier) const {
  return multiplier == 0.0 ? 0.0
                           : std::abs(u_[row] - (multiplier > 0.0 ? rows_.hi(row) : rows_.lo(row)));
}

/// How far the value u of a row is beyond its upper bound or, negative, its lower one; 0 where that is rounding.
double OptimalityCheck::Beyond(int row, double u) const {
  const double bound = u > rows_.hi(row) ? rows_.hi(row) : rows_.lo(row);
  const bool between = u >= rows_.lo(row) && u <= rows_.hi(row);
  return between || std::abs(u - bound) <= kRounding * std::abs(bound) ? 0.0 : u - bound;
}

/// Of rows of these values, by the slopes at y.
double OptimalityCheck::Violation(const std::vector<double>& u) const {
  if (rows_.constant_violation() > Optimality::kFeasible) {
    return std::numeric_limits<double>::infinity();
  }
  double worst = 0.0;
  for (int r = 0; r < rows_.size(); ++r) {
    const double beyond = std::abs(Beyond(r, u[r]));
    if (beyond > 0.0) worst = std::max(worst, beyond / norm_[r]);
  }
  return worst;
}

/// The nearer one, where it is near.
OptimalityCheck::Side OptimalityCheck::SideOf(int row) const {
  if (rows_.lo(row) == rows_.hi(row)) return Side::kBoth;
  const double to_upper = rows_.hi(row) - u_[row], to_lower = u_[row] - rows_.lo(row);
  if (std::min(to_upper, to_lower) > kAtBound * norm_[row]) return Side::kNone;
  return to_upper <= to_lower ? Side::kUpper : Side::kLower;
}

/// A row of unit slope weighs this; those that are not kept, nothing.
template <class Keeps>
void OptimalityCheck::WeighRows(double weight, const Keeps& keeps) {
  for (int r = 0; r < rows_.size(); ++r) {
    weight_[r] = keeps(r) && norm_[r] > 0.0 ? weight / (norm_[r] * norm_[r]) : 0.0;
  }
}

/// I + J^T weight J.
bool OptimalityCheck::FactorRows() {
  return EvaluateHessian(nullptr, weight_.data(), 0.0) &&
         factor_.Factor(at_->hessian, 1.0, 1.0) == BorderedCholesky::Status::kDefinite;
}

/// step_ = the shortest way onto the rows that weigh, which are `off` by so much, by what FactorRows factored.
template <class Off>
void OptimalityCheck::StepOntoRows(const Off& off) {
  std::fill(step_.begin(), step_.end(), 0.0);
  for (int r = 0; r < rows_.size(); ++r) {
    if (weight_[r] == 0.0) continue;
    const double by = off(r);
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      step_[rows_.column(k)] -= weight_[r] * jacobian_[k] * by;
    }
  }
  factor_.Solve(step_.data());
}

bool OptimalityCheck::CanGetCloser(const View& view, const Eigen::VectorXd& y,
                                   const MustStop& must_stop, ViewEvaluation* storage) {
  if (!Begin(view, y, must_stop, storage) || !std::isfinite(Violation(u_))) return false;
  // The least squares of what rows are off, those at their bounds held.
  WeighRows(kRowWeight, [this](int r) { return SideOf(r) != Side::kNone; });
  if (!FactorRows()) return false;
  StepOntoRows([this](int r) { return Beyond(r, u_[r]); });
  double before = 0.0, after = 0.0;
  for (int r = 0; r < rows_.size(); ++r) {
    if (weight_[r] == 0.0) continue;
    double off = Beyond(r, u_[r]);
    before = std::max(before, std::abs(off) / norm_[r]);
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      off += jacobian_[k] * step_[rows_.column(k)];
    }
    after = std::max(after, std::abs(off) / norm_[r]);
  }
  return Largest(step_) <= 1.0 && after <= 0.5 * before;
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
    WeighRows(kRowWeight, [this](int r) { return side_[r] != Side::kNone; });
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
    // The worst of them, and those that are hardly better.
    const auto wrong = [this](int r) {
      if (side_[r] == Side::kNone || side_[r] == Side::kBoth) return 0.0;
      return -(side_[r] == Side::kUpper ? 1.0 : -1.0) * lambda_[r] * norm_[r];
    };
    double worst = kRounding * Largest(gradient_);
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
bool OptimalityCheck::HoldRows(double curvature) {
  WeighRows(kRowWeight * curvature, [this](int r) { return side_[r] != Side::kNone; });
  return EvaluateHessian(lambda_.data(), weight_.data(), 1.0);
}

/// Factors the Hessian, made definite where it is not.
bool OptimalityCheck::Factor(double shift, double largest) {
  for (int i = 0; i < kMostShifts; ++i) {
    if (factor_.Factor(at_->hessian, shift, shift) == BorderedCholesky::Status::kDefinite) {
      return true;
    }
    shift = std::max(kShiftGrowth * shift, kFirstShift * largest);
  }
  return false;
}

/// With the rows of side_ held, which are none for a backend's multipliers.
Optimality OptimalityCheck::Weigh() {
  Optimality out;
  out.violation = Violation(u_);
  if (!EvaluateHessian(rows_.size() > 0 ? lambda_.data() : nullptr, nullptr, 1.0)) return {};
  out.evaluated = true;
  const double largest = LargestElement(at_->hessian);
  largest_ = largest;
  Residual(lambda_.data());
  // Of the rows together: multipliers of a pinched pair may be large, and cancel.
  double slope = Largest(gradient_), gap = 0.0;
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    slope = std::max(slope, std::abs(residual_[i] - gradient_[i]));
  }
  for (int r = 0; r < rows_.size(); ++r) gap += std::abs(lambda_[r]) * WayTo(r, lambda_[r]);
  const double gained = std::abs(first_cost_ - at_->full.value);
  const double cost_size = std::max({gained, slope, std::numeric_limits<double>::min()});
  const double least = kLeastCurvature * slope + std::numeric_limits<double>::min();
  step_ = residual_;
  const bool holds = std::any_of(side_.begin(), side_.end(), [](Side s) { return s != Side::kNone; });
  if (holds && !HoldRows(std::max(largest, least))) return {};
  if (!Factor(least, largest)) return {};
  factor_.Solve(step_.data());
  double promised = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) promised += 0.5 * residual_[i] * step_[i];
  out.step = Largest(step_);
  out.gain = promised / cost_size;
  const double value = std::max(std::abs(at_->full.value), kLeastCost);
  out.left = promised / value;
  out.gap = gap / cost_size;
  out.gap_left = gap / value;
  left_ = promised + gap;
  cost_ = at_->full.value;
  return out;
}

/// Some point near, along the direction in which the Lagrangian curves least, keeps all rows and costs less, by more
/// than what a stationary point may have left: y is a saddle, an inflection, or a maximum along its rows. Rows at a
/// bound are left where they do not push, or held as well: of opposite ones none need push.
bool OptimalityCheck::NeighbourCostsLess() {
  for (const double pushes : {kPushes, 0.0}) {
    if (!HoldPushing(pushes)) return false;
    const bool upwards = CurvesUpwards();
    if (SoftestDirection(upwards) && DescendsAlongIt(upwards)) return true;
    if (upwards || rows_.size() == 0) return false;  // with more rows held it is no other
  }
  return false;
}

double OptimalityCheck::ClearlyLess() const {
  return kClearlyLess * std::max(std::abs(cost_), kLeastCost) + kClearlyMore * left_;
}

/// On one side of y at least.
bool OptimalityCheck::DescendsAlongIt(bool upwards) {
  const double value = cost_, less = ClearlyLess();
  // To come back to the rows.
  WeighRows(kRowWeight, [this](int r) { return SideOf(r) != Side::kNone; });
  if (!FactorRows()) return false;
  // The cost may have scales of its own, shorter than the point's size.
  for (double away = kNeighbour; away >= (upwards ? kNeighbour : kNearest); away *= 0.1) {
    for (const double sign : {away, -away}) {
      for (std::size_t i = 0; i < near_.size(); ++i) {
        near_[i] = (*y_)[static_cast<Eigen::Index>(i)] + sign * size_[i] * soft_[i];
      }
      for (int i = 0; i < kMostCorrections; ++i) {
        view_->MoveIntoBounds(near_.data());
        if (!Evaluate(near_.data(), {}, {})) break;
        rows_.Values(*at_, u_near_.data());
        const bool keeps = Violation(u_near_) <= kNeighbourViolation;
        if (keeps && at_->full.value < value - less) return true;
        if (keeps) break;
        ReturnToRows();
      }
    }
  }
  return false;
}

/// Evaluates the Lagrangian's Hessian with the rows held that push, by this share of the slopes: those of side_.
bool OptimalityCheck::HoldPushing(double pushes) {
  const double slope = Largest(gradient_) + largest_;
  for (int r = 0; r < rows_.size(); ++r) {
    const Side side = SideOf(r);
    const bool held = side == Side::kBoth || std::abs(lambda_[r]) * norm_[r] >= pushes * slope;
    side_[r] = held ? side : Side::kNone;
  }
  return HoldRows(largest_ + std::numeric_limits<double>::min());
}

/// In all directions that the rows held leave free, by what counts at a neighbour: y is a minimum, but where higher orders win.
bool OptimalityCheck::CurvesUpwards() {
  const double clearly =
      std::max(kFirstShift * largest_, 2.0 * ClearlyLess() / (kNeighbour * kNeighbour));
  return factor_.Factor(at_->hessian, -clearly, -clearly) == BorderedCholesky::Status::kDefinite;
}

/// soft_, of largest element 1, by inverse iteration on what HoldPushing evaluated, or CurvesUpwards factored.
bool OptimalityCheck::SoftestDirection(bool factored) {
  const double largest = largest_ + std::numeric_limits<double>::min();
  if (!factored && !Factor(kFirstShift * largest, largest)) return false;
  for (std::size_t i = 0; i < soft_.size(); ++i) soft_[i] = i % 2 == 0 ? 1.0 : 0.5 + 1.0 / (2.0 + i);
  for (int i = 0; i < (factored ? kFewInverseIterations : kInverseIterations); ++i) {
    factor_.Solve(soft_.data());
    const double scale = Largest(soft_);
    if (!(scale > 0.0) || !std::isfinite(scale)) return false;
    for (double& number : soft_) number /= scale;
  }
  return true;
}

/// near_, where rows have the values u_near_, is moved onto those that push, and into the others.
void OptimalityCheck::ReturnToRows() {
  StepOntoRows([this](int r) {
    if (side_[r] == Side::kNone) {
      return std::max(u_near_[r] - rows_.hi(r), 0.0) - std::max(rows_.lo(r) - u_near_[r], 0.0);
    }
    return u_near_[r] - (side_[r] == Side::kLower ? rows_.lo(r) : rows_.hi(r));
  });
  for (std::size_t i = 0; i < near_.size(); ++i) near_[i] += size_[i] * step_[i];
}

}  // namespace touchdown::solvers
