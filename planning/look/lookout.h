// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "planning/look/sight.h"
#include "planning/search/span_search.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/look/scout.h"

namespace touchdown::planning {

/// A place to look from, and what is to be seen there.
struct Look {
  Viewpoint from;
  double way = 0.0;              ///< to there, through cells that were seen free [m]
  std::vector<CellIndex> cells;  ///< in sight of it, of those that are needed
};

/// Surveys the map's window: which cells a way to the goal still needs to have seen, and from where these are in sight.
/// Allocates only to grow to a high-water mark.
class Lookout {
 public:
  explicit Lookout(double vertical_cost);

  /// Makes room for maps with this one's window.
  void Prepare(const OccupancyMap& map);

  /// The potential: what the shortest way over what is not known to block costs [m]. Infinite: there is none in the
  /// window. Where the goal is out of the window the way ends where it leaves it, and the rest is straight.
  double Length(const FreeSpace& space, const Eigen::Vector3d& from, const Eigen::Vector3d& goal);

  /// Of the last Length: what is known to block closes every way. False: one was found, or the search gave up.
  bool closed() const { return closed_; }

  /// The least that it can be: over nothing but free space.
  double Least(const OccupancyMap& map, const Eigen::Vector3d& from,
               const Eigen::Vector3d& goal) const;

  /// Notes the cells that the hull would touch on that way, and that were never seen free; of many, some evenly.
  /// False: there are none. @pre the last Length, from the same place, was finite
  bool NoteNeeded(const HullSpace& hull, const Eigen::Vector3d& from);

  /// From where most of the needed cells are seen in the time that it takes, of all places to which cells lead that
  /// were seen free. Not from where `struck` is. nullptr: from nowhere. Valid until the next call. @pre NoteNeeded
  const Look* Choose(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                     const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                     const std::vector<Viewpoint>& struck);

  /// The highest place to which cells lead that were seen free, turned to the goal. As Choose.
  const Look* Highest(const HullSpace& hull, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& goal);

 private:
  struct Needed {
    CellIndex cell;
    double worth;  ///< to be seen: the more the sooner the way comes there
  };
  struct Place {
    Eigen::Vector3d p_W;
    double way;  ///< to there [m]
  };
  struct Candidate {
    double worth;  ///< of the needed cells in its image, over the time: nothing is between them
    Viewpoint from;
    double way, time;  ///< [m], [s]
  };

  void Flood(const HullSpace& hull, const Place& from);
  void Flood(const HullSpace& hull, const Place& from, int stride);

  void FindCandidates(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                      const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                      const std::vector<Viewpoint>& struck);
  double Trace(const OccupancyMap& map, const std::vector<LookCamera>& cameras,
               const Candidate& candidate, const Eigen::Vector3d& pull_W, Look* look);

  /// A number for each cell of the window, of which few are set.
  class CellNumbers {
   public:
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    void Begin(const OccupancyMap& map);
    float& At(const CellIndex& cell);

   private:
    CellIndex origin_, size_;
    std::vector<float> numbers_;
    std::vector<std::uint32_t> set_;
  };
  struct Entry {
    float way;
    CellIndex node;
  };

  double vertical_cost_;
  SpanSearch search_;
  bool closed_ = false;
  CellNumbers numbers_;
  std::vector<Entry> queue_;
  GuidePath path_;
  std::vector<Needed> needed_;
  Place begin_,
      seen_until_;  ///< of the way: where it begins, and where its part ends that was seen
  std::vector<Place> places_;
  std::vector<Candidate> candidates_;
  std::vector<Sight> sights_;  ///< of the candidate at hand, one for each camera
  Look best_, tried_;
};

}  // namespace touchdown::planning
