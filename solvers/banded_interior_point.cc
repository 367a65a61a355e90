// SPDX-License-Identifier: BSD-3-Clause
// Primal-dual interior point for  min f(y)  s.t.  g(y) <= 0,  g a row with one of its bounds:
//   g + s = e,  s z = mu,  grad f + G^T z = 0,  s, z > 0,
// where e = 0, or in the elastic mode e > 0 costs a price p each: e w = mu, w = p - z > 0. With s, z,
// e, w eliminated a Newton step is
//   (H + G^T W G) dy = -grad f - G^T (z + W k),   W = 1 / (s/z + e/w),   k = g + mu/z - mu/w,
//   dz = W (G dy + k),
// with H the Lagrangian's Hessian, curvature of the rows included. Every row is a window, so that
// G^T W G fills nothing: the matrix stays an arrowhead of the band, and one factor serves Mehrotra's
// predictor and corrector. A merit function guards the step where rows are curved or not convex.
// Sources: S. Mehrotra, SIAM J. Optim. 2 (1992) 575; J. Nocedal, S. Wright, Numerical Optimization,
// 2nd ed., chapter 19; the elastic form: P. Gill, W. Murray, M. Saunders, SIAM Rev. 47 (2005) 99.

#include "touchdown/solvers/banded_interior_point.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "touchdown/solvers/newton_step.h"

