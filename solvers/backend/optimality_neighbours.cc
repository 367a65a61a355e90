// SPDX-License-Identifier: BSD-3-Clause
// The neighbourhood of a point that meets the first-order conditions. Points are evaluated outwards
// along the softest directions, where the cost might fall, as long as it does not rise. A point
// that costs clearly less refutes the optimum: a saddle, an inflection, a plateau, or a valley
// whose metric is lost to rounding. Points behind a rise belong to another optimum, and refute
// nothing. Where a valley bends, no straight line stays on its floor: Newton's steps across the
// line lead down to it (the reduction of Lyapunov and Schmidt).

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "touchdown/solvers/backend/newton_step.h"
#include "touchdown/solvers/backend/optimality.h"

namespace touchdown::solvers {

namespace {

constexpr double kNearest = 1e-8;  // of the sizes; the cost may have shorter scales than the point
constexpr double kFarthest = 1.0;
constexpr double kFarthestDown = 100.0;  // where it curves downwards
constexpr double kOutwards = 10.0;
constexpr double kOutwardsUp = 100.0;  // where it curves upwards
constexpr double kClearlyLess = 1e-8;  // share of the cost
constexpr double kCostRounding = 1e-13;
constexpr double kClearlyMore = 10.0;  // than what the conditions leave
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kOnRows = 1e-10;
constexpr int kMostCorrections = 40;  // two rows that oppose each other converge by halves
constexpr int kInverseIterations = 40;
constexpr int kFewInverseIterations = 5;
constexpr double kRoundingShift = 1e-12;  // of rows held by their weights
constexpr double kUpwards = 1e-10;        // curvature, share of what holds rows
constexpr double kPushes = 1e-6;          // multiplier of a row, share of slope and curvature
constexpr int kSoftWays = 2;
constexpr std::size_t kMostAxes = 8;
// Valleys that bend.
constexpr double kSoftest = 1e-15, kSoft = 2e-2;  // curvature of soft ways, share of the largest
constexpr int kSinkSteps = 5;
constexpr double kPromise = 10.0;  // they gain at most so many times what the first one promises
constexpr double kBetween[] = {0.2, 0.4, 0.6, 0.8};

}  // namespace

/// Rows at a bound are left where they do not push, or held as well: of opposite ones none need
/// push.
void OptimalityCheck::LookAround(Optimality* found) {
  sinks_ = false;
  if (shift_ > kFirstShift) {
    way_ = step_;
    if (FactorRowsAtBounds() && Refutes({kOutwards, kFarthest}, found)) return;
  }
  for (const double pushes : {kPushes, 0.0}) {
    if (!HoldPushing(pushes) || RefuteSoftWays(found) || HoldsAll()) return;
  }
}

/// Along the softest ways, and the axes of variables that hardly curve. Where the Hessian curves
/// upwards only an inflection can turn downwards; there axes are for few variables.
bool OptimalityCheck::RefuteSoftWays(Optimality* found) {
  const bool upwards = CurvesUpwards();
  Reach reach{upwards ? kOutwardsUp : kOutwards, kFarthest};
  std::fill(soft_.begin(), soft_.end(), 0.0);
  for (int way = 0; way < kSoftWays; ++way) {
    if (way > 0 && !HoldRows()) return false;
    if (!SoftestWay(upwards ? Metric::kSizes : Metric::kDiagonal)) return false;
    sinks_ = FactorAcross();
    if (!upwards && shift_ > kRoundingShift) reach.farthest = kFarthestDown;
    soft_ = way_;
    if (!FactorRowsAtBounds()) return false;
    if (Refutes(reach, found)) return true;
  }
  if (upwards && order_.size() > kMostAxes) return false;
  std::iota(order_.begin(), order_.end(), 0);
  const auto axes = static_cast<std::ptrdiff_t>(std::min(kMostAxes, order_.size()));
  std::partial_sort(order_.begin(), order_.begin() + axes, order_.end(), [this](int a, int b) {
    return std::pair(diagonal_[a], a) < std::pair(diagonal_[b], b);
  });
  for (std::ptrdiff_t i = 0; i < axes; ++i) {
    std::fill(way_.begin(), way_.end(), 0.0);
    way_[order_[i]] = 1.0;
    if (Refutes(reach, found)) return true;
  }
  return false;
}

/// For EvaluateOnRows, which comes back to them. Where there are none nothing needs to.
bool OptimalityCheck::FactorRowsAtBounds() {
  WeighRows(Kept::kAtBounds);
  return rows_.size() == 0 || FactorRows();
}

/// Along way_, on one side of y at least, by what FactorRowsAtBounds factored.
bool OptimalityCheck::Refutes(const Reach& reach, Optimality* found) {
  const double longest = Largest(way_);
  if (!(longest > 0.0) || !std::isfinite(longest)) return false;
  double slope = 0.0;
  for (std::size_t i = 0; i < way_.size(); ++i) {
    way_[i] /= longest;
    slope += residual_[i] * way_[i];
  }
  double least_fall = kClearlyLess * std::min(cost_size_, CostValue()) +
                      kCostRounding * std::abs(cost_) + kClearlyMore * left_;
  for (int r = 0; r < rows_.size(); ++r) least_fall += kOnRows * std::abs(lambda_[r]) * norm_[r];
  for (const double sign : {1.0, -1.0}) {
    double where = 0.0;
    const double fall = Fall(sign, reach, least_fall, &where);
    if (fall <= least_fall) continue;
    if (-sign * where * slope < 0.5 * fall) {
      found->saddle = true;
    } else {
      found->step = found->left = found->gain = kUnknown;  // the metric was blind to it
    }
    return true;
  }
  return false;
}

/// The most that the cost falls outwards along way_ before it rises by `rise`, and where.
double OptimalityCheck::Fall(double sign, const Reach& reach, double rise, double* where) {
  double most = 0.0;
  for (double away = kNearest; away <= 1.01 * reach.farthest; away *= reach.outwards) {
    MoveAway(sign * away, way_);
    if (!EvaluateOnRows()) break;
    const double fall = sinks_ ? Sink(away, rise) : cost_ - at_->full.value;
    if (fall < most - rise) break;
    if (fall <= most) continue;
    if (sinks_ && fall > rise && RisesBefore(sign * away, rise)) break;
    most = fall;
    *where = away;
  }
  return most;
}

/// The floor of a valley may lead uphill before it comes down into another one.
bool OptimalityCheck::RisesBefore(double way, double rise) {
  return std::any_of(std::begin(kBetween), std::end(kBetween), [&](double share) {
    MoveAway(share * way, way_);
    return !EvaluateOnRows() || Sink(share * std::abs(way), -rise) < -rise;
  });
}

/// Factors the Hessian of the softest way with softness_ on its diagonal. That is clearly more than
/// what makes it definite: it tells soft ways from others.
bool OptimalityCheck::FactorAcross() {
  Shift(-shift_);
  const double largest = Largest(diagonal_);
  bool definite = false;
  softness_ = 0.0;
  for (double next = kSoftest; next <= kSoft; next *= kShiftGrowth) {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      at_->hessian.Diagonal(static_cast<int>(i)) += next * largest - softness_;
    }
    softness_ = next * largest;
    const bool enough = definite;
    definite = across_.Factor(at_->hessian) == BorderedCholesky::Status::kDefinite;
    if (enough) return definite;
  }
  return false;
}

