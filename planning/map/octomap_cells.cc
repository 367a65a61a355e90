// SPDX-License-Identifier: BSD-3-Clause
#include "planning/map/octomap_cells.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <octomap/octomap.h>

#include "planning/map/octomap_tree.h"

namespace touchdown::planning {
namespace {

constexpr std::size_t kMostCells = 5'000'000;

}  // namespace

OccupiedCells ReadOccupiedCells(std::istream& in) {
  const std::string bytes = BytesOf(in);
  const OctomapFile file = CheckOctomapFile(bytes);
  OccupiedCells occupied{file.resolution, {}};
  octomap::OcTree tree(file.resolution);
  ReadNodes(file, &tree);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const int side = static_cast<int>(std::lround(leaf.getSize() / file.resolution));
    const octomap::point3d centre = leaf.getCoordinate();
    CellIndex low;
    for (int c = 0; c < 3; ++c) {
      low[c] = static_cast<int>(std::lround(centre(static_cast<unsigned>(c)) / file.resolution -
                                            0.5 * side));
    }
    if (occupied.cells.size() + std::pow(side, 3) > kMostCells) {
      throw std::invalid_argument("it has more than five million occupied cells");
    }
    ForEachCell({low, low.array() + side},
                [&](const CellIndex& cell) { occupied.cells.push_back(cell); });
  }
  return occupied;
}

}  // namespace touchdown::planning