namespace touchdown::solvers {

namespace {

/// Share of the way to s = 0 or z = 0 that a step may go, at least; it nears 1 with the gap, so that
/// the last steps converge quadratically.
constexpr double kToBoundary = 0.995;
constexpr double kFirstSlack = 0.1;  // least slack of the first point, share of the largest row
constexpr double kFirstMu = 0.1;     // complementarity of the first point, share of the cost
constexpr double kSufficientDecrease = 1e-4;
constexpr double kShortestStep = 1e-8;
/// So many steps in a row that hardly move: the rows cannot be met from here.
constexpr int kMostStalls = 5;
constexpr double kStall = 1e-3;
constexpr double kElasticPrice = 100.0;  // times the largest multiplier so far

double Largest(const std::vector<double>& a) {
  double largest = 0.0;
  for (const double value : a) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

void BandedInteriorPoint::Prepare(const View& view) {
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  for (auto* vector : {&y_, &trial_, &step_, &right_}) {
    vector->assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  }
  const Problem& problem = view.problem();
  const auto terms = static_cast<std::size_t>(problem.num_terms());
  sides_.clear();
  for (auto* arrays : {&multiplier_, &weight_, &product_}) arrays->assign(terms, {});
  row_weights_.assign(terms, {});
  products_in_.assign(terms, nullptr);
  products_out_.assign(terms, nullptr);
  std::size_t total = 0;
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.role(i) != Role::kConstraint) continue;
    const TermShape& term = problem.term(i).shape();
    const auto rows = static_cast<std::size_t>(term.max_windows * term.outputs);
    for (auto* arrays : {&multiplier_, &weight_, &product_}) (*arrays)[i].assign(rows, 0.0);
    row_weights_[i] = {multiplier_[i].data(), weight_[i].data()};
    products_in_[i] = products_out_[i] = product_[i].data();
    const LossBounds bounds = problem.term(i).bounds();
    for (const auto& [sign, bound] : {std::pair{1.0, bounds.hi}, std::pair{-1.0, bounds.lo}}) {
      if (!std::isfinite(bound)) continue;
      sides_.push_back({i, term.outputs, sign, bound});
      total += rows;
    }
  }
  for (auto* array : {&now_.s, &now_.z, &now_.e, &now_.w, &next_.s, &next_.z, &next_.e, &next_.w,
                      &g_, &k_, &ds_, &dz_, &de_, &correction_s_, &correction_e_}) {
    array->assign(total, 0.0);
  }
}

SolveStatus BandedInteriorPoint::Run(const View& view, const double* start,
                                     const std::vector<std::vector<double>>& multipliers,
                                     const Tolerances& tolerances, Evaluator* evaluator) {
  std::copy(start, start + y_.size(), y_.begin());
  elastic_ = false;
  if (!evaluator->Evaluate(y_.data(), {.gradient = true})) return SolveStatus::kEvaluationFailed;
  StartRows(evaluator->last(), multipliers);
  const SolveStatus status = Iterate(view, tolerances, evaluator);
  if (status != SolveStatus::kInfeasible && status != SolveStatus::kNumericalFailure) return status;

  // Rows that cannot be met: the least costly violation instead, from the least violating point.
  elastic_ = true;
  price_ = kElasticPrice * std::max(Largest(now_.z), 1.0);
  std::copy(evaluator->best().data(), evaluator->best().data() + y_.size(), y_.begin());
  if (!evaluator->Evaluate(y_.data(), {.gradient = true})) return SolveStatus::kEvaluationFailed;
  StartRows(evaluator->last(), {});
  const SolveStatus relaxed = Iterate(view, tolerances, evaluator);
  if (relaxed != SolveStatus::kConverged) return relaxed;
  return LargestRow() <= Evaluator::kFeasible ? SolveStatus::kConverged : SolveStatus::kInfeasible;
}

SolveStatus BandedInteriorPoint::Iterate(const View& view, const Tolerances& tolerances,
                                         Evaluator* evaluator) {
  if (!EvaluateAt(y_.data(), now_, evaluator)) return SolveStatus::kEvaluationFailed;
  int stalls = 0;
  while (!evaluator->must_stop()) {
    ReadRows(evaluator->last());
    const double cost = evaluator->last().full.value;
    const double gap = Complementarity({0.0, 0.0}) * (elastic_ ? 2 * active_ : active_);
    DualResidual(view, evaluator);
    const double dual_error = Largest(right_);
    const double dual_scale =
        std::max(1.0, Largest(evaluator->last().gradient)) * std::sqrt(tolerances.gap);
    const double relative_gap = gap / std::max(std::abs(cost), 1e-12);
    if (relative_gap <= tolerances.gap && dual_error <= dual_scale &&
        (elastic_ || LargestRow() <= tolerances.violation)) {
      // An earlier point may cost less by what it violates within the tolerance.
      evaluator->PreferLast();
      return SolveStatus::kConverged;
    }

    if (!FactorDefinite(evaluator->last().hessian, &factor_)) return SolveStatus::kNumericalFailure;
    const double mu = Complementarity({0.0, 0.0});
    std::fill(correction_s_.begin(), correction_s_.end(), 0.0);
    std::fill(correction_e_.begin(), correction_e_.end(), 0.0);
    Direction(view, 0.0, evaluator);
    const double ratio = Complementarity(LongestStep(relative_gap)) / mu;
    const double target = mu * std::clamp(ratio * ratio * ratio, 1e-6, 1.0);
    Correct();
    Direction(view, target, evaluator);

    const double penalty = 2.0 * std::max(Largest(now_.z), 1e-12);
    const double merit = Merit(cost, target, penalty, now_);
    StepLengths length = LongestStep(relative_gap);
    for (;;) {
      Move(length);
      if (!EvaluateAt(trial_.data(), next_, evaluator)) {
        length.primal *= 0.5;
      } else {
        ReadRows(evaluator->last());
        const double after = Merit(evaluator->last().full.value, target, penalty, next_);
        if (after <= merit + kSufficientDecrease * std::abs(merit) || length.primal < kShortestStep)
          break;
        length.primal *= 0.5;
      }
      if (evaluator->must_stop()) return evaluator->stop_status();
      if (length.primal < kShortestStep) return SolveStatus::kInfeasible;
    }
    y_.swap(trial_);
    std::swap(now_, next_);
    evaluator->FinishIteration(length.primal * std::sqrt(std::inner_product(
                                                   step_.begin(), step_.end(), step_.begin(), 0.0)),
                               dual_error);
    evaluator->CheckStop();
    stalls = length.primal < kStall ? stalls + 1 : 0;
    if (stalls >= kMostStalls) return SolveStatus::kInfeasible;
  }
  return evaluator->stop_status();
}

void BandedInteriorPoint::PlaceRows(const ViewEvaluation& at) {
  active_ = 0;
  for (Side& side : sides_) {
    side.first = active_;
    side.rows = at.full.terms[side.term].windows * side.outputs;
    active_ += side.rows;
  }
}

void BandedInteriorPoint::StartRows(const ViewEvaluation& at,
                                    const std::vector<std::vector<double>>& multipliers) {
  PlaceRows(at);
  ReadRows(at);
  double size = 1e-6;
  for (int i = 0; i < active_; ++i) size = std::max(size, std::abs(g_[i]));
  for (auto* array : {&ds_, &dz_, &de_}) std::fill(array->begin(), array->end(), 0.0);
  const double mu = kFirstMu * std::max(std::abs(at.full.value), 1e-6) / std::max(active_, 1);
  for (const Side& side : sides_) {
    const bool known = static_cast<int>(multipliers.size()) > side.term &&
                       static_cast<int>(multipliers[side.term].size()) >= side.rows;
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      now_.s[i] = std::max(-g_[i], kFirstSlack * size);
      now_.z[i] = mu / now_.s[i];
      if (known) now_.z[i] = std::max(now_.z[i], side.sign * multipliers[side.term][j]);
      if (!elastic_) continue;
      now_.z[i] = std::min(now_.z[i], 0.5 * price_);
      now_.w[i] = price_ - now_.z[i];
      now_.e[i] = std::max(g_[i] + now_.s[i], mu / now_.w[i]);
    }
  }
}

