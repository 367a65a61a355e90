// SPDX-License-Identifier: BSD-3-Clause
// The whole-curve check. Chords are so short that the curve leaves them by at most 2 mm: the
// sagitta is <= a dt^2 / 8 with a the largest acceleration of the segment. Every cell that a chord
// passes is visited. So no sampling step can jump over a clipped corner.

#include "touchdown/planning/certify/curve_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/map/voxel_traversal.h"

namespace touchdown::planning {

namespace {

/// Calls visit(t_a, t_b, blocked) for every chord in order; visit returns false to end.
template <class Visit>
void ForEachChord(const UniformBspline& curve, double t_from, const FreeSpace& space,
                  Visit&& visit) {
  double t = std::clamp(t_from, curve.t0(), curve.t_end());
  Eigen::Vector3d p = curve.Position(t);
  const double h = curve.interval();
  int segment = std::min(static_cast<int>((t - curve.t0()) / h), curve.segments() - 1);
  for (; segment < curve.segments(); ++segment) {
    const double t_end =
        segment + 1 == curve.segments() ? curve.t_end() : curve.t0() + (segment + 1) * h;
    const double a = std::max(curve.AtKnot(segment).a.norm(), curve.AtKnot(segment + 1).a.norm());
    const double dt_max = a > 0.0 ? std::sqrt(8.0 * kChordSagitta / a) : h;
    const int chords = std::max(1, static_cast<int>(std::ceil((t_end - t) / dt_max)));
    const double t_start = t;
    for (int i = 1; i <= chords; ++i) {
      const double t_next = t_start + (t_end - t_start) * i / chords;
      const Eigen::Vector3d p_next = curve.Position(t_next);
      const bool clear = !space.OffLevel(p) && !space.OffLevel(p_next) &&
                         TraverseCells(p, p_next, space.map->resolution(),
                                       [&](const CellIndex& cell) { return !space.Closed(cell); });
      if (!visit(t, t_next, !clear)) return;
      t = t_next;
      p = p_next;
    }
  }
}

}  // namespace

void FindBlockedRuns(const UniformBspline& curve, double t_from, const FreeSpace& space,
                     std::vector<BlockedRun>* runs) {
  runs->clear();
  bool inside = false;
  const double t_first = std::clamp(t_from, curve.t0(), curve.t_end());
  ForEachChord(curve, t_from, space, [&](double t_a, double t_b, bool blocked) {
    if (blocked && !inside) {
      const bool at_start = t_a == t_first && space.Blocked(curve.Position(t_a));
      runs->push_back({t_a, t_b, at_start, false});
    }
    // A chord that only starts in a blocked cell still belongs to the run: its end is free.
    if (blocked) runs->back().t_out = t_b;
    inside = blocked;
    return true;
  });
  if (inside && space.Blocked(curve.Position(curve.t_end()))) runs->back().at_end = true;
}

double FirstBlockedTime(const UniformBspline& curve, double t_from, const FreeSpace& space) {
  double first = std::numeric_limits<double>::infinity();
  ForEachChord(curve, t_from, space, [&](double t_a, double, bool blocked) {
    if (blocked) first = t_a;
    return !blocked;
  });
  return first;
}

}  // namespace touchdown::planning