/// Newton's steps from near_, where it was evaluated, across way_: a valley is followed where it
/// bends away from a straight line. Returns how far the cost is then below that at y. Steps are at
/// most `away` long. Ends where they do not promise that it falls by `enough`.
double OptimalityCheck::Sink(double away, double enough) {
  double fall = cost_ - at_->full.value;
  for (int i = 0; i < kSinkSteps; ++i) {
    LagrangianSlope();
    AcrossStep();
    const double longest = Largest(sink_);
    if (!(kPromise * Dot(slope_, sink_) > enough - fall) || !std::isfinite(longest)) break;
    const double length = std::min(1.0, away / longest);
    for (std::size_t k = 0; k < near_.size(); ++k) near_[k] -= length * size_[k] * sink_[k];
    if (!EvaluateOnRows() || !(cost_ - at_->full.value > fall)) break;
    fall = cost_ - at_->full.value;
  }
  return fall;
}

/// sink_ = Newton's step to the slope_, without its share in soft ways, which may be long and is
/// noise, and along way_.
void OptimalityCheck::AcrossStep() {
  sink_ = slope_;
  across_.Solve(sink_.data());
  for (std::size_t k = 0; k < sink_.size(); ++k) soft_share_[k] = softness_ * sink_[k];
  across_.Solve(soft_share_.data());
  for (std::size_t k = 0; k < sink_.size(); ++k) sink_[k] -= soft_share_[k];
  const double along = Dot(sink_, way_) / Dot(way_, way_);
  for (std::size_t k = 0; k < sink_.size(); ++k) sink_[k] -= along * way_[k];
}

