// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// The way that the committed curve takes from now on, as a guide: what has come to block it since is
/// passed by detours.
class CommittedWay {
 public:
  CommittedWay();

  /// Nothing is committed.
  void Clear() { places_.clear(); }

  /// Follows `curve` from t_from [s] on. Does not know a way, and is empty, where the curve starts or ends
  /// blocked, or where a detour is not found within max_expansions or is much longer than what it
  /// replaces. Allocates only to grow to a high-water mark. @return expansions spent.
  int Follow(const UniformBspline& curve, double t_from, const FreeSpace& space, int max_expansions,
             GridSearch* search);

  bool known() const { return !places_.empty(); }

  /// Nothing blocks the curve: the way is the curve itself.
  bool clear() const { return known() && runs_.empty(); }

  /// At a share of the time that the committed curve has left, in [0, 1]. @pre known().
  Eigen::Vector3d At(double share) const { return AtTime(TimeOf(share)); }

  /// From one such share to another, at least two points. @pre known().
  void Sample(double from, double to, GuidePath* guide) const;

 private:
  struct Place {
    double t;
    Eigen::Vector3d p_W;
  };

  bool AddDetour(const UniformBspline& curve, const BlockedRun& run);
  double TimeOf(double share) const {
    return places_.front().t + share * (places_.back().t - places_.front().t);
  }
  Eigen::Vector3d AtTime(double t) const;

  std::vector<Place> places_;  // in order of time
  std::vector<BlockedRun> runs_;
  GuidePath detour_;
};

}  // namespace touchdown::planning
