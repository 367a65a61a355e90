// SPDX-License-Identifier: BSD-3-Clause
// Where the control polygon meets obstacles, and the {p, v} pairs that lead it out (Zhou et al.,
// algorithm 1 and section III-A). The scan's rules (two free samples between stretches, two thirds
// of the polygon, a step by the mean spacing) are those of the published system.

#include "planning/baselines/ego/collision_segments.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr int kSettled = 2;         // samples of one kind after which a change counts
constexpr double kNoLength = 1e-5;  // shorter ways to the path give no direction [m]
constexpr double kShortest = 0.01;  // the same for a segment without inner control points [m]

/// Where `path`, walked from its middle, crosses the plane through q normal to `tangent`.
bool CrossPlane(const std::vector<Eigen::Vector3d>& path, const Eigen::Vector3d& q,
                const Eigen::Vector3d& tangent, Eigen::Vector3d* crossing) {
  const int size = static_cast<int>(path.size());
  int id = size / 2;
  if (size < 2) return false;
  double ahead = (path[id] - q).dot(tangent);
  const int step = ahead >= 0.0 ? -1 : 1;  // the path runs along the tangents
  for (int next = id + step; next >= 0 && next < size; id = next, next += step) {
    const double value = (path[next] - q).dot(tangent);
    if (value * ahead <= 0.0 && (value != 0.0 || ahead != 0.0)) {
      *crossing = path[next] + value / (value - ahead) * (path[id] - path[next]);
      return true;
    }
    ahead = value;
  }
  return false;
}

/// The last free point on the way from `from` back to q, in steps of a cell.
Eigen::Vector3d SurfacePoint(const Eigen::Vector3d& from, const Eigen::Vector3d& q,
                             const EgoGrid& grid) {
  const double cell = grid.resolution();
  const Eigen::Vector3d v = (from - q).normalized();
  double a = (from - q).norm();
  for (;; a -= cell) {
    const bool occupied = grid.Occupied(q + a * v);
    if (occupied) return q + (a + cell) * v;
    if (a < cell) return q + a * v;
  }
}

}  // namespace

std::vector<CollisionSegment> FindCollisionSegments(const ControlPoints& q, const EgoGrid& grid) {
  const int N = static_cast<int>(q.cols());
  const int p = kEgoDegree;
  const int last = N - p - (N - 2 * p) / 3;
  const double spacing = (q.col(0) - q.col(N - 1)).norm() / (N - 1);
  const double step = 0.5 * grid.resolution() / std::max(spacing, 1e-3);

  std::vector<CollisionSegment> segments;
  int in = -1, out = -1;
  bool blocked = false, left = false;
  int same = kSettled + 1;
  for (int i = p; i <= last; ++i) {
    for (double a = 1.0; a > 0.0; a -= step) {
      const bool now = grid.Occupied(a * q.col(i - 1) + (1.0 - a) * q.col(i));
      if (now == blocked) {
        ++same;
      } else {
        if (now && (same > kSettled || i == p)) in = i - 1;
        if (!now) out = i;
        left = !now;
        same = 0;
      }
      blocked = now;
      const bool over = left && (same > kSettled || i == N - p);
      if (!over) continue;
      left = false;
      if (in < 0) continue;
      segments.push_back({in, out});
      in = -1;
    }
  }
  return segments;
}

bool FindNewObstacles(const ControlPoints& q, const EgoGrid& grid, const SurfacePairs& pairs,
                      std::vector<CollisionSegment>* segments) {
  segments->clear();
  const int N = static_cast<int>(q.cols());
  const int p = kEgoDegree;
  const int end = N - p;
  const int last = end - (end - p) / 3;
  for (int i = p - 1; i <= last; ++i) {
    if (!grid.Occupied(q.col(i))) continue;
    const auto beyond = [&](const SurfacePair& pair) {
      return (q.col(i) - pair.p).dot(pair.v) >= grid.resolution();
    };
    if (!std::all_of(pairs[i].begin(), pairs[i].end(), beyond)) continue;
    int in = i - 1;
    while (in > 0 && grid.Occupied(q.col(in))) --in;
    int out = i + 1;
    while (out < N && grid.Occupied(q.col(out))) ++out;
    if (out >= N) return false;
    segments->push_back({in, out});
    i = out;
  }
  return true;
}

bool BindSurfacePairs(const ControlPoints& q, const CollisionSegment& segment,
                      const std::vector<Eigen::Vector3d>& path, const EgoGrid& grid,
                      SurfacePairs* pairs) {
  const auto [in, out] = segment;
  Eigen::Vector3d s;
  if (out - in == 1) {
    const Eigen::Vector3d middle = 0.5 * (q.col(in) + q.col(out));
    if (CrossPlane(path, middle, q.col(out) - q.col(in), &s) && (s - middle).norm() > kShortest) {
      (*pairs)[in].push_back({q.col(in), (s - middle).normalized()});
    }
    return true;
  }
  std::vector<bool> crossed(static_cast<std::size_t>(out - in), false);
  int some = -1;
  for (int j = in + 1; j < out; ++j) {
    if (!CrossPlane(path, q.col(j), q.col(j + 1) - q.col(j - 1), &s)) continue;
    crossed[j - in] = true;
    some = j;
    const Eigen::Vector3d way = s - q.col(j);
    if (way.norm() > kNoLength) {
      (*pairs)[j].push_back({SurfacePoint(s, q.col(j), grid), way.normalized()});
    }
  }
  if (some < 0) return true;
  const auto copy = [&](int from, int to) {
    if ((*pairs)[from].empty()) return false;
    (*pairs)[to].push_back((*pairs)[from].back());
    return true;
  };
  for (int j = some + 1; j < out; ++j) {
    if (!crossed[j - in] && !copy(j - 1, j)) return false;
  }
  for (int j = some - 1; j > in; --j) {
    if (!crossed[j - in] && !copy(j + 1, j)) return false;
  }
  return true;
}

bool FirstTwoThirdsBlocked(const UniformBspline& curve, const EgoGrid& grid, double* t) {
  const double T = curve.duration();
  const double distance =
      (curve.Evaluate(curve.t_end()).p_WB - curve.Evaluate(curve.t0()).p_WB).norm();
  const double step = T * grid.resolution() / std::max(distance, grid.resolution());
  for (*t = 0.0; *t < 2.0 / 3.0 * T; *t += step) {
    if (grid.Occupied(curve.Evaluate(curve.t0() + *t).p_WB)) return true;
  }
  return false;
}

}  // namespace touchdown::planning
