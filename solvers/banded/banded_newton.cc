// SPDX-License-Identifier: BSD-3-Clause
// Newton's method on an arrowhead Hessian. Almost all steps are full ones. One pass computes value,
// gradient and Hessian of a full step, so that an accepted one needs no second pass. A shorter
// step, and the step after it, compute the value first. An indefinite Hessian (a nonconvex term, a
// free interval) is shifted until it is definite. A border that alone is indefinite takes its
// absolute value, which keeps the fast directions as they are. Source: J. Nocedal, S. Wright,
// Numerical Optimization, 2nd ed., sections 3.4 and 3.5.

#include "solvers/banded/banded_newton.h"

#include <algorithm>
#include <cmath>

#include "touchdown/solvers/backend/newton_step.h"

namespace touchdown::solvers {

namespace {

constexpr double kSufficientDecrease = 1e-4;
constexpr double kNewtonShortestStep = 1e-10;
constexpr double kLessShift = 1e5;          // 0.1 of the last one, which is 1e-6 of this
constexpr double kNewtonLongestStep = 1e3;  // over the point's size
/// Below this share of the cost a decrease is rounding.
constexpr double kValueRounding = 1e-15;
/// What was gained counts for this share of the cost at least.
constexpr double kLeastShareOfScale = 1e-6;

}  // namespace

void BandedNewton::Prepare(const View& view) {
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  for (auto* vector : {&y_, &gradient_, &step_, &trial_}) {
    vector->assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  }
}

SolveStatus BandedNewton::Run(const View& view, const double* start, const Tolerances& tolerances,
                              Evaluator* evaluator) {
  std::copy(start, start + y_.size(), y_.begin());
  ended_near_ = false;
  bool full_step = true;
  double curvature = 0.0;  // what the first shift is a share of; 0: the largest of the diagonal
  if (!evaluator->EvaluateLagrangian(y_.data(), {})) return SolveStatus::kEvaluationFailed;
  while (!evaluator->must_stop()) {
    const ViewEvaluation& at = evaluator->last();
    gradient_ = at.gradient;
    const double value = at.full.value;
    if (Largest(gradient_) == 0.0) return SolveStatus::kConverged;
    // Where nothing curves at all a first step goes far beyond the point.
    if (curvature == 0.0 && at.hessian.BandIsZero()) curvature = Largest(gradient_);
    double shift = 0.0;
    if (!FactorDefinite(at.hessian, &factor_, curvature, &shift)) {
      return SolveStatus::kNumericalFailure;
    }
    const double promised = NewtonStep(view, y_.data(), gradient_.data(), factor_, step_.data());
    double slope = -2.0 * promised;
    const double scale = std::max(std::abs(value), kSmallestCost);
    // Of the cost; of what was gained, where a constant in the cost must not end the solve.
    const double gained = std::abs(evaluator->first_cost() - value);
    const double whole =
        tolerances.of_gain ? std::clamp(gained, kLeastShareOfScale * scale, scale) : scale;
    if (promised <= (shift > 0.0 ? tolerances.own : tolerances.gap) * whole) {
      ended_near_ = promised > tolerances.own * whole;
      return SolveStatus::kConverged;
    }
    slope *= Shorten();
    const double length = LineSearch(value, slope, full_step, evaluator);
    full_step = length == 1.0;
    // A shift shortens steps: where they succeed, the next one is smaller.
    if (tolerances.of_gain) curvature = full_step && shift > 0.0 ? kLessShift * shift : 0.0;
    if (length == 0.0) {
      // Nothing along a descent direction is lower: what is left is rounding, or the step is wrong.
      const double rounding = 1e-9 * (tolerances.of_gain ? std::max(scale, gained) : scale);
      return -slope <= rounding ? SolveStatus::kConverged : SolveStatus::kNumericalFailure;
    }
    evaluator->FinishIteration(length * std::sqrt(Dot(step_, step_)), Largest(gradient_));
    evaluator->CheckStop();
  }
  return evaluator->stop_status();
}

/// Without curvature, nothing limits the length of a step.
double BandedNewton::Shorten() {
  const double share = kNewtonLongestStep * (1.0 + Largest(y_)) / Largest(step_);
  if (share >= 1.0) return 1.0;
  for (double& number : step_) number *= share;
  return share;
}

/// Halves the step until it decreases the value enough. y_ and the evaluator's last point become
/// the accepted point. Returns the accepted share of the step, 0 if there is none. With
/// `derivatives` the first trial point is evaluated with them. Other points get them once they are
/// accepted.
double BandedNewton::LineSearch(double value, double slope, bool derivatives,
                                Evaluator* evaluator) {
  for (double t = 1.0; t > kNewtonShortestStep; t *= 0.5) {
    for (std::size_t i = 0; i < y_.size(); ++i) trial_[i] = y_[i] + t * step_[i];
    bool ok = derivatives ? evaluator->EvaluateLagrangian(trial_.data(), {})
                          : evaluator->Evaluate(trial_.data(), {});
    const double decrease = value - evaluator->last().full.value;
    const double wanted = -kSufficientDecrease * t * slope - kValueRounding * std::abs(value);
    ok = ok && decrease >= wanted;
    // A term may have a value where it has no derivatives.
    if (ok && !derivatives && !evaluator->must_stop()) {
      ok = evaluator->EvaluateLagrangian(trial_.data(), {});
    }
    if (ok) {
      y_.swap(trial_);
      return t;
    }
    if (evaluator->must_stop()) return t;
    derivatives = false;
  }
  return 0.0;
}

}  // namespace touchdown::solvers
