// SPDX-License-Identifier: BSD-3-Clause
// A path gives the side on which an obstacle is passed, and how long that takes. So a search may be
// greedy, and the curve that is flown already is as good a path as any. If a wall turns out to be
// longer than it seemed, the committed path moves by its length. The choice of the path stays.

#include "planning/search/path_finder.h"

#include <algorithm>
#include <cmath>

#include "planning/map/voxel_traversal.h"

namespace touchdown::planning {

namespace {

constexpr double kCurveStep = 0.05;   // sampling of a curve [s]
constexpr double kLevelMargin = 0.3;  // of a path from floor and ceiling, out of the window [m]

void CutToWindow(const UniformBspline& curve, const OccupancyMap& map, BlockedRun* run) {
  const auto in_window = [&](double t) { return map.InWindow(map.CellOf(curve.Position(t))); };
  if (!in_window(run->t_in)) return;
  while (!in_window(run->t_out)) run->t_out = std::max(run->t_in, run->t_out - kCurveStep);
}

void SampleBetweenLevels(const UniformBspline& curve, const BlockedRun& run, const FreeSpace& space,
                         GuidePath* path) {
  path->clear();
  const double time = run.t_out - run.t_in;
  const int steps = std::max(1, static_cast<int>(std::ceil(time / kCurveStep)));
  for (int i = 0; i <= steps; ++i) {
    Eigen::Vector3d p = curve.Position(run.t_in + i * time / steps);
    p.z() =
        std::max(std::min(p.z(), space.ceiling - kLevelMargin), space.FloorAt(p) + kLevelMargin);
    path->push_back(p);
  }
}

}  // namespace

PathFinder::PathFinder(double vertical_cost, const StepConstants& constants, WorkBudget* budget)
    : constants_(constants),
      search_({vertical_cost, constants.tight_cost}, constants.heuristic_weight),
      budget_(budget) {
  barriers_.reserve(8);
  runs_.reserve(64);
  detour_.reserve(1024);
}

void PathFinder::Begin(double speed) {
  barriers_.clear();
  speed_ = speed;
}

SearchStatus PathFinder::Search(const FreeSpace& space, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to, int most_work, double max_cost) {
  const int most = std::max(0, most_work) / WorkBudget::kSpan;
  const SearchStatus status = search_.Search(space, from, to, most, &detour_, barriers_, max_cost);
  budget_->Take(WorkBudget::kSpan * search_.expansions());
  return status;
}

void PathFinder::Keep(const UniformBspline& committed, double t_from, const FreeSpace& space,
                      TimedPath* path) {
  path->Clear();
  FindBlockedRuns(committed, t_from, space, &runs_);
  if (!runs_.empty() && (runs_.front().at_start || runs_.back().at_end)) return;
  const WorkBudget::SetAside aside(1.0 - WorkBudget::kSearchShare, budget_);
  double t = t_from;
  for (const BlockedRun& run : runs_) {
    path->AddCurve(committed, t, run.t_in);
    const Eigen::Vector3d from = committed.Position(run.t_in), to = committed.Position(run.t_out);
    const SearchStatus status =
        Search(space, from, to, budget_->left(), std::numeric_limits<double>::infinity());
    const double longest = (to - from).norm() + constants_.detour_longer;
    if (status != SearchStatus::kFound || PathLength(detour_) > longest) return path->Clear();
    path->AddDetour(committed, run, detour_, speed_);
    t = run.t_out;
  }
  path->AddCurve(committed, t, committed.t_end());
}

SearchStatus PathFinder::LeadPast(const UniformBspline& curve, BlockedRun run,
                                  const FreeSpace& space, TimedPath* path, int reserve,
                                  double max_cost) {
  path->Clear();
  CutToWindow(curve, *space.map, &run);
  const double share = paths_closed() > 0 ? WorkBudget::kSearchShare : 1.0;
  const int most = static_cast<int>(share * (budget_->left() - reserve));
  const SearchStatus status =
      Search(space, curve.Position(run.t_in), curve.Position(run.t_out), most, max_cost);
  // Out of the window only floor and ceiling block, and there is one path between them.
  if (status == SearchStatus::kEndsOutside && paths_closed() > 0) return SearchStatus::kNoPath;
  if (status == SearchStatus::kEndsOutside) SampleBetweenLevels(curve, run, space, &detour_);
  if (status != SearchStatus::kFound && status != SearchStatus::kEndsOutside) return status;
  path->AddCurve(curve, curve.t0(), run.t_in);
  path->AddDetour(curve, run, detour_, speed_);
  path->AddCurve(curve, run.t_out, curve.t_end());
  return status;
}

void EndBeside(const TimedPath& path, const UniformBspline& curve, const FreeSpace& space,
               double more, BlockedRun* run) {
  const auto is_free = [&](const CellIndex& cell) { return !space.Blocked(cell); };
  const auto sees_way = [&](double t) {
    const Eigen::Vector3d there = path.AtShare((t - curve.t0()) / curve.duration());
    return TraverseCells(curve.Position(t), there, space.map->resolution(), is_free);
  };
  for (double t = run->t_out; t < curve.t_end(); t += kCurveStep) {
    if (!sees_way(t)) run->t_out = std::min(t + more, curve.t_end());
  }
}

}  // namespace touchdown::planning
