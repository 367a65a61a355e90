// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "planning/look/far_memory.h"
#include "planning/look/sight.h"
#include "planning/search/span_search.h"
#include "touchdown/planning/certify/swept_hull.h"
#include "touchdown/planning/look/scout.h"

namespace touchdown::planning {

/// A place to look from, and what is to be seen there.
struct Look {
  Viewpoint from;
  double way = 0.0;              ///< to there, through cells that were seen free [m], ...
  GuidePath way_W;               ///< ... over these places: here first, there last
  std::vector<CellIndex> cells;  ///< in sight of it, of those that are needed ...
  std::size_t camera = 0;        ///< ... by this one, most of them
};

/// Surveys the map's window: which cells a way to the goal still needs to have seen, and from where these are in sight.
/// Allocates only to grow to a high-water mark.
class Lookout {
 public:
  explicit Lookout(const PathCost& cost);

  /// Makes room for maps with this one's window.
  void Prepare(const FreeSpace& space);

  /// Keeps what the window holds now, for TakePath.
  void Keep(const FreeSpace& space);

  /// The potential: what the shortest way over what is not known to block costs [m]. Where none leads to the goal within
  /// the window it ends where it leaves that, and the rest is straight. Infinite: there is none.
  double Length(const FreeSpace& space, const Eigen::Vector3d& from, const Eigen::Vector3d& goal);

  /// Where the way of the last Length ends: at the goal, or where it leaves the window.
  SpanSearch::End end() const { return end_; }

  /// Another way than that of the last Length, between the same places.
  /// @param wide  a metre beside something costs more, as it does planners: where the hull just fits, no curve may.
  /// @param far   it leaves the window, and is the shortest with all that was seen before.
  void TakePath(const FreeSpace& space, const Eigen::Vector3d& from, const Eigen::Vector3d& goal,
                bool wide, bool far);

  /// What is known to block closes every way: around `from` or around the goal. @pre the last Length was between these
  bool Closed(const FreeSpace& space, const Eigen::Vector3d& from, const Eigen::Vector3d& goal);

  /// The least that it can be: over nothing but free space.
  double Least(const OccupancyMap& map, const Eigen::Vector3d& from,
               const Eigen::Vector3d& goal) const;

  /// Notes the cells that the hull would touch on that way, and that were never seen free; of many, some evenly.
  /// False: there are none. @pre the last Length, from the same place, was finite
  bool NoteNeeded(const HullSpace& hull, const Eigen::Vector3d& from);

  /// Notes the cells instead that are known to block the goal's place. False: there are none.
  bool NoteDoubted(const FreeSpace& space, const Eigen::Vector3d& goal);

  /// How far that way leads through cells that were seen free [m].
  double seen() const { return seen_until_.way; }

  /// A straight way leads from a to b through cells that were seen free. @pre a look
  bool Leads(const HullSpace& hull, const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// From where most of the needed cells are seen in the time that it takes, of the nearest places to which cells lead
  /// that were seen free. Not from where `struck` is. nullptr: from nowhere. Valid until the next call. @pre NoteNeeded
  const Look* Choose(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                     const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                     const std::vector<Viewpoint>& struck);

  /// The last place on the way to which cells lead that were seen free, turned along it, or as now if that is
  /// upright. nullptr: it is struck. As Choose. @pre NoteNeeded
  const Look* Onwards(double yaw, const std::vector<Viewpoint>& struck);

  /// From here to the left. As Choose.
  const Look* Around(const Eigen::Vector3d& from, double yaw);

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
    double way;     ///< to there [m], ...
    int from = -1;  ///< ... over this one; -1: none
  };
  struct Candidate {
    double worth;  ///< of a sample of needed cells in its image, over the time: nothing is between
    Viewpoint from;
    int place;
    double time;  ///< [s]
  };

  bool TakeFarPath(const FreeSpace& space, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& goal);
  bool Fits(const HullSpace& hull, const Eigen::Vector3d& p, const Eigen::Vector3d& start) const;
  bool FitsBetween(const HullSpace& hull, const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  void Flood(const HullSpace& hull, const Place& from);
  void BeginAt(const Eigen::Vector3d& from);
  const Look* LookFrom(const Viewpoint& from, int place);

  void FindCandidates(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                      const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                      const std::vector<Viewpoint>& struck, std::size_t apart);
  double Trace(const OccupancyMap& map, const std::vector<LookCamera>& cameras,
               const Candidate& candidate, const Eigen::Vector3d& pull_W, std::size_t apart);

  using Mark = std::uint8_t;
  static constexpr Mark kNone = 0, kFits = 1, kClosed = 2,
                        kReached = 3;  ///< or more: in a later flood
  /// A mark for each cell of the window, of which few are set.
  class CellMarks {
   public:
    void Begin(const OccupancyMap& map);
    Mark& At(const CellIndex& cell);

   private:
    CellIndex origin_, size_;
    std::vector<Mark> marks_;
    std::vector<std::uint32_t> set_;
  };
  struct Entry {
    double way;
    CellIndex node;  ///< cells beyond where the flood begins
    int number;      ///< as they came: 27 times the place before, and the step from there
  };
  Mark MarkAt(const HullSpace& hull, const Eigen::Vector3d& from, const CellIndex& cells);
  void Spread(const HullSpace& hull, std::size_t first, std::size_t most, double apart,
              Mark reached);

  PathCost cost_;
  SpanSearch search_;
  SpanSearch far_search_;
  std::optional<FarMemory> far_;
  SearchStatus status_ = SearchStatus::kNoPath;  // of the last Length, ...
  SpanSearch::End end_ = SpanSearch::End::kGoal;  // ... and of its way
  CellMarks marks_;
  std::vector<Entry> queue_;
  GuidePath path_, back_;
  std::vector<Needed> needed_;
  Place begin_,
      seen_until_;  ///< of the way: where it begins, and where its part ends that was seen, ...
  std::size_t seen_places_ = 0;                      ///< ... and its places until there
  Eigen::Vector3d along_ = Eigen::Vector3d::Zero();  ///< its direction there
  std::vector<Place> places_;
  std::vector<Candidate> candidates_;
  std::vector<Sight> sights_;  ///< of the candidate at hand, one for each camera
  std::vector<CellIndex> seen_;  ///< of the candidate at hand
  Look look_;
};

}  // namespace touchdown::planning
