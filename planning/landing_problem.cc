// SPDX-License-Identifier: BSD-3-Clause
// Assembles the landing problem from its terms. With these terms, a fixed interval and fixed pairs
// it is convex: every backend must find the one optimum.

#include "touchdown/planning/landing_problem.h"

#include <stdexcept>
#include <string>

#include "touchdown/planning/terms/arrival_time.h"
#include "touchdown/planning/terms/norm_limit.h"
#include "touchdown/planning/terms/smoothness.h"

namespace touchdown::planning {

namespace {

// Where the hinges turn from cubic to quadratic.
constexpr double kSpeedHingeWidth = 0.3;         // [m/s]
constexpr double kAccelerationHingeWidth = 1.0;  // [m/s^2]

solvers::ProblemShape Shape(int segments, const LandingProblemOptions& options) {
  if (segments < 6) {
    throw std::invalid_argument("LandingProblem: " + std::to_string(segments) +
                                " segments, it needs at least 6");
  }
  if (!(options.limits.speed > 0.0 && options.limits.acceleration > 0.0)) {
    throw std::invalid_argument(
        "LandingProblem: limits are " + std::to_string(options.limits.speed) + " m/s and " +
        std::to_string(options.limits.acceleration) + " m/s^2, both must be > 0");
  }
  solvers::ProblemShape shape;
  shape.blocks = segments + 3;
  shape.free_interval = options.arrival == ArrivalMode::kFree;
  shape.interval_min = options.min_duration / segments;
  shape.interval_max = options.max_duration / segments;
  return shape;
}

}  // namespace

LandingProblem::LandingProblem(int segments, const LandingProblemOptions& options)
    : segments_(segments),
      max_pairs_(options.max_pairs_per_point * (segments + 3)),
      lift_(std::make_shared<BoundaryLift>(segments, options.free_end_acceleration)),
      problem_(Shape(segments, options)) {
  const int n = segments + 3;
  const double margin = options.soft_limit_margin;
  pairs_ = MakeObstaclePairs(n, max_pairs_, options.pair_weight, options.pair_clearance);
  problem_.AddTerm(MakeSmoothness(n, options.smoothness_weight, options.jerk_weight),
                   solvers::Role::kCost);
  problem_.AddTerm(pairs_, solvers::Role::kCost);
  problem_.AddTerm(
      MakeSpeedLimit(n, margin * options.limits.speed, options.speed_weight, kSpeedHingeWidth),
      solvers::Role::kCost);
  problem_.AddTerm(MakeAccelerationLimit(n, margin * options.limits.acceleration,
                                         options.acceleration_weight, kAccelerationHingeWidth),
                   solvers::Role::kCost);
  if (options.arrival == ArrivalMode::kFree) {
    problem_.AddTerm(MakeArrivalTime(n, options.time_weight), solvers::Role::kCost);
  }
  solvers::AffineLift structure = lift_->Structure();
  structure.offset = lift_;
  view_ = std::make_unique<solvers::View>(problem_, std::move(structure));
}

void LandingProblem::SetBoundary(const SplineState& start, double t0,
                                 const estimation::PadPrediction& pad,
                                 const EndpointTarget& target) {
  t0_ = t0;
  problem_.set_t0(t0);
  lift_->Set(start, t0, pad, target);
}

void LandingProblem::SetDuration(double T) { problem_.set_interval(T / segments_); }

Eigen::VectorXd LandingProblem::Guess() const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(view_->num_variables());
  if (view_->free_interval()) y[y.size() - 1] = problem_.interval();
  return y;
}

UniformBspline LandingProblem::Curve(const Eigen::VectorXd& y) const {
  std::vector<double> x;
  double h = 0.0;
  view_->Lift(y.data(), &x, &h);
  return UniformBspline(Eigen::Map<const ControlPoints>(x.data(), 3, segments_ + 3), h, t0_);
}

}  // namespace touchdown::planning
