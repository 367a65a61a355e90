// SPDX-License-Identifier: BSD-3-Clause
// What is around a point that meets the first-order conditions: along the ways on which the cost
// might fall, the softest ones, points are evaluated outwards for as long as it does not rise. One
// that costs clearly less refutes the point: a saddle, an inflection, a plateau, or a valley whose
// metric is lost to rounding. What lies behind a rise is another optimum's, and refutes nothing.

#include <algorithm>
#include <cmath>
#include <limits>

#include "touchdown/solvers/newton_step.h"
#include "touchdown/solvers/optimality.h"

namespace touchdown::solvers {

namespace {

constexpr double kNearest = 1e-8;  // of the sizes; the cost may have shorter scales than the point
constexpr double kNeighbour = 1e-2;
constexpr double kFarthest = 1.0;
constexpr double kFarthestDown = 100.0;  // where it curves downwards
constexpr double kOutwards = 10.0;
constexpr double kClearlyLess = 1e-8;  // share of the cost
constexpr double kCostRounding = 1e-13;
constexpr double kClearlyMore = 10.0;  // than what the conditions leave
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kOnRows = 1e-10;
constexpr int kMostCorrections = 40;    // a row and its opposite go half the way each time
constexpr int kInverseIterations = 40;  // a shift may be ten times what it need be
constexpr int kFewInverseIterations = 5;
constexpr double kRoundingShift = 1e-12;  // of rows held by their weights
constexpr double kUpwards = 1e-10;        // curvature, share of what holds rows
constexpr double kPushes = 1e-6;          // multiplier of a row, share of the slopes

}  // namespace

/// Rows at a bound are left where they do not push, or held as well: of opposite ones none need
/// push.
void OptimalityCheck::LookAround(Optimality* found) {
  if (shift_ > kFirstShift) {
    way_ = step_;
    if (Refutes(kNearest, kFarthest, found)) return;
  }
  for (const double pushes : {kPushes, 0.0}) {
    if (!HoldPushing(pushes)) return;
    const bool upwards = CurvesUpwards();
    if (!SoftestWay(upwards ? kFewInverseIterations : kInverseIterations)) return;
    // Near an inflection it curves upwards on one side.
    const double nearest = upwards ? kNeighbour : kNearest;
    const double farthest = upwards                    ? kNeighbour
                            : shift_ <= kRoundingShift ? kFarthest
                                                       : kFarthestDown;
    if (Refutes(nearest, farthest, found)) return;
    if (HoldsAll()) return;
  }
}

/// Along way_, on one side of y at least.
bool OptimalityCheck::Refutes(double nearest, double farthest, Optimality* found) {
  const double longest = Largest(way_);
  if (!(longest > 0.0) || !std::isfinite(longest)) return false;
  double slope = 0.0;
  for (std::size_t i = 0; i < way_.size(); ++i) {
    way_[i] /= longest;
    slope += residual_[i] * way_[i];
  }
  double less = kClearlyLess * std::min(cost_size_, CostValue()) + kCostRounding * std::abs(cost_) +
                kClearlyMore * left_;
  for (int r = 0; r < rows_.size(); ++r) less += kOnRows * std::abs(lambda_[r]) * norm_[r];
  // To come back to the rows.
  WeighRows(Kept::kAtBounds);
  if (!FactorRows()) return false;
  for (const double sign : {1.0, -1.0}) {
    double where = 0.0;
    double most = Fall(sign, nearest, farthest, less, &where);
    if (most > less && nearest > kNearest) most = Fall(sign, kNearest, farthest, less, &where);
    if (most <= less) continue;
    if (-sign * where * slope < 0.5 * most) {
      found->saddle = true;
    } else {
      found->step = found->left = found->gain = kUnknown;  // the metric was blind to it
    }
    return true;
  }
  return false;
}

/// The most that the cost falls outwards along way_ before it rises by `rise`, and where.
double OptimalityCheck::Fall(double sign, double nearest, double farthest, double rise,
                             double* where) {
  double most = 0.0;
  for (double away = nearest; away <= farthest; away *= kOutwards) {
    MoveAway(sign * away, way_);
    if (!EvaluateOnRows()) break;
    const double fall = cost_ - at_->full.value;
    if (fall < most - rise) break;
    if (fall <= most) continue;
    most = fall;
    *where = away;
  }
  return most;
}

/// At near_, moved onto the rows that are held, and into the others.
bool OptimalityCheck::EvaluateOnRows() {
  for (int i = 0; i < kMostCorrections; ++i) {
    view_->MoveIntoBounds(near_.data());
    if (!Evaluate(near_.data(), {}, {})) return false;
    rows_.Values(*at_, u_near_.data());
    double most = 0.0;
    for (int r = 0; r < rows_.size(); ++r) {
      off_[r] = OffRow(r);
      if (off_[r] != 0.0) most = std::max(most, std::abs(off_[r]) / norm_[r]);
    }
    if (most <= kOnRows) return true;
    StepOntoRows();
    for (std::size_t k = 0; k < near_.size(); ++k) near_[k] += size_[k] * step_[k];
  }
  return false;
}

/// How far the row's value u_near_ is from where it is held, or beyond its bounds.
double OptimalityCheck::OffRow(int row) const {
  const double u = u_near_[row];
  if (side_[row] == Side::kNone) return Beyond(row, u);
  return u - (side_[row] == Side::kLower ? rows_.lo(row) : rows_.hi(row));
}

/// Evaluates the Lagrangian's Hessian with the rows held that push, by this share of the slopes:
/// those of side_.
bool OptimalityCheck::HoldPushing(double pushes) {
  const double least = pushes * std::max(Largest(gradient_), curvature_);
  for (int r = 0; r < rows_.size(); ++r) {
    const Side side = SideOf(r);
    const bool held = side == Side::kBoth || std::abs(lambda_[r]) * norm_[r] >= least;
    side_[r] = held ? side : Side::kNone;
  }
  return HoldRows();
}

bool OptimalityCheck::HoldsAll() const {
  for (int r = 0; r < rows_.size(); ++r) {
    if (side_[r] != SideOf(r)) return false;
  }
  return true;
}

/// In all directions that the rows held leave free: y is a minimum.
bool OptimalityCheck::CurvesUpwards() {
  MeasureDiagonal();
  Shift(-kUpwards);
  const bool upwards = factor_.Factor(at_->hessian) == BorderedCholesky::Status::kDefinite;
  Shift(kUpwards);
  return upwards;
}

/// way_, in which the Hessian that HoldPushing evaluated curves least, measured by the diagonal: by
/// inverse iteration.
bool OptimalityCheck::SoftestWay(int iterations) {
  if (!FactorShifted()) return false;
  for (std::size_t i = 0; i < way_.size(); ++i) way_[i] = i % 2 == 0 ? 1.0 : 0.5 + 1.0 / (2.0 + i);
  for (int i = 0; i < iterations; ++i) {
    for (std::size_t k = 0; k < way_.size(); ++k) way_[k] *= diagonal_[k];
    factor_.Solve(way_.data());
    const double scale = Largest(way_);
    if (!(scale > 0.0) || !std::isfinite(scale)) return false;
    for (double& number : way_) number /= scale;
  }
  return true;
}

}  // namespace touchdown::solvers
