// SPDX-License-Identifier: BSD-3-Clause
// {p, v} pairs from a guide path, after the idea of EGO-Planner (Zhou et al. 2020, section III-A):
// an obstacle is known to the optimiser only by the half-spaces that keep it off. Planes and rays
// start at the curve itself rather than at the control polygon, because it is the curve that is
// blocked.

#include "touchdown/planning/collision_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "touchdown/planning/voxel_traversal.h"

namespace touchdown::planning {

namespace {

using Eigen::Vector3d;

/// Where the guide crosses the plane through `c` with this normal, nearest to c; its nearest vertex
/// where it does not cross.
Vector3d CrossPlane(const GuidePath& guide, const Vector3d& c, const Vector3d& normal) {
  double best = std::numeric_limits<double>::infinity();
  Vector3d crossing = guide.front();
  const auto offer = [&](const Vector3d& candidate) {
    const double distance = (candidate - c).squaredNorm();
    if (distance < best) {
      best = distance;
      crossing = candidate;
    }
  };
  for (std::size_t i = 0; i + 1 < guide.size(); ++i) {
    const double a = (guide[i] - c).dot(normal), b = (guide[i + 1] - c).dot(normal);
    if ((a <= 0.0) == (b <= 0.0)) continue;
    offer(guide[i] + (guide[i + 1] - guide[i]) * (a / (a - b)));
  }
  if (std::isfinite(best)) return crossing;
  for (const Vector3d& vertex : guide) offer(vertex);
  return crossing;
}

/// The last free point on the way from `from` (free) to `to`; nothing if all of it is free.
std::optional<Vector3d> SurfacePoint(const FreeSpace& space, const Vector3d& from,
                                     const Vector3d& to) {
  const double resolution = space.map->resolution();
  Vector3d last = from;
  const double length = (to - from).norm();
  bool hit = false;
  TraverseCells(from, to, resolution, [&](const CellIndex& cell) {
    if (space.Blocked(cell)) {
      hit = true;
      return false;
    }
    // Where the ray passes nearest to the cell's centre.
    const Vector3d centre = space.map->CentreOf(cell);
    const double s = length > 0.0 ? (centre - from).dot(to - from) / (length * length) : 0.0;
    last = from + std::clamp(s, 0.0, 1.0) * (to - from);
    return true;
  });
  if (!hit) return std::nullopt;
  return last;
}

/// Replaces an earlier pair of the same control point that points nearly the same way.
void Store(const ObstaclePair& pair, std::size_t max_pairs, std::vector<ObstaclePair>* pairs) {
  constexpr double kSameDirection = 0.95;
  for (ObstaclePair& old : *pairs) {
    if (old.control_point == pair.control_point && old.v.dot(pair.v) > kSameDirection) {
      // Keep the farther half-space of the two.
      if ((pair.p - old.p).dot(pair.v) > 0.0) old = pair;
      return;
    }
  }
  if (pairs->size() < max_pairs) pairs->push_back(pair);
}

}  // namespace

int BindPairs(const UniformBspline& curve, const BlockedRun& run, const GuidePath& guide,
              const FreeSpace& space, std::size_t max_pairs, std::vector<ObstaclePair>* pairs) {
  if (guide.empty()) return 0;
  const int n = static_cast<int>(curve.control_points().cols());
  const double h = curve.interval();
  const double t_mid = 0.5 * (run.t_in + run.t_out);
  const auto time_of = [&](int j) { return curve.t0() + (j - 1) * h; };
  const auto index_of = [&](double t) {
    return static_cast<int>(std::lround((t - curve.t0()) / h)) + 1;
  };
  int bound = 0;
  const auto bind = [&](int j, double t) {
    const FlatState at = curve.Evaluate(t);
    Vector3d tangent = at.v_WB;
    if (tangent.norm() < 1e-6) tangent = guide.back() - guide.front();
    const Vector3d s = CrossPlane(guide, at.p_WB, tangent);
    const Vector3d outward = s - at.p_WB;
    if (outward.norm() < 1e-3) return;
    const std::optional<Vector3d> surface = SurfacePoint(space, s, at.p_WB);
    if (!surface) return;
    Store({j, *surface, outward.normalized()}, max_pairs, pairs);
    ++bound;
  };
  const int first = std::clamp(index_of(run.t_in), 3, n - 4);
  const int last = std::clamp(index_of(run.t_out), 3, n - 4);
  for (int j = first; j <= last; ++j) bind(j, std::clamp(time_of(j), run.t_in, run.t_out));
  // A run shorter than the knot interval can lie between the control points' instants.
  if (bound == 0) bind(std::clamp(index_of(t_mid), 3, n - 4), t_mid);
  return bound;
}

}  // namespace touchdown::planning
