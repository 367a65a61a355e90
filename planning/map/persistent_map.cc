// SPDX-License-Identifier: BSD-3-Clause
// Cell (x, y, z) of the rolling map's lattice is OctoMap's key (x + 32768, ...). Log-odds are stored
// as floats that are whole steps of the rolling map, so that they come back exactly. A block is
// filled from the octree when it is first touched and knows better from then on; Write brings the blocks back.

#include "touchdown/planning/map/persistent_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <octomap/octomap.h>

#include "planning/map/octomap_tree.h"

namespace touchdown::planning {

namespace {

constexpr int kKeyOffset = CellBlocks::kReach;
constexpr double kSameSize = 1e-6;  // within it a file's cells are the map's
constexpr unsigned kLeafDepth = 16;
constexpr unsigned kBlockDepth = kLeafDepth - CellBlock::kSideLog2;  // in the octree

bool InTree(const CellIndex& cell) {
  return (cell.array() >= -kKeyOffset).all() && (cell.array() < kKeyOffset).all();
}

octomap::OcTreeKey KeyOf(const CellIndex& cell) {
  const auto key = [](int c) { return static_cast<octomap::key_type>(c + kKeyOffset); };
  return {key(cell.x()), key(cell.y()), key(cell.z())};
}

/// Gives the cells of a node, which are [low, low + side), what the octree knows of them.
void CopyCells(const octomap::OcTree& tree, const octomap::OcTreeNode* node, const CellIndex& low,
               int side, CellBlock* block) {
  if (!tree.nodeHasChildren(node)) {
    const std::int8_t log_odds = StepsOf(node->getLogOdds());
    ForEachCell({low, low.array() + side},
                [&](const CellIndex& cell) { (*block)[cell] = log_odds; });
    return;
  }
  const int half = side / 2;
  for (int i = 0; i < 8; ++i) {
    const auto child = static_cast<unsigned>(i);
    if (!tree.nodeChildExists(node, child)) continue;
    const CellIndex at = low + half * CellIndex(i & 1, i >> 1 & 1, i >> 2 & 1);
    CopyCells(tree, tree.getNodeChild(node, child), at, half, block);
  }
}

// As OctoMap's own write and writeBinary, which talk on stderr while they write.
void WriteHead(MapFormat format, const octomap::OcTree& tree, std::ostream* out) {
  *out << (format == MapFormat::kBinary ? kOctomapBinaryHead : kOctomapLogOddsHead)
       << "\nid OcTree\nsize " << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
}

/// The leaves of a tree that are free or occupied. OctoMap's binary format calls every cell free
/// that is not occupied; one that was hit, and then passed, is neither, and must not come back as
/// observed free space. The leaves are copied, as OctoMap aborts when a node's last child is deleted.
class SureTree : public octomap::OcTree {
 public:
  explicit SureTree(const octomap::OcTree& from) : OcTree(from.getResolution()), from_(from) {
    if (from.getRoot() == nullptr) return;
    root = new octomap::OcTreeNode;
    ++tree_size;
    Copy(from.getRoot(), root);
    prune();
  }

 private:
  bool IsSure(const octomap::OcTreeNode* node) const {
    if (!from_.nodeHasChildren(node)) {
      return node->getLogOdds() < 0.0f || from_.isNodeOccupied(node);
    }
    for (unsigned i = 0; i < 8; ++i) {
      if (from_.nodeChildExists(node, i) && IsSure(from_.getNodeChild(node, i))) return true;
    }
    return false;
  }
  void Copy(const octomap::OcTreeNode* node, octomap::OcTreeNode* to) {
    if (!from_.nodeHasChildren(node)) {
      to->setLogOdds(from_.isNodeOccupied(node) ? from_.getClampingThresMaxLog()
                                                : from_.getClampingThresMinLog());
      return;
    }
    for (unsigned i = 0; i < 8; ++i) {
      if (!from_.nodeChildExists(node, i)) continue;
      const octomap::OcTreeNode* child = from_.getNodeChild(node, i);
      if (IsSure(child)) Copy(child, createNodeChild(to, i));
    }
  }

  const octomap::OcTree& from_;
};

}  // namespace

struct PersistentMap::Impl {
  explicit Impl(const OccupancyMapOptions& o) : options(o), tree(NewTree()) {}

