// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::solvers {

/// Parameters of the line search, in the paper's letters.
struct MoreThuenteOptions {
  double sufficient_decrease = 1e-4;  ///< mu: f(a) <= f(0) + mu a f'(0)
  double curvature = 0.9;             ///< eta: |f'(a)| <= eta |f'(0)|
  double interval_tolerance = 1e-16;  ///< relative width at which a bracket counts as a point
  double min_step = 1e-20;
  double max_step = 1e20;
  int max_evaluations = 40;
};

enum class LineSearchState {
  kEvaluate,          ///< wants value and slope at step()
  kConverged,         ///< both conditions hold at step()
  kRounding,          ///< rounding leaves no step between the ends of the bracket
  kIntervalTooSmall,  ///< the bracket is narrower than interval_tolerance
  kAtMinStep,
  kAtMaxStep,
  kEvaluationLimit,
};

/// Line search along f(a), a > 0, as a state machine: no callback, no allocation.
/// Source: J. J. More and D. J. Thuente, "Line search algorithms with guaranteed sufficient
/// decrease", ACM TOMS 20(3), 1994, sections 2-4. A step at which the function cannot be evaluated
/// (not finite) becomes an upper bound of later ones.
class MoreThuente {
 public:
  /// From value f(0), slope f'(0) < 0 and a first step in [min_step, max_step].
  void Begin(double value, double slope, double step, const MoreThuenteOptions& options);

  double step() const { return step_; }
  LineSearchState state() const { return state_; }

  /// Takes value and slope at step() and chooses the next one.
  LineSearchState Observe(double value, double slope);

 private:
  struct Point {
    double step, value, slope;
  };
  void ShrinkFromFailure();
  bool Update(Point* best, Point* other, const Point& trial);
  void Clip();

  MoreThuenteOptions options_;
  double start_value_ = 0.0, start_slope_ = 0.0;
  Point best_{}, other_{};  // ends of the interval of uncertainty; best_ has the least value
  bool bracketed_ = false;
  bool first_stage_ = true;  // on the auxiliary function psi
  bool rounding_ = false;
  double lowest_ = 0.0, highest_ = 0.0;  // of the next step
  double width_ = 0.0, width_before_ = 0.0;
  double failed_step_ = 0.0;
  int evaluations_ = 0;
  double step_ = 0.0;
  LineSearchState state_ = LineSearchState::kConverged;
};

}  // namespace touchdown::solvers
