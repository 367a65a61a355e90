// SPDX-License-Identifier: BSD-3-Clause
// Section numbers are those of More and Thuente 1994. The interval of uncertainty ends at `best_`,
// where the function is least so far, and at `other_`, the far end once the minimiser is bracketed.
// At first psi(a) = f(a) - f(0) - mu a f'(0) updates the interval (section 2). Once a step has met
// the decrease with a rising slope, f itself does (section 3). Cubic and quadratic interpolation in
// four cases gives the trial step in it (section 4).

#include "solvers/lbfgs/more_thuente.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchdown::solvers {

namespace {

constexpr double kShrink = 0.66;      // an interval that shrinks less in two steps is bisected
constexpr double kExtrapolate = 4.0;  // of the last step, while there is no bracket

/// Root term of the cubic's derivative (section 4, the closed form of eq. 4.1's minimiser).
struct Cubic {
  double theta, gamma;  // gamma >= 0
};

Cubic Interpolate(double a, double fa, double da, double b, double fb, double db) {
  const double theta = 3.0 * (fa - fb) / (b - a) + da + db;
  const double scale = std::max({std::abs(theta), std::abs(da), std::abs(db)});
  const double t = theta / scale;
  return {theta, scale * std::sqrt(std::max(0.0, t * t - (da / scale) * (db / scale)))};
}

/// Minimiser of the cubic that interpolates value and slope at a and b.
double CubicMinimiser(double a, double fa, double da, double b, double fb, double db) {
  const Cubic cubic = Interpolate(a, fa, da, b, fb, db);
  const double gamma = b < a ? -cubic.gamma : cubic.gamma;
  return a + (gamma - da + cubic.theta) / (2.0 * gamma - da + db) * (b - a);
}

/// The same beyond b, seen from a; `bound` where the cubic has no minimiser there.
double CubicMinimiserBeyond(double a, double fa, double da, double b, double fb, double db,
                            double bound) {
  const Cubic cubic = Interpolate(a, fa, da, b, fb, db);
  const double gamma = b > a ? -cubic.gamma : cubic.gamma;
  const double r = (gamma - db + cubic.theta) / (2.0 * gamma + da - db);
  return r < 0.0 && gamma != 0.0 ? b + r * (a - b) : bound;
}

/// Minimiser of the parabola through f(a), f'(a), f(b).
double QuadraticMinimiser(double a, double fa, double da, double b, double fb) {
  return a + 0.5 * da / ((fa - fb) / (b - a) + da) * (b - a);
}

/// Where the slope, interpolated linearly between a and b, is zero.
double SecantMinimiser(double a, double da, double b, double db) {
  return b + db / (db - da) * (a - b);
}

}  // namespace

void MoreThuente::Begin(double value, double slope, double step,
                        const MoreThuenteOptions& options) {
  options_ = options;
  start_value_ = value;
  start_slope_ = slope;
  best_ = other_ = {0.0, value, slope};
  bracketed_ = false;
  first_stage_ = true;
  rounding_ = false;
  width_ = options.max_step - options.min_step;
  width_before_ = 2.0 * width_;
  failed_step_ = std::numeric_limits<double>::infinity();
  evaluations_ = 0;
  step_ = step;
  Clip();
  state_ = LineSearchState::kEvaluate;
}

/// Bounds of the next step, and the step within them; the best one where nothing better can be had.
void MoreThuente::Clip() {
  lowest_ = bracketed_ ? std::min(best_.step, other_.step) : best_.step;
  highest_ =
      bracketed_ ? std::max(best_.step, other_.step) : step_ + kExtrapolate * (step_ - best_.step);
  step_ = std::clamp(step_, options_.min_step, options_.max_step);
  if (step_ >= failed_step_) step_ = 0.5 * (best_.step + failed_step_);
  const bool narrow = highest_ - lowest_ <= options_.interval_tolerance * highest_;
  const bool outside = step_ <= lowest_ || step_ >= highest_;
  const bool last = evaluations_ + 1 >= options_.max_evaluations;
  if (bracketed_ && (outside || narrow || last || rounding_)) step_ = best_.step;
}

