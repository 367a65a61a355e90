// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include "touchdown/solvers/term.h"

namespace touchdown::planning {

/// One {p, v} pair of a control point: the half-space that keeps it off an obstacle.
struct ObstaclePair {
  int control_point = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();   ///< on the surface of the inflated obstacle [m]
  Eigen::Vector3d v = Eigen::Vector3d::UnitX();  ///< unit vector out of it
};

/// Distance of control points to their obstacles: d = (Q_i - p) . v wants to be >= s_f. Inner map
/// u = s_f - d [m], cubic-quadratic hinge. Convex. Source: EGO-Planner (Zhou et al. 2020), eq. 4-5.
class ObstaclePairs : public solvers::Term {
 public:
  /// Replaces the pairs; at most `max_pairs`, control points in range. Throws std::invalid_argument
  /// otherwise. Does not allocate.
  virtual void SetPairs(std::span<const ObstaclePair> pairs) = 0;
  /// Multiplies the weight that the term was made with: re-binding rounds press harder.
  virtual void SetWeightScale(double scale) = 0;
};

/// `weight` >= 0; `clearance` s_f > 0 [m]. Allocates for `max_pairs`.
std::shared_ptr<ObstaclePairs> MakeObstaclePairs(int control_points, int max_pairs, double weight,
                                                 double clearance);

/// Its registry entry.
solvers::TermFactory ObstaclePairFactory();

}  // namespace touchdown::planning