/// slope_ = that of the Lagrangian, at near_, where it was evaluated.
void OptimalityCheck::LagrangianSlope() {
  view_->MultiplyRowsTransposed(multipliers_.data(), at_, slope_.data());
  for (std::size_t k = 0; k < slope_.size(); ++k) slope_[k] += at_->gradient[k];
  for (int r = rows_.first_bound(); r < rows_.size(); ++r) {
    slope_[rows_.column(rows_.start(r))] += lambda_[r];
  }
  for (std::size_t k = 0; k < slope_.size(); ++k) slope_[k] *= size_[k];
}

/// At near_, moved onto the rows that are held, and into the others.
bool OptimalityCheck::EvaluateOnRows() {
  for (int i = 0; i < kMostCorrections; ++i) {
    view_->MoveIntoBounds(near_.data());
    if (!Evaluate(near_.data(), {.gradient = sinks_}, {})) return false;
    rows_.Values(*at_, u_near_.data());
    double most = 0.0;
    for (int r = 0; r < rows_.size(); ++r) {
      off_[r] = OffRow(r);
      if (off_[r] == 0.0) continue;
      most = std::max(most, std::abs(off_[r]) / norm_[r]);
      if (weight_[r] == 0.0) return false;  // of a row that is far from y nothing leads back
    }
    if (most <= kOnRows) return true;
    ShortestStep();
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

/// Evaluates the Lagrangian's Hessian and holds those rows of side_ whose multiplier exceeds this
/// share of the cost's slope and curvature.
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

/// Sets way_ by inverse iteration: the direction of least curvature in the last evaluated Hessian,
/// other than soft_. Curvature is relative to the point's size, or to the diagonal. The shift is a
/// share of that diagonal, so a steep direction is not shifted above a soft one.
bool OptimalityCheck::SoftestWay(Metric metric) {
  if (!FactorShifted()) return false;
  for (std::size_t i = 0; i < way_.size(); ++i) way_[i] = i % 2 == 0 ? 1.0 : 0.5 + 1.0 / (2.0 + i);
  const bool by_diagonal = metric == Metric::kDiagonal;
  const auto weight = [&](std::size_t i) { return by_diagonal ? diagonal_[i] : 1.0; };
  for (int i = 0; i < (by_diagonal ? kInverseIterations : kFewInverseIterations); ++i) {
    double shared = 0.0, own = 0.0;
    for (std::size_t k = 0; k < way_.size(); ++k) {
      shared += weight(k) * way_[k] * soft_[k];
      own += weight(k) * soft_[k] * soft_[k];
    }
    for (std::size_t k = 0; k < way_.size(); ++k) {
      if (own > 0.0) way_[k] -= shared / own * soft_[k];
      way_[k] *= weight(k);
    }
    factor_.Solve(way_.data());
    const double scale = Largest(way_);
    if (!(scale > 0.0) || !std::isfinite(scale)) return false;
    for (double& number : way_) number /= scale;
  }
  return true;
}

}  // namespace touchdown::solvers