void BandedInteriorPoint::ReadRows(const ViewEvaluation& at) {
  for (const Side& side : sides_) {
    const double* u = at.full.terms[side.term].u.data();
    for (int j = 0; j < side.rows; ++j) g_[side.first + j] = side.sign * (u[j] - side.bound);
  }
}

double BandedInteriorPoint::LargestRow() const {
  double largest = 0.0;
  for (int i = 0; i < active_; ++i) largest = std::max(largest, g_[i]);
  return largest;
}

bool BandedInteriorPoint::EvaluateAt(const double* y, const Rows& rows, Evaluator* evaluator) {
  for (auto* arrays : {&multiplier_, &weight_}) {
    for (auto& array : *arrays) std::fill(array.begin(), array.end(), 0.0);
  }
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      multiplier_[side.term][j] += side.sign * rows.z[i];
      const double give = rows.s[i] / rows.z[i] + (elastic_ ? rows.e[i] / rows.w[i] : 0.0);
      weight_[side.term][j] += 1.0 / give;
    }
  }
  return evaluator->EvaluateLagrangian(y, {.rows = row_weights_.data()});
}

/// right_ = grad f + G^T z.
void BandedInteriorPoint::DualResidual(const View& view, Evaluator* evaluator) {
  for (auto& array : product_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      product_[side.term][j] += side.sign * now_.z[side.first + j];
    }
  }
  view.MultiplyRowsTransposed(products_in_.data(), evaluator->mutable_last(), right_.data());
  const std::vector<double>& gradient = evaluator->last().gradient;
  for (std::size_t i = 0; i < right_.size(); ++i) right_[i] += gradient[i];
}

