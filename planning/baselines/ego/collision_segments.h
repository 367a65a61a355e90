// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "planning/baselines/ego/ego_grid.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Degree of the spline; so many control points at either end are fixed.
inline constexpr int kEgoDegree = 3;

/// A {p, v} pair: the control point shall stay `clearance` beyond the plane through p normal to v
/// (Zhou et al., eq. 2).
struct SurfacePair {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< on the obstacle's surface, in W [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< unit vector out of the obstacle
};
/// Of each control point. Pairs are only ever added during a plan call.
using SurfacePairs = std::vector<std::vector<SurfacePair>>;

/// Blocked stretch of the control polygon between two free control points.
struct CollisionSegment {
  int in;
  int out;
};

/// Scans the polygon from control point p on over its nearer two thirds, in steps of about half a
/// cell. A stretch that is still blocked at the end of the scan is left out, as published.
std::vector<CollisionSegment> FindCollisionSegments(const ControlPoints& q, const EgoGrid& grid);

/// The stretches of *new* obstacles, for use during the optimisation. A control point is in one if
/// its cell is occupied and it is beyond all of its own pairs by a cell. False if a stretch has no
/// free control point after it (the published planner's "terminal point in obstacle").
bool FindNewObstacles(const ControlPoints& q, const EgoGrid& grid, const SurfacePairs& pairs,
                      std::vector<CollisionSegment>* segments);

/// Adds pairs to the control points inside of `segment`. The pairs lead to `path`, a free way
/// around the obstacle from its entry to its exit. False if a control point must copy its
/// neighbour's pair and there is none.
bool BindSurfacePairs(const ControlPoints& q, const CollisionSegment& segment,
                      const std::vector<Eigen::Vector3d>& path, const EgoGrid& grid,
                      SurfacePairs* pairs);

/// Whether the curve's first two thirds are blocked. It is sampled as published, in steps that
/// would be a cell if the curve were straight and its speed constant. `t` receives the first hit,
/// from the start of the curve [s].
bool FirstTwoThirdsBlocked(const UniformBspline& curve, const EgoGrid& grid, double* t);

}  // namespace touchdown::planning
