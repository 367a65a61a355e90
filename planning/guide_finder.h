// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "touchdown/planning/barrier.h"
#include "touchdown/planning/committed_way.h"
#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// Finds guides past the blocked stretches of a curve: along the committed curve, with detours where it is
/// blocked by now, so that the side of an obstacle is kept, else by A*. All searches share a budget until
/// it is refilled.
class GuideFinder {
 public:
  explicit GuideFinder(double vertical_cost);

  /// Makes room for searches on maps with this one's window.
  void Prepare(const OccupancyMap& map) { search_.Reserve(map); }

  /// @param expansions of all searches from now on.
  void Refill(int expansions) { expansions_left_ = expansions; }

  /// An attempt begins: no way is closed, nothing is kept. @param at_rest there is time to look for long
  /// ways round.
  void Begin(bool at_rest);

  /// Guides follow the committed curve from t_from [s] on, where it still knows a way.
  void Keep(const UniformBspline& committed, double t_from, const FreeSpace& space);

  /// The committed curve leads past this stretch, and no way was closed yet.
  bool Keeps(const BlockedRun& run) const {
    return committed_.known() && barriers_.empty() && !run.at_start;
  }

  /// Nothing blocks the curve that is kept.
  bool KeepsClear() const { return committed_.clear(); }

  /// Ends a run that is kept only where the curve is on the committed curve's side of everything: a curve
  /// that leaves an obstacle seen from the front is behind its front, not past it. @pre Keeps(*run).
  void EndBesideKept(const FreeSpace& space, const UniformBspline& curve, BlockedRun* run) const;

  /// From here on guides do not cross this.
  void Close(const Barrier& barrier) { barriers_.push_back(barrier); }
  int ways_closed() const { return static_cast<int>(barriers_.size()); }

  /// A guide past what blocks `curve` in `run`, at least one point. A run that leaves the map's window
  /// before it does ends there: the search knows no more; one that begins out of it is led along the curve,
  /// between floor and ceiling. kFound and kEndsOutside leave a guide.
  /// @param local the way is looked for nearby only.
  SearchStatus Find(const FreeSpace& space, const UniformBspline& curve, bool local,
                    BlockedRun* run, GuidePath* guide);

 private:
  GridSearch search_;
  std::vector<Barrier> barriers_;
  CommittedWay committed_;
  int expansions_left_ = 0;
  bool at_rest_ = false;
};

}  // namespace touchdown::planning
