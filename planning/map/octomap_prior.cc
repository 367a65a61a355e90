// SPDX-License-Identifier: BSD-3-Clause
// Cell (x, y, z) of the rolling map's lattice is OctoMap's key (x + 32768, ...). Log-odds are stored
// as floats that are whole steps of the rolling map, so that they come back exactly.
#include <cmath>
#include <string>

#include <octomap/octomap.h>

#include "planning/map/octomap_tree.h"
#include "planning/map/prior_tree.h"

namespace touchdown::planning {

namespace {

constexpr double kSameSize = 1e-6;  // within it a file's cells are the map's
constexpr unsigned kLeafDepth = 16;
constexpr unsigned kBlockDepth = kLeafDepth - CellBlock::kSideLog2;  // in the octree

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

// As OctoMap's own write and writeBinary, which print to stderr.
void WriteHead(MapFormat format, const octomap::OcTree& tree, std::ostream* out) {
  *out << (format == MapFormat::kBinary ? kOctomapBinaryHead : kOctomapLogOddsHead)
       << "\nid OcTree\nsize " << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
}

/// The leaves of a tree that are free or occupied. OctoMap's binary format calls every cell free
/// that is not occupied. A cell that was hit, and then passed, is neither. It must not come back as
/// observed free space. The leaves are copied, as OctoMap aborts when a node's last child is
/// deleted.
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

struct PriorTree::Impl {
  explicit Impl(const OccupancyMapOptions& o) : options(o), tree(NewTree()) {}

  std::unique_ptr<octomap::OcTree> NewTree() const {
    auto fresh = std::make_unique<octomap::OcTree>(options.resolution);
    fresh->setProbHit(options.probability_hit);
    fresh->setProbMiss(options.probability_miss);
    fresh->setClampingThresMin(options.probability_min);
    fresh->setClampingThresMax(options.probability_max);
    fresh->setOccupancyThres(options.probability_occupied);
    return fresh;
  }
  /// The octree's node of a block, or the leaf above that stands for it; nullptr: nothing is known.
  const octomap::OcTreeNode* NodeOf(const CellIndex& corner) const {
    return tree->search(KeyOf(corner), kBlockDepth);
  }

  OccupancyMapOptions options;
  std::unique_ptr<octomap::OcTree> tree;
};

PriorTree::PriorTree(const OccupancyMapOptions& options) : impl_(std::make_unique<Impl>(options)) {}
PriorTree::~PriorTree() = default;
PriorTree::PriorTree(PriorTree&&) noexcept = default;
PriorTree& PriorTree::operator=(PriorTree&&) noexcept = default;

int PriorTree::occupied() const { return StepsOf(impl_->tree->getOccupancyThresLog()); }

std::size_t PriorTree::size() const { return impl_->tree->size(); }

bool PriorTree::Knows(const CellIndex& corner) const {
  return size() > 0 && impl_->NodeOf(corner) != nullptr;
}

void PriorTree::Fill(const CellIndex& corner, CellBlock* block) const {
  const octomap::OcTreeNode* node = impl_->NodeOf(corner);
  if (node != nullptr) CopyCells(*impl_->tree, node, corner, CellBlock::kSide, block);
}

std::optional<std::int8_t> PriorTree::LogOdds(const CellIndex& cell) const {
  const octomap::OcTreeNode* node = InTree(cell) ? impl_->tree->search(KeyOf(cell)) : nullptr;
  if (node == nullptr) return std::nullopt;
  return StepsOf(node->getLogOdds());
}

void PriorTree::ForEachObstacle(const std::function<void(const CellCube&)>& visit) const {
  const octomap::OcTree& tree = *impl_->tree;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (StepsOf(leaf->getLogOdds()) < occupied()) continue;
    const octomap::OcTreeKey low = leaf.getIndexKey();
    visit(CellCube{CellIndex(low[0], low[1], low[2]).array() - kKeyOffset,
                   1 << (kLeafDepth - leaf.getDepth())});
  }
}

void PriorTree::Read(std::istream& in) {
  const std::string bytes = BytesOf(in);
  const OctomapFile file = CheckOctomapFile(bytes);
  std::unique_ptr<octomap::OcTree> tree = impl_->NewTree();
  ReadNodes(file, tree.get());
  const double scale = file.resolution / impl_->options.resolution;
  if (!(std::abs(scale - 1.0) < kSameSize)) tree = Resampled(*tree, scale, occupied());
  impl_->tree = std::move(tree);
}

void PriorTree::Put(const CellValue& value) {
  const auto log_odds = static_cast<float>(value.log_odds * OccupancyMap::kLogOddsStep);
  impl_->tree->setNodeValue(KeyOf(value.cell), log_odds, true);
}

void PriorTree::Write(std::ostream& out, MapFormat format) {
  octomap::OcTree& tree = *impl_->tree;
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
