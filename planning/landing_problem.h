// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "touchdown/planning/boundary_lift.h"
#include "touchdown/planning/limits.h"
#include "touchdown/planning/terms/obstacle_pair.h"
#include "touchdown/planning/uniform_bspline.h"
#include "touchdown/solvers/problem.h"
#include "touchdown/solvers/view.h"

namespace touchdown::planning {

enum class ArrivalMode { kFixed, kFree };

struct LandingProblemOptions {
  ArrivalMode arrival = ArrivalMode::kFixed;
  bool free_end_acceleration = true;  ///< else the pad's own acceleration at arrival
  Limits limits;
  double soft_limit_margin = 0.93;  ///< soft limits act from this share of the hard ones
  double smoothness_weight = 1.0;   ///< on int |a|^2 dt
  double jerk_weight = 0.1;         ///< on int |j|^2 dt, relative to the acceleration [s^2]
  double pair_weight = 3000.0;
  double pair_clearance = 0.30;  ///< s_f, beyond the inflation radius [m]
  double speed_weight = 300.0;
  double acceleration_weight = 30.0;
  double time_weight = 30.0;   ///< price of a second, free arrival only
  double max_duration = 30.0;  ///< upper bound of a free arrival [s]
  double min_duration = 0.5;   ///< lower bound of a free arrival [s]
  int max_pairs_per_point = 6;
};

/// The landing problem (docs/formulation.md): smoothness, {p, v} pairs and norm limits over a uniform
/// cubic B-spline whose start is fixed and whose end is the predicted pad at arrival, both
/// eliminated exactly. One instance per number of segments; its parameters change at every replan
/// without allocation.
class LandingProblem {
 public:
  /// Throws std::invalid_argument if segments < 6 or an option is out of range.
  LandingProblem(int segments, const LandingProblemOptions& options);

  /// Start state at the absolute time t0 and the moving end. The prediction must outlive the solve.
  void SetBoundary(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                   const EndpointTarget& target);
  /// Duration, or the first guess of a free one [s].
  void SetDuration(double T);
  /// Throws std::invalid_argument if there are more than max_pairs().
  void SetPairs(std::span<const ObstaclePair> pairs) { pairs_->SetPairs(pairs); }
  /// Multiplies the weight of every pair.
  void SetPairWeightScale(double scale) { pairs_->SetWeightScale(scale); }
  int max_pairs() const { return max_pairs_; }

  int segments() const { return segments_; }
  /// The Reduced view, which backends solve.
  const solvers::View& view() const { return *view_; }

  /// Reduced variables of the Hermite guess: zero, and the interval if it is free.
  Eigen::VectorXd Guess() const;
  /// The spline at reduced variables y. Allocates its control points.
  UniformBspline Curve(const Eigen::VectorXd& y) const;

 private:
  int segments_;
  int max_pairs_;
  double t0_ = 0.0;
  std::shared_ptr<BoundaryLift> lift_;
  std::shared_ptr<ObstaclePairs> pairs_;
  solvers::Problem problem_;
  std::unique_ptr<solvers::View> view_;
};

}  // namespace touchdown::planning