void BandedInteriorPoint::Direction(const View& view, double mu, Evaluator* evaluator) {
  for (auto& array : product_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      double give = now_.s[i] / now_.z[i];
      k_[i] = g_[i] + (mu - correction_s_[i]) / now_.z[i];
      if (elastic_) {
        give += now_.e[i] / now_.w[i];
        k_[i] -= (mu - correction_e_[i]) / now_.w[i];
      }
      product_[side.term][j] += side.sign * (now_.z[i] + k_[i] / give);
    }
  }
  view.MultiplyRowsTransposed(products_in_.data(), evaluator->mutable_last(), right_.data());
  const std::vector<double>& gradient = evaluator->last().gradient;
  for (std::size_t i = 0; i < right_.size(); ++i) right_[i] += gradient[i];
  NewtonStep(view, y_.data(), right_.data(), factor_, step_.data());
  view.MultiplyRows(step_.data(), evaluator->mutable_last(), products_out_.data());
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      const double s = now_.s[i], z = now_.z[i];
      const double give = s / z + (elastic_ ? now_.e[i] / now_.w[i] : 0.0);
      dz_[i] = (side.sign * product_[side.term][j] + k_[i]) / give;
      ds_[i] = (mu - correction_s_[i] - s * dz_[i]) / z - s;
      if (!elastic_) continue;
      const double e = now_.e[i], w = now_.w[i];
      de_[i] = (mu - correction_e_[i] + e * dz_[i]) / w - e;
    }
  }
}

/// The second-order terms that the predictor's full step would leave in s z and e w.
void BandedInteriorPoint::Correct() {
  for (int i = 0; i < active_; ++i) correction_s_[i] = ds_[i] * dz_[i];
  if (!elastic_) return;
  for (int i = 0; i < active_; ++i) correction_e_[i] = -de_[i] * dz_[i];
}

BandedInteriorPoint::StepLengths BandedInteriorPoint::LongestStep(double gap) const {
  double primal = 1.0, dual = 1.0;
  const double share = std::max(kToBoundary, 1.0 - gap);
  const auto limit = [share](double from, double step, double* length) {
    if (step < 0.0) *length = std::min(*length, -share * from / step);
  };
  for (int i = 0; i < active_; ++i) {
    limit(now_.s[i], ds_[i], &primal);
    limit(now_.z[i], dz_[i], &dual);
    if (!elastic_) continue;
    limit(now_.e[i], de_[i], &primal);
    limit(now_.w[i], -dz_[i], &dual);
  }
  return {primal, dual};
}

/// Mean of s z (and e w) after a step of these lengths.
double BandedInteriorPoint::Complementarity(const StepLengths& length) const {
  double sum = 0.0;
  for (int i = 0; i < active_; ++i) {
    const double z = now_.z[i] + length.dual * dz_[i];
    sum += (now_.s[i] + length.primal * ds_[i]) * z;
    if (elastic_) sum += (now_.e[i] + length.primal * de_[i]) * (now_.w[i] - length.dual * dz_[i]);
  }
  return sum / std::max(elastic_ ? 2 * active_ : active_, 1);
}

void BandedInteriorPoint::Move(const StepLengths& length) {
  for (std::size_t i = 0; i < y_.size(); ++i) trial_[i] = y_[i] + length.primal * step_[i];
  for (int i = 0; i < active_; ++i) {
    next_.s[i] = now_.s[i] + length.primal * ds_[i];
    next_.z[i] = now_.z[i] + length.dual * dz_[i];
    if (!elastic_) continue;
    next_.e[i] = now_.e[i] + length.primal * de_[i];
    next_.w[i] = price_ - next_.z[i];
  }
}

/// f + p sum e - mu sum (log s + log e) + penalty sum |g + s - e|, with the rows just read.
double BandedInteriorPoint::Merit(double cost, double mu, double penalty, const Rows& rows) const {
  double merit = cost;
  for (int i = 0; i < active_; ++i) {
    const double e = elastic_ ? rows.e[i] : 0.0;
    merit += penalty * std::abs(g_[i] + rows.s[i] - e) - mu * std::log(rows.s[i]);
    if (elastic_) merit += price_ * e - mu * std::log(e);
  }
  return merit;
}

}  // namespace touchdown::solvers
