// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/backend/solver_options.h"
#include "touchdown/solvers/backend/whitening.h"

namespace touchdown::solvers {

/// The evaluator for backends that work on whitened variables z (whitening.h). It evaluates one
/// point at a time: objective, gradient and rows in z. Without whitening z is the view's y. The
/// same holds where the costs' nominal curvature is singular, such as that of a linear cost,
/// because that metric means nothing. It also holds where variables have bounds, because z has
/// none.
class WhitenedPoint {
 public:
  struct Settings {
    bool whiten = true;
    /// For methods that know no bounds, or take their step size from them. z's last number becomes
    /// an angle (whitened_point.cc). Every value of it keeps a free interval inside its bounds.
    bool interval_as_angle = false;
  };

  /// Allocates for views of this structure.
  void Prepare(const View& view);

  /// Starts a solve: evaluates at y, with gradients, and takes the metric there. False if a term
  /// cannot be evaluated. All arguments outlive the solve. Does not allocate.
  bool Begin(const View& view, const double* y, const Settings& settings, Evaluator* evaluator);

  /// Continues from z with the metric at that point; z() is then the same point in it. If the point
  /// cannot be evaluated, the metric stays. For methods at the end of a leg (MetricLegs). Does not
  /// allocate.
  void RenewMetric(const View& view, const double* z);

  int size() const { return static_cast<int>(z_.size()); }
  bool whitened() const { return whiten_; }
  /// The last point; after Begin the first.
  const double* z() const { return z_.data(); }
  /// A free interval is z's last number divided by this, unless it is an angle.
  double interval_scale() const { return whiten_ ? whitening_.interval_scale() : 1.0; }

  /// Moves to z; false if a term cannot be evaluated there.
  bool Evaluate(const double* z, bool gradient);
  /// As Evaluator::EvaluateLagrangian, at z; only without whitening.
  bool EvaluateLagrangian(const double* z, const Lagrangian& lagrangian);
  const ViewEvaluation& last() const { return evaluator_->last(); }
  double value() const { return last().full.value; }
  /// The objective's gradient in z, at a point evaluated with it.
  void Gradient(double* out) const;
  /// In place: a dense row in y becomes one in z.
  void RowToWhite(double* row) const;

  /// Whether the metric promises only a negligible decrease at the best point. The decrease is
  /// |g|^2 / 2 in z, compared with its cost (or a small share of the first cost). The interval's
  /// component of g is left out if it points out of the bounds. Always false without whitening,
  /// where |g| has no such meaning. Moves to that point.
  bool StationaryAtBest(double first_cost);

  /// Whether the best point so far changed since the last call, or since Begin. `step` receives how
  /// far it moved in the view's variables.
  bool Improved(double* step);

 private:
  void MoveTo(const double* z);
  void StartAngle();

  const View* view_ = nullptr;
  Whitening whitening_;
  ViewEvaluation metric_;  // where the metric is taken
  Evaluator* evaluator_ = nullptr;
  bool whiten_ = false;
  bool angle_ = false;
  double middle_ = 0.0, half_ = 0.0, unit_ = 1.0;  // of the angle
  double slope_ = 1.0;                             // of the scaled interval in it
  std::vector<double> z_, y_, plain_;              // plain_: z with the scaled interval, no angle
  Eigen::VectorXd best_;
  double best_cost_ = 0.0, best_violation_ = 0.0;
};

/// How long a quasi-Newton method keeps one metric. Hinges that are inactive at the start have no
/// curvature in the metric. If many of them matter, the method has to find their curvature itself.
/// A new metric at a better point costs less. Each leg is 1.5 times as long as the one before, so
/// that the method can converge undisturbed in the end.
class MetricLegs {
 public:
  static OptionSpec Option() {
    return {"metric_evaluations",
            20.0,
            0.0,
            1e6,
            true,
            "evaluations until the metric is taken anew; 0: never"};
  }

  /// `first`: evaluations of the first leg, <= 0 for one without end.
  explicit MetricLegs(double first) : length_(first) {}

  bool endless() const { return length_ <= 0.0; }
  int length() const { return static_cast<int>(length_); }
  void Next() { length_ *= 1.5; }

 private:
  double length_;
};

}  // namespace touchdown::solvers
