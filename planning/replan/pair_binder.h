// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "planning/search/corridor.h"
#include "planning/search/timed_path.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/problem/bound_part.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/problem/step_constants.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Chooses the half-spaces {p, v} of the control points of a curve that is blocked. Points along a guide past the
/// obstacle get the convex piece of free space around their place on the guide. Points beside it get the piece around
/// their place on the curve. Points bound in one round stay bound in the next, around where the curve is then.
class PairBinder {
 public:
  static constexpr int kMostControlPoints = 67;  ///< of a curve

  /// Throws std::invalid_argument unless formulation.max_pairs_per_point >= 2: floor and ceiling need them.
  explicit PairBinder(const Formulation& formulation, const StepConstants& constants = {});

  /// Nothing is bound any more. Throws std::invalid_argument for more than kMostControlPoints.
  void Begin(int control_points);

  /// The first round of a way. It binds the parts of the way that have to be bound, what is beside them, and `more`,
  /// in the time of the curve that the way follows. The control points are wanted on the way, in even steps of its
  /// time.
  void Lead(const TimedPath& way, const BoundParts& more);

  /// A later round: the control points are wanted on this curve.
  void Start(const UniformBspline& curve);

  /// What is bound now, in time on this curve. Does not allocate once `parts` has room for kMostControlPoints.
  void Remember(const UniformBspline& curve, BoundParts* parts) const;

  /// Where the curve is blocked in `run`, its control points are wanted along the guide, as near to
  /// the curve as the obstacle allows. The guide has at least one point.
  void Follow(const UniformBspline& curve, const BlockedRun& run, const GuidePath& guide,
              const FreeSpace& space);

  /// The guide leads past a corner that the curve cuts between two control points in `run`. Both get the plane there.
  void AddCorner(const UniformBspline& curve, const BlockedRun& run, const GuidePath& guide,
                 const FreeSpace& space);

  /// The pairs of this round, at most LandingProblem::max_pairs(). Does not allocate once `pairs` has
  /// room.
  void Bind(const FreeSpace& space, std::vector<ObstaclePair>* pairs);

 private:
  struct Corner {
    double place;  // on the curve of the round [intervals]
    int before;    // the control point that comes before it
    Eigen::Vector3d p;
  };

  void BindCorner(double place, const Eigen::Vector3d& p);

  StepConstants constants_;
  Corridor corridor_;
  int planes_;     // of a control point, besides those for floor and ceiling
  int per_point_;  // with those
  std::vector<char> bound_;
  std::array<Eigen::Vector3d, kMostControlPoints> reference_;  // where control points are wanted
  std::vector<Corner> corners_;
};

}  // namespace touchdown::planning
