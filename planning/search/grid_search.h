// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "planning/search/barrier.h"
#include "planning/search/blocked_bits.h"
#include "touchdown/planning/certify/free_space.h"

namespace touchdown::planning {

/// A free path around an obstacle, as a polyline in W [m].
using GuidePath = std::vector<Eigen::Vector3d>;

/// [m]
double PathLength(const GuidePath& path);

enum class SearchStatus {
  kFound,
  kEndsOutside,     ///< an end lies outside the map's window
  kEndsBlocked,     ///< no free cell near a blocked end
  kNoPath,          ///< everything reachable was expanded
  kExpansionLimit,  ///< the budget of expansions was used up
};

/// A* on the 26-neighbour lattice of the map's free cells (eq. 16: f = g + greed h, h the exact
/// distance on the empty lattice). A step costs sqrt(dx^2 + dy^2 + (vertical_cost dz)^2): going
/// around is preferred to going over, where a forward camera sees little. A blocked end is first
/// moved to the nearest free cell within `kEndSearchRadius`. Deterministic: ties are broken by the
/// order of insertion. Its arrays have the size of the map's window and are kept between searches.
class GridSearch {
 public:
  static constexpr double kEndSearchRadius = 1.5;  ///< [m]

  /// With `greed` > 1 cells near the goal come first. A path then costs at most this many times the
  /// least, and is found after far fewer expansions. A step from a cell beside a blocked one costs
  /// `tight_cost` times as much: wide passages are preferred. Throws std::invalid_argument unless
  /// all are >= 1.
  explicit GridSearch(double vertical_cost = 1.0, double greed = 1.0, double tight_cost = 1.0);
  ~GridSearch();
  /// A moved-from instance may only be assigned to or destroyed.
  GridSearch(GridSearch&&) noexcept;
  GridSearch& operator=(GridSearch&&) noexcept;

  /// Makes room for searches on maps with this one's window, which the first search does otherwise.
  void Reserve(const OccupancyMap& map);

  /// Finds a path of cell centres from `from` to `to`, the (moved) ends included. Expands at most
  /// `max_expansions` cells. Allocates only to grow to a high-water mark.
  SearchStatus Search(const FreeSpace& space, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to, int max_expansions, GuidePath* path,
                      std::span<const Barrier> barriers = {});

  /// Moves `cell` to the nearest free one within kEndSearchRadius; false if there is none. Does not
  /// allocate.
  static bool NearestFree(const FreeSpace& space, CellIndex* cell);

  int expansions() const { return expansions_; }

 private:
  class Queue;  // of the cells to be expanded

  static constexpr std::uint32_t kMostSearches = (1u << 26) - 1;
  static constexpr std::uint32_t kSelf = 13;  // the middle of 27 steps: no step at all

  // What a search knows of a cell, if it has seen it.
  struct Cell {
    Cell() : Cell(0.0f, 0, 0, false) {}
    Cell(float length, std::uint32_t number, std::uint32_t step, bool done)
        : g(length), search(number & kMostSearches), parent(step & 31u), closed(done) {}

    float g;
    std::uint32_t search : 26;
    std::uint32_t parent : 5;  // the step that it was reached by; kSelf: the start
    std::uint32_t closed : 1;
  };

  struct Step {
    CellIndex offset;
    float length;
    int address;  // difference of the addresses
  };
  SearchStatus SearchOn(const CellIndex& start, const CellIndex& goal, int max_expansions);
  void Begin();
  float LatticeDistance(const CellIndex& a, const CellIndex& b) const;
  std::uint32_t Outside(const CellIndex& cell) const;

  float vertical_cost_;
  float slanted_, cubic_;  // lengths of steps up and along one axis, up and along both
  float greed_;
  float tight_cost_;
  std::array<Step, 27> steps_;  // in the order of BlockedBits::Around
  BlockedBits blocked_;
  std::vector<Cell> cells_;
  std::unique_ptr<Queue> queue_;
  std::vector<CellIndex> way_;  // what a search found
  std::uint32_t search_ = 0;
  int expansions_ = 0;
};

}  // namespace touchdown::planning
