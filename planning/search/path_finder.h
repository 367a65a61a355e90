// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "planning/search/barrier.h"
#include "planning/search/span_search.h"
#include "planning/search/timed_path.h"
#include "planning/search/work_budget.h"
#include "touchdown/planning/problem/step_constants.h"

namespace touchdown::planning {

/// Finds paths past what blocks a curve: along it, with detours. Those of the committed curve are hardly longer than
/// it, so that its side of an obstacle is kept. All searches use a step's budget.
class PathFinder {
 public:
  /// @param budget that must outlive this.
  PathFinder(double vertical_cost, const StepConstants& constants, WorkBudget* budget);

  /// Makes room for searches on maps with this one's window.
  void Prepare(const OccupancyMap& map) { search_.Reserve(map); }

  /// An attempt begins: no path is closed. @param speed of detours [m/s].
  void Begin(double speed);

  /// The committed curve from t_from [s] on. Not known if it starts or ends blocked, or if a detour is not found or
  /// is much longer than the straight line. Takes at most WorkBudget::kSearchShare of what is left.
  void Keep(const UniformBspline& committed, double t_from, const FreeSpace& space,
            TimedPath* path);

  /// The cheapest path past `run` that is not closed. A run that leaves the map's window before it ends
  /// is cut there: the search does not know what is beyond. A run that begins out of it is led along
  /// the curve, between floor and ceiling. kFound and kEndsOutside leave a path.
  /// Takes all work that is left except `reserve`; a path beside a closed one, WorkBudget::kSearchShare
  /// of that.
  /// @param max_cost of the detour; paths that cost more are ignored [m].
  SearchStatus LeadPast(const UniformBspline& curve, BlockedRun run, const FreeSpace& space,
                        TimedPath* path, int reserve = 0,
                        double max_cost = std::numeric_limits<double>::infinity());
  /// Of the detour that was found last: its cost [m], and the places.
  double cost() const { return search_.cost(); }
  const GuidePath& detour() const { return detour_; }

  /// From here on paths do not cross this.
  void Close(const Barrier& barrier) { barriers_.push_back(barrier); }
  int paths_closed() const { return static_cast<int>(barriers_.size()); }

 private:
  SearchStatus Search(const FreeSpace& space, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to, int most_work, double max_cost);

  StepConstants constants_;
  SpanSearch search_;
  std::vector<Barrier> barriers_;
  std::vector<BlockedRun> runs_;
  GuidePath detour_;
  double speed_ = 1.0;
  WorkBudget* budget_;
};

/// Extends a run to where the curve is on the path's side of everything, at the same share of its time, and `more` of
/// it [s] beyond. Where a curve leaves an obstacle seen from the front, it is behind that front, not past it. @pre
/// path.known().
void EndBeside(const TimedPath& path, const UniformBspline& curve, const FreeSpace& space,
               double more, BlockedRun* run);

}  // namespace touchdown::planning
