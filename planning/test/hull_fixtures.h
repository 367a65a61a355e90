// SPDX-License-Identifier: BSD-3-Clause
// The hull's ball tested cell by cell, without rows of bits and without steps along the way. The tests of the safety
// rule compare with it.
#pragma once

#include <algorithm>
#include <cmath>

#include "planning/test/small_map.h"
#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::planning {

inline constexpr double kHull = 0.404;      // 0.324 m and 0.08 m of margins
inline constexpr double kHullRoom = 0.01;   // that SweepHull adds for what is between its samples
inline constexpr double kDenseStep = 4e-3;  // of a look along a curve [s]

/// From a point to the nearest one of a cell [m].
inline double DistanceToCell(const OccupancyMap& map, const CellIndex& cell,
                             const Eigen::Vector3d& p_W) {
  const double half = 0.5 * map.resolution();
  return ((p_W - map.CentreOf(cell)).cwiseAbs().array() - half).max(0.0).matrix().norm();
}

/// Calls visit(cell, distance) for every cell that the ball touches.
template <class Visit>
void ForEachTouched(const OccupancyMap& map, const Eigen::Vector3d& p_W, double radius,
                    Visit&& visit) {
  const CellIndex low = map.CellOf(p_W.array() - radius), high = map.CellOf(p_W.array() + radius);
  ForEachCell({low, high + CellIndex::Ones()}, [&](const CellIndex& cell) {
    const double distance = DistanceToCell(map, cell, p_W);
    if (distance < radius) visit(cell, distance);
  });
}

/// Whether a ball at p_W touches only cells that are observed free. Cells below the ground height are excepted. So
/// are cells that the start's ball (larger by kHullRoom) reached into and that are no nearer by more than `nearer`
/// [m].
inline bool BallInFree(const OccupancyMap& map, const Eigen::Vector3d& p_W, double radius,
                       const Eigen::Vector3d* p_start_W = nullptr, double nearer = 0.0) {
  bool free = true;
  ForEachTouched(map, p_W, radius, [&](const CellIndex& cell, double distance) {
    const double top = (cell.z() + 1) * map.resolution();
    if (map.IsObservedFree(cell) || top <= map.options().ground_height + 1e-9) return;
    if (p_start_W != nullptr) {
      const double at_start = DistanceToCell(map, cell, *p_start_W);
      const bool was_there = at_start > 0.0 && at_start < kHull + kHullRoom;
      if (was_there && distance >= at_start - nearer) return;
    }
    free = false;
  });
  return free;
}

/// The same all along a curve, or `place(t)`.
template <class Place>
bool TubeInFree(const OccupancyMap& map, double t_from, double t_to, double radius,
                const Eigen::Vector3d* p_start_W, double nearer, Place&& place) {
  const int steps = std::max(1, static_cast<int>(std::ceil((t_to - t_from) / kDenseStep)));
  for (int i = 0; i <= steps; ++i) {
    const double t = t_from + (t_to - t_from) * i / steps;
    if (!BallInFree(map, place(t), radius, p_start_W, nearer)) return false;
  }
  return true;
}

inline UniformBspline Between(const SplineState& from, const SplineState& to, double duration,
                              double t0 = 0.0) {
  return {HermiteControlPoints(from, to, 12, duration), duration / 12, t0};
}

/// A small map in which nothing is ground.
inline OccupancyMapOptions NoGround() {
  OccupancyMapOptions options = SmallMap(0.3);
  options.ground_height = -100.0;
  return options;
}

/// All observed free, except `boxes` random boxes beyond `keep_free` of the origin that were never seen or are
/// obstacles.
inline OccupancyMap RandomMap(Draw* draw, int boxes, double keep_free,
                              const OccupancyMapOptions& options = NoGround()) {
  OccupancyMap map(options);
  map.MarkRestFree();
  const Eigen::Vector3d extent = 0.5 * options.resolution * map.size().cast<double>();
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector3d at = draw->Vector(1.0).cwiseProduct(extent);
    const CellIndex low = map.CellOf(at);
    const CellIndex side = (draw->Vector(2.5).array() + 3.6).matrix().cast<int>();
    const CellState state = draw->Uniform(0, 1) < 0.5 ? CellState::kUnknown : CellState::kOccupied;
    ForEachCell({low, low + side}, [&](const CellIndex& cell) {
      if (DistanceToCell(map, cell, Eigen::Vector3d::Zero()) < keep_free) return;
      map.SetState(cell, state);
    });
  }
  return map;
}

inline HullSpace HullOf(const FreeSpace& space) {
  HullSpace hull;
  hull.space = &space;
  hull.hull_radius = kHull;
  return hull;
}

}  // namespace touchdown::planning