  std::unique_ptr<octomap::OcTree> NewTree() const {
    auto fresh = std::make_unique<octomap::OcTree>(options.resolution);
    SetProbabilities(fresh.get());
    return fresh;
  }
  void SetProbabilities(octomap::OcTree* of) const {
    of->setProbHit(options.probability_hit);
    of->setProbMiss(options.probability_miss);
    of->setClampingThresMin(options.probability_min);
    of->setClampingThresMax(options.probability_max);
    of->setOccupancyThres(options.probability_occupied);
  }

  /// Least log-odds of what is occupied [steps].
  int occupied() const { return StepsOf(tree->getOccupancyThresLog()); }

  /// The octree's node of a block, or the leaf above that stands for it; nullptr: nothing is known.
  const octomap::OcTreeNode* NodeOf(const CellIndex& low) const {
    return tree->search(KeyOf(low), kBlockDepth);
  }
  std::unique_ptr<CellBlocks> NewBlocks() {
    return std::make_unique<CellBlocks>([this](const CellIndex& low, CellBlock* block) {
      const octomap::OcTreeNode* node = NodeOf(low);
      if (node != nullptr) CopyCells(*tree, node, low, CellBlock::kSide, block);
    });
  }

  /// What the octree says of a cell.
  std::optional<std::int8_t> ReadLogOdds(const CellIndex& cell) const {
    const octomap::OcTreeNode* node = InTree(cell) ? tree->search(KeyOf(cell)) : nullptr;
    if (node == nullptr) return std::nullopt;
    return StepsOf(node->getLogOdds());
  }
  /// The octree holds all of its 26 neighbours free, or they are ground.
  bool IsAmidFree(const CellIndex& cell) const {
    bool amid = true;
    ForEachCell({cell.array() - 1, cell.array() + 2}, [&](const CellIndex& near) {
      amid &= IsGround(near, options) || ReadLogOdds(near).value_or(0) < 0;
    });
    return amid;
  }
  /// Calls visit(cube) for every leaf of the octree that is occupied.
  template <class Visit>
  void ForEachObstacle(Visit&& visit) const {
    for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
      if (StepsOf(leaf->getLogOdds()) < occupied()) continue;
      const octomap::OcTreeKey low = leaf.getIndexKey();
      visit(CellCube{CellIndex(low[0], low[1], low[2]).array() - kKeyOffset,
                     1 << (kLeafDepth - leaf.getDepth())});
    }
  }

  OccupancyMapOptions options;
  std::unique_ptr<octomap::OcTree> tree;
  std::unique_ptr<CellBlocks> blocks = NewBlocks();
  std::vector<CellValue> changes;  // of the window that is flushed
};

