// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "planning/baselines/ego/ego_grid.h"
#include "planning/baselines/ego/ego_options.h"

namespace touchdown::planning {

enum class EgoSearchStatus {
  kFound,
  kEndsTooFar,      ///< an end, moved out of its obstacle, lies outside the lattice
  kNoPath,          ///< everything reachable was expanded
  kExpansionLimit,  ///< the budget of expansions was used up
};

/// A* as the baseline uses it, over 26 neighbours on a lattice of its own. The lattice is centred
/// between the two ends and not aligned with the map's cells. f = g + 1.0001 h, with h the exact
/// distance on the empty lattice. An end inside an obstacle is moved away from the other end until
/// it is free. The constructor allocates the lattice (search_cells cubed), which is kept.
class EgoSearch {
 public:
  explicit EgoSearch(const EgoOptions& options);

  /// A path of lattice points from `from` to `to` [m]. Deterministic.
  EgoSearchStatus Search(const EgoGrid& grid, const Eigen::Vector3d& from,
                         const Eigen::Vector3d& to, std::vector<Eigen::Vector3d>* path);

 private:
  struct Node {
    double f;
    std::uint32_t order;
    std::uint32_t address;
  };
  struct Step {
    Eigen::Vector3i offset;
    double length;
  };

  Eigen::Vector3i IndexOf(const Eigen::Vector3d& p_W) const;
  Eigen::Vector3d PointOf(const Eigen::Vector3i& index) const;
  bool Contains(const Eigen::Vector3i& index) const;
  std::uint32_t Address(const Eigen::Vector3i& index) const;
  Eigen::Vector3i IndexAt(std::uint32_t address) const;
  bool MoveOut(const EgoGrid& grid, const Eigen::Vector3d& away, Eigen::Vector3d* p_W) const;
  void Push(std::uint32_t address, double f);

  double step_;
  int cells_;
  int max_expansions_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::array<Step, 26> steps_;
  std::vector<double> g_;
  std::vector<std::uint8_t> parent_;  // step we came by; 26: the start
  std::vector<std::uint32_t> seen_;   // twice the search's number, and one more once closed
  std::vector<Node> heap_;
  std::uint32_t search_ = 0;
  std::uint32_t pushed_ = 0;
};

}  // namespace touchdown::planning
