// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// OctoMap's two file formats.
enum class MapFormat {
  kLogOdds,  ///< .ot: what was observed, in full
  kBinary,   ///< .bt: free or occupied; a cell that is neither is left out
};

/// The cells from `low` on, `side` of them along each axis.
struct CellCube {
  CellIndex low;
  int side;
};

/// What a file said of the world against what was observed since it was read. Cells that are ground as a whole do not count,
/// nor do those that are doubtful or the pad's.
struct PriorCheck {
  std::int64_t occupied = 0;        ///< cells that the file holds occupied
  std::int64_t looked_at = 0;       ///< of these, those that were observed, occupied or not
  std::vector<CellIndex> gone;      ///< of these, those that are free in the end; in order
  /// That the file holds free, and that are occupied in the end; in order. Not those at the border of its free space:
  /// of an obstacle behind that a return may fall a cell short.
  std::vector<CellIndex> appeared;
};

/// Everything that was ever observed: what a rolling map forgets when its window moves on, it gets
/// back from here when the window comes back. In the window the rolling map knows better; a cell
/// comes here when it leaves, or in Flush, and only if it has changed. So a cell that an obstacle has
/// left is free here as soon as it is stored again: nothing that moves leaves a trail. What a file said
/// is an octree (OctoMap); what was touched since is in blocks of cells (touchdown/planning/map/cell_blocks.h). Cells
/// more than 32768 cells from the world's origin are not kept.
class PersistentMap {
 public:
  /// An empty map with the resolution and the probabilities of the rolling map that it serves.
  explicit PersistentMap(const OccupancyMapOptions& options);
  ~PersistentMap();
  PersistentMap(PersistentMap&&) noexcept;
  PersistentMap& operator=(PersistentMap&&) noexcept;

  /// OccupancyMap::Recentre, with what leaves stored and what enters refilled.
  void Recentre(const Eigen::Vector3d& p_W, OccupancyMap* map);

  /// Gives the map's whole window what is known of it here: prior knowledge, before anything is seen.
  void Refill(OccupancyMap* map) const;

  /// Stores what has changed in the map's window.
  void Flush(OccupancyMap* map);

  /// What is known of a cell, in steps of OccupancyMap::kLogOddsStep; none if it is unknown.
  std::optional<std::int8_t> LogOdds(const CellIndex& cell) const;
  bool IsOccupied(const CellIndex& cell) const;

  /// What it holds: nodes of the octree, and cells in blocks.
  std::size_t size() const;

  /// Replaces the map by an OctoMap file of either format, as octomap's own tools write them: an
  /// OcTree. Cells that have not this map's resolution are resampled: a cell is occupied if an occupied one overlaps it, else
  /// free if its middle is in a free one, else unknown. @throws std::invalid_argument that says what is wrong with it;
  /// the map is then as before.
  void Read(std::istream& in);

  /// Compares the file that was read with what was stored since, by Recentre and Flush. After Write, what that wrote
  /// takes the file's place.
  PriorCheck CheckPrior() const;

  /// Occupied cells of that file, but for ground, in cubes that reach into a box.
  std::vector<CellCube> PriorObstacles(const CellBox& within) const;

  /// Writes the map for octomap's tools and for Read. Then all of it is in the octree.
  void Write(std::ostream& out, MapFormat format);

 private:
  struct Impl;

  void Refill(const CellBox& box, OccupancyMap* map) const;

  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