LineSearchState MoreThuente::Observe(double value, double slope) {
  ++evaluations_;
  if (!std::isfinite(value) || !std::isfinite(slope)) {
    failed_step_ = std::min(failed_step_, step_);
    step_ = 0.5 * (best_.step + step_);
    return state_ = evaluations_ < options_.max_evaluations ? LineSearchState::kEvaluate
                                                            : LineSearchState::kEvaluationLimit;
  }
  const double decrease = options_.sufficient_decrease * start_slope_;
  const double line = start_value_ + step_ * decrease;
  if (rounding_ || (bracketed_ && (step_ <= lowest_ || step_ >= highest_))) {
    state_ = LineSearchState::kRounding;
  } else if (step_ >= options_.max_step && value <= line && slope <= decrease) {
    state_ = LineSearchState::kAtMaxStep;
  } else if (step_ <= options_.min_step && (value > line || slope >= decrease)) {
    state_ = LineSearchState::kAtMinStep;
  } else if (bracketed_ && highest_ - lowest_ <= options_.interval_tolerance * highest_) {
    state_ = LineSearchState::kIntervalTooSmall;
  } else if (evaluations_ >= options_.max_evaluations) {
    state_ = LineSearchState::kEvaluationLimit;
  } else if (value <= line && std::abs(slope) <= -options_.curvature * start_slope_) {
    state_ = LineSearchState::kConverged;
  }
  if (state_ != LineSearchState::kEvaluate) return state_;

  const double least = std::min(options_.sufficient_decrease, options_.curvature) * start_slope_;
  if (first_stage_ && value <= line && slope >= least) first_stage_ = false;
  const Point trial{step_, value, slope};
  if (first_stage_ && value > line && value <= best_.value) {
    // psi with its constant left out: only differences matter.
    const auto tilt = [decrease](const Point& p) {
      return Point{p.step, p.value - p.step * decrease, p.slope - decrease};
    };
    const auto upright = [decrease](const Point& p) {
      return Point{p.step, p.value + p.step * decrease, p.slope + decrease};
    };
    Point best = tilt(best_), other = tilt(other_);
    rounding_ = !Update(&best, &other, tilt(trial));
    best_ = upright(best);
    other_ = upright(other);
  } else {
    rounding_ = !Update(&best_, &other_, trial);
  }
  if (bracketed_) {
    const double span = std::abs(other_.step - best_.step);
    if (span >= kShrink * width_before_) step_ = best_.step + 0.5 * (other_.step - best_.step);
    width_before_ = width_;
    width_ = span;
  }
  Clip();
  return state_;
}

/// One update of the interval and the next trial step; false where rounding corrupted the values.
bool MoreThuente::Update(Point* best, Point* other, const Point& t) {
  if (bracketed_) {
    const double low = std::min(best->step, other->step), high = std::max(best->step, other->step);
    if (t.step <= low || t.step >= high) return false;
  }
  if (best->slope * (t.step - best->step) >= 0.0) return false;

  const Point b = *best;
  const bool slopes_differ = t.slope * (b.slope / std::abs(b.slope)) < 0.0;
  const double end = t.step > b.step ? highest_ : lowest_;  // of the allowed range, ahead
  double next;
  bool bounded = false;
  if (t.value > b.value) {
    // Case 1: higher. The minimiser is between; the cubic's if it is nearer to the best point.
    const double cubic = CubicMinimiser(b.step, b.value, b.slope, t.step, t.value, t.slope);
    const double quadratic = QuadraticMinimiser(b.step, b.value, b.slope, t.step, t.value);
    next = std::abs(cubic - b.step) < std::abs(quadratic - b.step)
               ? cubic
               : cubic + 0.5 * (quadratic - cubic);
    bracketed_ = bounded = true;
  } else if (slopes_differ) {
    // Case 2: lower, slopes of opposite sign. The farther of cubic and secant step.
    const double cubic = CubicMinimiser(t.step, t.value, t.slope, b.step, b.value, b.slope);
    const double secant = SecantMinimiser(b.step, b.slope, t.step, t.slope);
    next = std::abs(cubic - t.step) > std::abs(secant - t.step) ? cubic : secant;
    bracketed_ = true;
  } else if (std::abs(t.slope) < std::abs(b.slope)) {
    // Case 3: lower, the slope has the same sign and flattens. The cubic may have no minimiser.
    const double cubic =
        CubicMinimiserBeyond(b.step, b.value, b.slope, t.step, t.value, t.slope, end);
    const double secant = SecantMinimiser(b.step, b.slope, t.step, t.slope);
    const bool cubic_nearer = std::abs(t.step - cubic) < std::abs(t.step - secant);
    next = bracketed_ == cubic_nearer ? cubic : secant;
    bounded = true;
  } else {
    // Case 4: lower, the slope does not flatten.
    next = bracketed_
               ? CubicMinimiser(t.step, t.value, t.slope, other->step, other->value, other->slope)
               : end;
  }

  if (t.value > b.value) {
    *other = t;
  } else {
    if (slopes_differ) *other = b;
    *best = t;
  }

  // Before the bracket: no farther than the extrapolation allows.
  next = std::clamp(next, lowest_, highest_);
  if (bracketed_ && bounded) {
    const double farthest = best->step + kShrink * (other->step - best->step);
    next = other->step > best->step ? std::min(next, farthest) : std::max(next, farthest);
  }
  step_ = next;
  return true;
}

}  // namespace touchdown::solvers
