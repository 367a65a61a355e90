// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "planning/map/octomap_file.h"

namespace octomap {
class OcTree;
}

namespace touchdown::planning {

/// Reads the nodes of a file into an empty tree, which has its thresholds already. A file in which nothing is known
/// leaves it empty.
void ReadNodes(const OctomapFile& file, octomap::OcTree* tree);

/// Log-odds in steps of OccupancyMap::kLogOddsStep.
std::int8_t StepsOf(float log_odds);

/// The same world in cells of another size. A cell is occupied if an occupied leaf overlaps it, and gets the value of
/// the likeliest of these. Else it is free if its middle lies in a free leaf; else it is unknown. A leaf that touches
/// a cell's face, or reaches into it by a thousandth of its side, does not overlap it.
/// @param from with cells of any size; its resolution() and thresholds are those of the result.
/// @param scale side of its cells over its resolution().
/// @param occupied least log-odds of what is occupied [steps].
/// @throws std::invalid_argument if that takes more than five million leaves.
std::unique_ptr<octomap::OcTree> Resampled(const octomap::OcTree& from, double scale, int occupied);

}  // namespace touchdown::planning
