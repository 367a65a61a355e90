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

/// Largest file that is read. It may hold 16 million nodes, each of which takes OctoMap 50 bytes.
inline constexpr std::size_t kMostMapBytes = 128 << 20;

/// The cells from `low` on, `side` of them along each axis.
struct CellCube {
  CellIndex low;
  int side;
};

/// A file's prior compared with what was observed since it was read. Cells that are ground as a whole do not count,
/// nor do those that are doubtful or the pad's.
struct PriorCheck {
  std::int64_t occupied = 0;        ///< cells that the file holds occupied
  std::int64_t looked_at = 0;       ///< of these, those that were observed, occupied or not
  std::vector<CellIndex> gone;      ///< of these, those that are free in the end; in order
  /// Cells that the file holds free, and that are occupied in the end; in order. Not those at the border of its free
  /// space: a return from an obstacle behind that may fall a cell short.
  std::vector<CellIndex> appeared;
};

/// Everything that was ever observed. A rolling map forgets cells when its window moves on, and gets them back from
/// here when the window comes back. In the window the rolling map is more recent. A cell comes here when it leaves,
/// or in Flush, and only if it has changed. So a cell that an obstacle has left is free here as soon as it is stored
/// again: moving obstacles leave no trail. A file's map is an octree (OctoMap). Cells touched since are in blocks
/// (touchdown/planning/map/cell_blocks.h). Cells more than 32768 cells from the world's origin are not kept.
class PersistentMap {
 public:
  /// An empty map with the resolution and the probabilities of the rolling map that it serves.
  explicit PersistentMap(const OccupancyMapOptions& options);
  ~PersistentMap();
  PersistentMap(PersistentMap&&) noexcept;
  PersistentMap& operator=(PersistentMap&&) noexcept;

  /// OccupancyMap::Recentre, with what leaves stored and what enters refilled.
  void Recentre(const Eigen::Vector3d& p_W, OccupancyMap* map);

  /// Fills the map's whole window with what is known of it here: prior knowledge, before anything is seen.
  void Refill(OccupancyMap* map) const;

  /// Stores what has changed in the map's window.
  void Flush(OccupancyMap* map);

  /// What is known of a cell, in steps of OccupancyMap::kLogOddsStep; none if it is unknown.
  std::optional<std::int8_t> LogOdds(const CellIndex& cell) const;
  bool IsOccupied(const CellIndex& cell) const;

  /// What it holds: nodes of the octree, and cells in blocks.
  std::size_t size() const;

  /// Replaces the map by an OctoMap file of either format, as octomap's own tools write them: an OcTree. Cells of
  /// another resolution are resampled. A cell is then occupied if an occupied one overlaps it, else free if its
  /// middle is in a free one, else unknown. @throws std::invalid_argument that says what is wrong with it; the map is
  /// then as before.
  void Read(std::istream& in);

  /// Compares the file that was read with what Recentre and Flush have stored since. After Write, the written map
  /// takes the file's place.
  PriorCheck CheckPrior() const;

  /// Occupied cells of that file, except ground, in cubes that reach into a box.
  std::vector<CellCube> PriorObstacles(const CellBox& within) const;

  /// Writes the map for octomap's tools and for Read. Then all of it is in the octree.
  void Write(std::ostream& out, MapFormat format);

 private:
  struct Impl;

  void Refill(const CellBox& box, OccupancyMap* map) const;

  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
