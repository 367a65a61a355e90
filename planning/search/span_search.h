// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "planning/search/column_spans.h"
#include "planning/search/grid_search.h"

namespace touchdown::planning {

/// What a way costs, in [m] of level flight with room on both sides.
struct PathCost {
  double vertical = 2.0;  ///< a metre up or down; going around is preferred to going over ...
  double tight = 1.0;     ///< a metre beside something: wide passages are preferred
};

/// A* on the free spans of the map's columns (column_spans.h) instead of its cells. A wall ahead of the vehicle is
/// searched in two dimensions, not in three. A node is a span, with the height at which it was reached. A step to the
/// next column keeps its height as long as that column is free there. The heights of the way that was found are
/// straightened in the end. Not exact: a span remembers only the cheapest height. Deterministic. Its arrays have the
/// size of the map's window and are kept between searches.
class SpanSearch {
 public:
  /// With `greed` > 1 spans near the goal come first. A way then costs more than the least, hardly more than this
  /// many times as much, and is found after fewer expansions. Throws std::invalid_argument unless all are in [1,
  /// 100].
  explicit SpanSearch(const PathCost& cost = {}, double greed = 1.0);

  /// From the next search on.
  void set_cost(const PathCost& cost);

  /// Makes room for searches on maps with this one's window, which the first search does otherwise.
  void Reserve(const OccupancyMap& map);

  /// Finds a path of places in free cells, one per column, from `from` to `to`. A blocked end is first moved to the
  /// nearest free cell within GridSearch::kEndSearchRadius. Expands at most `max_expansions` spans, and ignores ways
  /// that cost more than `max_cost` [m]. Allocates only to grow to a high-water mark.
  SearchStatus Search(const FreeSpace& space, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to, int max_expansions, GuidePath* path,
                      std::span<const Barrier> barriers = {},
                      double max_cost = std::numeric_limits<double>::infinity());

  /// The same to a place that may be out of the window, or be reached only from there: then the path ends where it
  /// leaves the window, at a side, or else at its top or bottom. The rest costs as much as over nothing but free space.
  SearchStatus SearchOut(const FreeSpace& space, const Eigen::Vector3d& from,
                         const Eigen::Vector3d& to, int max_expansions, GuidePath* path);

  /// Whether any way leads out of the window: kFound. kNoPath: what blocks is all around.
  SearchStatus Escape(const FreeSpace& space, const Eigen::Vector3d& from, int max_expansions);

  int expansions() const { return expansions_; }
  /// Of the path that was found last [m].
  double cost() const { return cost_; }
  /// Where that path ends.
  enum class End { kGoal, kSide, kAnywhere };
  End end() const { return end_; }

 private:
  // The nodes to be expanded. Those with the least f come first, to a quarter of a cell, and of these the last that
  // came. With a weighted estimate an exact order costs more than it gains.
  class Queue {
   public:
    Queue();
    void Reserve(std::size_t entries) { entries_.reserve(entries); }
    void Clear();
    bool empty() const { return waiting_ == 0; }
    void Push(float f, std::uint32_t address);
    std::uint32_t Pop();

   private:
    struct Entry {
      std::uint32_t address;
      std::int32_t next;  // of the same f; -1: none
    };
    std::vector<std::int32_t> first_;  // by f; -1: none
    std::vector<Entry> entries_;
    std::size_t least_ = 0;
    int waiting_ = 0;
  };

  // What a search knows of a span, if it has seen it.
  struct Node {
    float g = 0.0f;  // [cells]
    std::uint32_t search : 31 = 0;
    std::uint32_t closed : 1 = 0;
    std::int16_t z = 0;        // at which it was reached
    std::uint8_t step = 0;     // by which it was reached; kSelf: the start ...
    std::uint8_t from_id = 0;  // ... from this span of the column there
  };
  // A span of the way that was found.
  struct Place {
    int x, y;
    FreeSpan span;
  };
  // Heights at which a way may pass from a column to the next [cells].
  struct Gate {
    double at;  // along the way [cells]
    double low, high;
    double z;
  };

  void Forget(GuidePath* path);
  SearchStatus SearchFrom(const FreeSpace& space, CellIndex start, CellIndex goal, End end,
                          int max_expansions, GuidePath* path, std::span<const Barrier> barriers,
                          double max_cost);
  SearchStatus SearchOn(const CellIndex& start, const CellIndex& goal, End end, int max_expansions,
                        float max_cost);
  bool Passed(const CellIndex& cell);
  void TraceBack(int x, int y, int id);
  void Straighten(double from, double to);

  static constexpr std::uint32_t kMostSearches = (1u << 31) - 1;

  float vertical_cost_, tight_cost_, greed_;
  ColumnSpans columns_;
  std::vector<Node> nodes_;
  Queue queue_;
  std::vector<Place> way_;
  std::vector<Gate> gates_;
  std::uint32_t search_ = 0;
  int expansions_ = 0;
  double cost_ = 0.0;
  End end_ = End::kGoal;
  CellIndex origin_ = CellIndex::Zero();  // of the window
  int end_z_ = 0;  // at which it ends [cells]
};

}  // namespace touchdown::planning