PersistentMap::PersistentMap(const OccupancyMapOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
PersistentMap::~PersistentMap() = default;
PersistentMap::PersistentMap(PersistentMap&&) noexcept = default;
PersistentMap& PersistentMap::operator=(PersistentMap&&) noexcept = default;

void PersistentMap::Recentre(const Eigen::Vector3d& p_W, OccupancyMap* map) {
  map->Recentre(p_W, impl_->blocks.get());
  for (const CellBox& box : map->entered()) Refill(box, map);
}

void PersistentMap::Refill(OccupancyMap* map) const {
  Refill({map->origin(), map->origin() + map->size()}, map);
}

void PersistentMap::Flush(OccupancyMap* map) {
  impl_->changes.clear();
  map->TakeChanges(&impl_->changes);
  for (const CellValue& value : impl_->changes) impl_->blocks->Put(value);
}

void PersistentMap::Refill(const CellBox& box, OccupancyMap* map) const {
  const CellIndex low = box.low.cwiseMax(-kKeyOffset);
  const CellIndex high = box.high.cwiseMin(kKeyOffset);
  if ((low.array() >= high.array()).any()) return;
  const auto block_of = [](int c) { return c >> CellBlock::kSideLog2; };
  const CellBox blocks = {low.unaryExpr(block_of),
                          (high.array() - 1).matrix().unaryExpr(block_of).array() + 1};
  const bool in_tree = impl_->tree->size() > 0;
  ForEachCell(blocks, [&](const CellIndex& at) {
    const CellIndex corner = at * CellBlock::kSide;
    const CellBlock* block = impl_->blocks->Find(corner);
    if (block == nullptr && in_tree && impl_->NodeOf(corner) != nullptr) {
      block = impl_->blocks->Make(corner);
    }
    if (block == nullptr) return;
    const CellBox cells = {corner.cwiseMax(low),
                           (corner.array() + CellBlock::kSide).matrix().cwiseMin(high)};
    ForEachCell(cells, [&](const CellIndex& cell) {
      if ((*block)[cell] != kUnknownLogOdds) map->Restore({cell, (*block)[cell]});
    });
  });
}

std::optional<std::int8_t> PersistentMap::LogOdds(const CellIndex& cell) const {
  if (!InTree(cell)) return std::nullopt;
  if (const CellBlock* block = impl_->blocks->Find(cell)) {
    if ((*block)[cell] == kUnknownLogOdds) return std::nullopt;
    return (*block)[cell];
  }
  return impl_->ReadLogOdds(cell);
}

bool PersistentMap::IsOccupied(const CellIndex& cell) const {
  const auto log_odds = LogOdds(cell);
  return log_odds && *log_odds >= impl_->occupied();
}

std::size_t PersistentMap::size() const {
  std::size_t size = impl_->tree->size();
  impl_->blocks->ForEach([&](const CellValue&) { ++size; });
  return size;
}

void PersistentMap::Read(std::istream& in) {
  std::ostringstream text;
  text << in.rdbuf();
  const std::string bytes = text.str();
  const OctomapFile file = CheckOctomapFile(bytes);
  std::unique_ptr<octomap::OcTree> tree = impl_->NewTree();
  ReadNodes(file, tree.get());
  const double scale = file.resolution / impl_->options.resolution;
  if (!(std::abs(scale - 1.0) < kSameSize)) tree = Resampled(*tree, scale, impl_->occupied());
  impl_->tree = std::move(tree);
  impl_->blocks = impl_->NewBlocks();
}

PriorCheck PersistentMap::CheckPrior() const {
  PriorCheck check;
  const int occupied = impl_->occupied();
  impl_->ForEachObstacle([&](const CellCube& cube) {
    for (int z = cube.low.z(); z < cube.low.z() + cube.side; ++z) {
      if (!IsGround({0, 0, z}, impl_->options))
        check.occupied += std::int64_t{cube.side} * cube.side;
    }
  });
  impl_->blocks->ForEachPut([&](const CellValue& sensed) {
    const auto said = impl_->ReadLogOdds(sensed.cell);
    if (!said || IsGround(sensed.cell, impl_->options)) return;
    if (*said >= occupied) {
      ++check.looked_at;
      if (sensed.log_odds < 0) check.gone.push_back(sensed.cell);
    } else if (*said < 0 && sensed.log_odds >= occupied && impl_->IsAmidFree(sensed.cell)) {
      check.appeared.push_back(sensed.cell);
    }
  });
  for (std::vector<CellIndex>* cells : {&check.gone, &check.appeared}) {
    std::sort(cells->begin(), cells->end(), [](const CellIndex& a, const CellIndex& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
  }
  return check;
}

std::vector<CellCube> PersistentMap::PriorObstacles(const CellBox& within) const {
  std::vector<CellCube> obstacles;
  impl_->ForEachObstacle([&](const CellCube& cube) {
    const bool outside = ((cube.low.array() + cube.side <= within.low.array()) ||
                          (cube.low.array() >= within.high.array()))
                             .any();
    const CellIndex top = cube.low.array() + (cube.side - 1);
    if (!outside && !IsGround(top, impl_->options)) obstacles.push_back(cube);
  });
  return obstacles;
}

void PersistentMap::Write(std::ostream& out, MapFormat format) {
  octomap::OcTree& tree = *impl_->tree;
  impl_->blocks->ForEach([&](const CellValue& value) {
    const auto log_odds = static_cast<float>(value.log_odds * OccupancyMap::kLogOddsStep);
    tree.setNodeValue(KeyOf(value.cell), log_odds, true);
  });
  impl_->blocks = impl_->NewBlocks();
  tree.updateInnerOccupancy();
  tree.prune();
  if (format == MapFormat::kLogOdds) {
    WriteHead(format, tree, &out);
    tree.writeData(out);
    return;
  }
  const SureTree sure(tree);
  WriteHead(format, sure, &out);
  if (sure.size() > 0) sure.writeBinaryData(out);
}

}  // namespace touchdown::planning
