// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/certify/free_space.h"

namespace touchdown::planning {

/// What the EGO-Planner baseline asks of a map.
class EgoGrid {
 public:
  virtual ~EgoGrid() = default;
  virtual double resolution() const = 0;  ///< cell side [m]
  virtual bool Inside(const Eigen::Vector3d& p_W) const = 0;
  /// After inflation. Unknown counts as free; outside the map counts as occupied, as published.
  virtual bool Occupied(const Eigen::Vector3d& p_W) const = 0;
};

/// The closed loop's map: the window of a rolling grid, its inflation, floor and ceiling.
class FreeSpaceGrid : public EgoGrid {
 public:
  explicit FreeSpaceGrid(const FreeSpace& space) : space_(space) {}
  double resolution() const override { return space_.map->resolution(); }
  bool Inside(const Eigen::Vector3d& p_W) const override {
    return space_.map->InWindow(space_.map->CellOf(p_W));
  }
  bool Occupied(const Eigen::Vector3d& p_W) const override {
    const CellIndex cell = space_.map->CellOf(p_W);
    return !space_.map->InWindow(cell) || space_.Blocked(cell);
  }

 private:
  FreeSpace space_;
};

/// The published map: a dense box of cells, each obstacle cell grown to a cube of
/// 2 ceil(inflation / resolution) + 1 cells a side.
class CubeGrid : public EgoGrid {
 public:
  /// A box with its lowest corner at `corner` [m] and `size` [m]. Throws std::invalid_argument
  /// unless resolution > 0, inflation >= 0 and the box has 1 to 1e8 cells. Allocates.
  CubeGrid(const Eigen::Vector3d& corner, const Eigen::Vector3d& size, double resolution,
           double inflation);

  /// Occupies the cell of p_W and the cube around it. Out of the box: ignored.
  void SetOccupied(const Eigen::Vector3d& p_W);

  double resolution() const override { return resolution_; }
  bool Inside(const Eigen::Vector3d& p_W) const override { return Contains(CellOf(p_W)); }
  bool Occupied(const Eigen::Vector3d& p_W) const override {
    const CellIndex cell = CellOf(p_W);
    return !Contains(cell) || blocked_[Address(cell)];
  }

 private:
  CellIndex CellOf(const Eigen::Vector3d& p_W) const {
    return ((p_W - corner_) / resolution_).array().floor().matrix().cast<int>();
  }
  bool Contains(const CellIndex& cell) const {
    return (cell.array() >= 0).all() && ((cell - count_).array() < 0).all();
  }
  std::size_t Address(const CellIndex& cell) const {
    return (static_cast<std::size_t>(cell.z()) * count_.y() + cell.y()) * count_.x() + cell.x();
  }

  Eigen::Vector3d corner_;
  double resolution_;
  int reach_;  // of the inflation [cells]
  CellIndex count_;
  std::vector<char> blocked_;
};

}  // namespace touchdown::planning
