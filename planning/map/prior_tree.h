// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>

#include "touchdown/planning/map/cell_blocks.h"
#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::planning {

/// Cells have indices in [-kKeyOffset, kKeyOffset) along each axis.
inline constexpr int kKeyOffset = CellBlocks::kReach;
inline bool InTree(const CellIndex& cell) {
  return (cell.array() >= -kKeyOffset).all() && (cell.array() < kKeyOffset).all();
}

/// What a persistent map knows from a file: an octree (OctoMap). In a library that is built without OctoMap it stays
/// empty (no_octomap.cc).
class PriorTree {
 public:
  explicit PriorTree(const OccupancyMapOptions& options);
  ~PriorTree();
  PriorTree(PriorTree&&) noexcept;
  PriorTree& operator=(PriorTree&&) noexcept;

  /// Least log-odds of what is occupied [steps].
  int occupied() const;
  /// Number of its nodes.
  std::size_t size() const;
  /// Something is known of the block that begins at `corner`.
  bool Knows(const CellIndex& corner) const;
  /// Gives the cells of that block what is known of them.
  void Fill(const CellIndex& corner, CellBlock* block) const;
  /// What is known of a cell, in steps of OccupancyMap::kLogOddsStep; none if it is unknown.
  std::optional<std::int8_t> LogOdds(const CellIndex& cell) const;
  /// Calls visit(cube) for every leaf that is occupied.
  void ForEachObstacle(const std::function<void(const CellCube&)>& visit) const;

  /// Replaces it by a file's, as PersistentMap::Read does.
  void Read(std::istream& in);
  void Put(const CellValue& value);
  /// Writes what was read and put. @throws std::invalid_argument in a library without OctoMap.
  void Write(std::ostream& out, MapFormat format);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
