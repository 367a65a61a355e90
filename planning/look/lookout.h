// SPDX-License-Identifier: BSD-3-Clause
// What a way still needs to have seen, and from where that is in sight.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "planning/search/span_search.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/look/scout.h"

namespace touchdown::planning {

/// A place to look from, and what is to be seen there.
struct Look {
  Viewpoint from;
  double way = 0.0;              ///< to there through cells that were seen free [m]
  double time = 0.0;             ///< that it will take [s]
  std::vector<CellIndex> cells;  ///< in sight of it, of those that are needed
};

/// A cell that was never seen free, and that a way needs.
struct NeededCell {
  CellIndex cell;
  double worth;  ///< to be seen: the more the sooner the way comes there
};

/// Surveys the map's window.
class Lookout {
 public:
  explicit Lookout(double vertical_cost) : search_({.vertical = vertical_cost}) {}

  /// What the shortest way over what is not known to block costs [m]; infinite: there is none in the window. Where
  /// the goal is out of the window the way ends at its border.
  double Length(const FreeSpace& space, const Eigen::Vector3d& from, const Eigen::Vector3d& goal);

  /// Notes the cells that the hull would touch on that way, and that were never seen free; of many, some evenly.
  /// False: there are none. @pre Length was finite
  bool NoteNeeded(const HullSpace& hull, const Eigen::Vector3d& from);

  /// From where most of the needed cells are seen in the time that it takes, of all places to which cells lead that
  /// were seen free. Not from where `struck` is. @pre NoteNeeded
  std::optional<Look> Choose(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                             const estimation::VehicleState& vehicle,
                             const Eigen::Vector3d& pull_W, const std::vector<Viewpoint>& struck);

 private:
  struct Place {
    Eigen::Vector3d p_W;
    double way;  ///< to there [m]
  };
  void Flood(const HullSpace& hull, const Place& from);
  bool Flood(const HullSpace& hull, const Place& from, int stride);

  SpanSearch search_;
  GuidePath path_;
  std::vector<NeededCell> needed_;
  Place begin_, unseen_from_;  ///< of the way, and the last place of its part that was seen
  std::vector<Place> places_;
};

}  // namespace touchdown::planning
