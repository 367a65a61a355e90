// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "touchdown/planning/problem/term_registry.h"
#include "touchdown/planning/spline/boundary_lift.h"
#include "touchdown/planning/spline/limits.h"
#include "touchdown/planning/spline/uniform_bspline.h"
#include "touchdown/solvers/problem/problem.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::planning {

/// The arrival time is chosen before the solve, or a variable of it.
enum class ArrivalMode { kFixed, kFree };
/// Both ends are eliminated exactly, or equality rows of the term endpoint_state.
enum class EndpointMode { kEliminated, kExplicit };
/// Terms that are limits are costs that act from a margin on, or rows u <= 0 at the full limit.
enum class LimitsMode { kSoft, kHard };

/// How a landing is formulated as a problem: its terms, and how ends and limits are kept.
struct Formulation {
  EndpointMode endpoint = EndpointMode::kEliminated;
  LimitsMode limits_mode = LimitsMode::kSoft;
  bool free_end_acceleration = true;  ///< else the pad's own acceleration at arrival
  VehicleFacts vehicle;
  TermRegistry terms = StandardTerms();  ///< what the objective is built from ...
  std::vector<TermSettings> settings;    ///< ... where it shall differ from the entries' defaults
  int max_pairs_per_point = 6;           ///< at least 2 to keep clear of floor and ceiling
};

struct LandingProblemOptions : Formulation {
  ArrivalMode arrival = ArrivalMode::kFixed;
  Limits limits;
  double max_duration = 30.0;  ///< upper bound of a free arrival [s]
  double min_duration = 0.5;   ///< lower bound of a free arrival [s]
  int max_obstacles = 0;       ///< room for moving ones (SetObstacles)
};

/// What the boundary fixes whatever the solver does: not rows, but facts to check first.
struct BoundaryFacts {
  double start_speed = 0.0;         ///< |v0| [m/s]
  double start_acceleration = 0.0;  ///< |a0| = |A_0| [m/s^2]
  double first_hull_speed = 0.0;    ///< |V_1|, which the start fixes [m/s]
  double end_speed = 0.0;           ///< wanted at the (first guess of the) arrival [m/s]
  bool recovering = false;          ///< the start or V_1 is beyond a limit: RecoveryProfile
  /// The end moves at more than kFastestEndShare of the speed limit: hard limits leave no interior
  /// or next to none.
  bool end_too_fast = false;
};

/// The landing problem (docs/formulation.md): terms over a uniform cubic B-spline whose start is
/// fixed and whose end is the predicted pad at arrival. One instance per number of segments; its
/// parameters change at every replan without allocation.
class LandingProblem {
 public:
  /// Throws std::invalid_argument if segments < 6, an option is out of range, or a setting names
  /// what the registry does not know.
  LandingProblem(int segments, const LandingProblemOptions& options);
  LandingProblem(const LandingProblem&) = delete;
  LandingProblem& operator=(const LandingProblem&) = delete;

  /// Start state at the absolute time t0 and the moving end; until then every evaluation of the problem fails. The
  /// prediction must outlive the solve. The limits are what a steady pull leaves of the options' [m/s^2]
  /// (LimitsUnder). Throws std::invalid_argument if a number is not finite.
  void SetBoundary(const SplineState& start, double t0, const estimation::PadPrediction& pad,
                   const EndpointTarget& target,
                   const Eigen::Vector3d& pull_W = Eigen::Vector3d::Zero());
  void SetBoundary(const SplineState&, double, const estimation::PadPrediction&&,
                   const EndpointTarget&,
                   const Eigen::Vector3d& = Eigen::Vector3d::Zero()) = delete;
  /// Duration, or the first guess of a free one [s]. Throws std::invalid_argument unless 0 < T, finite.
  void SetDuration(double T);
  /// Throws std::invalid_argument if there are more than max_pairs() or one is out of range.
  void SetPairs(std::span<const ObstaclePair> pairs);
  /// Multiplies the weight of every pair (of the terms that keep clear of obstacles).
  void SetPairWeightScale(double scale);
  /// Multiplies the weight of every limit that is a cost.
  void SetLimitWeightScale(double scale);
  int max_pairs() const { return max_pairs_; }
  /// Throws std::invalid_argument if there are more than the option says.
  void SetObstacles(std::span<const MovingObstacle> obstacles);
  /// The plan that the term `consistency` stays near to; null: none. Must outlive the solve.
  void SetPrevious(const UniformBspline* previous);

  int segments() const { return segments_; }
  /// What backends solve: the Reduced view, or with an explicit endpoint the Full one.
  const solvers::View& view() const { return *view_; }

  /// Where its terms act, of those that say so.
  const std::vector<NamedZone>& zones() const { return zones_; }
  /// Of the present boundary and duration. Throws std::invalid_argument before SetBoundary.
  BoundaryFacts boundary_facts() const;

  /// The view's variables at the quintic Hermite guess, and the interval if it is free. This and the following throw
  /// std::invalid_argument before SetBoundary.
  Eigen::VectorXd Guess() const;
  /// The same without allocation, once `y` has this size.
  void Guess(Eigen::VectorXd* y) const;
  /// The variables at the rest of `previous`, stretched to the present duration and moved to the present ends
  /// (planning/problem/warm_start.h). The shape stays, wherever start and pad are now. With an explicit endpoint as
  /// Guess. Does not allocate once `y` has this size.
  void WarmGuess(const UniformBspline& previous, Eigen::VectorXd* y);
  /// The spline at the view's variables y. Allocates its control points.
  UniformBspline Curve(const Eigen::VectorXd& y) const;
  /// The same without allocation, once `curve` has had this many control points.
  void Curve(const Eigen::VectorXd& y, UniformBspline* curve);

 private:
  void AddTerms(const LandingProblemOptions& options);
  void AddTerm(const TermEntry& entry, const LandingProblemOptions& options);
  void Update();
  void RequireBoundary(const char* call) const;

  int segments_;
  int max_pairs_;
  int max_obstacles_;
  bool free_end_acceleration_;
  std::shared_ptr<BoundaryLift> lift_;
  Limits limits_;         // of the options
  VehicleFacts vehicle_;  // alike
  LandingContext context_;
  bool has_boundary_ = false;
  std::vector<ObstaclePair> pairs_;        // what context_ points to
  std::vector<MovingObstacle> obstacles_;  // alike
  std::vector<NamedZone> zones_;
  std::vector<ContextUser*> context_users_;             // among the problem's terms
  std::vector<ContextUser*> clearances_, soft_limits_;  // among these
  std::vector<double> x_;                               // all control points
  ControlPoints shifted_, between_;  // of a warm guess: the curve, the quintic between its ends
  solvers::Problem problem_;
  std::unique_ptr<solvers::View> view_;
};

}  // namespace touchdown::planning
