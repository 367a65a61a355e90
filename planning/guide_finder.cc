// SPDX-License-Identifier: BSD-3-Clause
// Guides tell the side on which an obstacle is passed, no more: so A* may be greedy, sees the map in blocks
// first, and keeps off walls; and the curve that is flown already is as good a guide as any.

#include "touchdown/planning/guide_finder.h"

#include <algorithm>
#include <cmath>

#include "touchdown/planning/voxel_traversal.h"

namespace touchdown::planning {

namespace {

constexpr double kGuideStep = 0.05;   // sampling of a curve as a guide [s]
constexpr double kGreed = 4.0;        // of A*
constexpr double kTightCost = 8.0;    // of A*, beside obstacles
constexpr double kBeside = 0.5;       // a curve that is on a way's side stays there for so long [s]
constexpr double kLevelMargin = 0.3;  // of a guide from floor and ceiling, out of the window [m]
constexpr int kDetourExpansions = 1000;
/// A way that is found only after so many cells is a long one.
constexpr int kOtherWayExpansions = 1000;
constexpr int kOtherWayAtRest = 12000;
constexpr int kLocalExpansions = 3000;

void SampleGuide(const UniformBspline& curve, double from, double to, GuidePath* guide) {
  guide->clear();
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kGuideStep)));
  for (int i = 0; i <= steps; ++i) {
    guide->push_back(curve.Position(from + (to - from) * i / steps));
  }
}

void EndInWindow(const UniformBspline& curve, const OccupancyMap& map, BlockedRun* run) {
  const auto in_window = [&](double t) { return map.InWindow(map.CellOf(curve.Position(t))); };
  if (!in_window(run->t_in)) return;
  while (!in_window(run->t_out)) run->t_out = std::max(run->t_in, run->t_out - kGuideStep);
}

}  // namespace

GuideFinder::GuideFinder(double vertical_cost)
    : search_(vertical_cost, kGreed, kTightCost, /*blocks_first=*/true) {
  barriers_.reserve(8);
}

void GuideFinder::Begin(bool at_rest) {
  barriers_.clear();
  committed_.Clear();
  at_rest_ = at_rest;
}

void GuideFinder::Keep(const UniformBspline& committed, double t_from, const FreeSpace& space) {
  const int budget = std::min(expansions_left_, kDetourExpansions);
  const int spent = committed_.Follow(committed, t_from, space, budget, &search_);
  expansions_left_ = std::max(1, expansions_left_ - spent);
}

void GuideFinder::EndBesideKept(const FreeSpace& space, const UniformBspline& curve,
                                BlockedRun* run) const {
  const auto is_free = [&](const CellIndex& cell) { return !space.Blocked(cell); };
  const auto sees_way = [&](double t) {
    const Eigen::Vector3d way = committed_.At((t - curve.t0()) / curve.duration());
    return TraverseCells(curve.Position(t), way, space.map->resolution(), is_free);
  };
  for (double t = run->t_out; t < curve.t_end(); t += kGuideStep) {
    if (!sees_way(t)) run->t_out = std::min(t + kBeside, curve.t_end());
  }
}

SearchStatus GuideFinder::Find(const FreeSpace& space, const UniformBspline& curve, bool local,
                               BlockedRun* run, GuidePath* guide) {
  EndInWindow(curve, *space.map, run);
  if (Keeps(*run)) {
    // The same share of the way that is left, wherever the arrival is now.
    const auto share = [&](double t) { return (t - curve.t0()) / curve.duration(); };
    committed_.Sample(share(run->t_in), share(run->t_out), guide);
    return SearchStatus::kFound;
  }
  const int other_way = at_rest_ ? kOtherWayAtRest : kOtherWayExpansions;
  int budget = expansions_left_;
  if (local) budget = std::min(budget, kLocalExpansions);
  if (!barriers_.empty()) budget = std::min(budget, other_way);
  const SearchStatus status = search_.Search(space, curve.Position(run->t_in),
                                             curve.Position(run->t_out), budget, guide, barriers_);
  expansions_left_ = std::max(1, expansions_left_ - search_.expansions());
  if (status == SearchStatus::kEndsOutside) {
    // Out of the window only floor and ceiling block: between them leads the way.
    SampleGuide(curve, run->t_in, run->t_out, guide);
    for (Eigen::Vector3d& p : *guide) {
      p.z() =
          std::max(std::min(p.z(), space.ceiling - kLevelMargin), space.FloorAt(p) + kLevelMargin);
    }
  }
  return status;
}

}  // namespace touchdown::planning
