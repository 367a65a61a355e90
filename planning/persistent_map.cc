// SPDX-License-Identifier: BSD-3-Clause
// Cell (x, y, z) of the rolling map's lattice is OctoMap's key (x + 32768, ...). Log-odds are stored
// as floats that are whole steps of the rolling map, so that they come back exactly. Nodes are set
// lazily: inner nodes are only needed in a file, so they are brought up to date by Write; equal
// neighbours are merged whenever the tree has doubled.

#include "touchdown/planning/persistent_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <octomap/octomap.h>

#include "touchdown/planning/octomap_file.h"

namespace touchdown::planning {

namespace {

constexpr int kKeyOffset = 32768;
constexpr std::size_t kFirstPrune = 1 << 18;  // nodes

std::int8_t Steps(float log_odds) {
  return static_cast<std::int8_t>(
      std::clamp(std::lround(log_odds / OccupancyMap::kLogOddsStep), -127L, 127L));
}

bool InTree(const CellIndex& cell) {
  return (cell.array() >= -kKeyOffset).all() && (cell.array() < kKeyOffset).all();
}

octomap::OcTreeKey KeyOf(const CellIndex& cell) {
  const auto key = [](int c) { return static_cast<octomap::key_type>(c + kKeyOffset); };
  return {key(cell.x()), key(cell.y()), key(cell.z())};
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

  OccupancyMapOptions options;
  std::unique_ptr<octomap::OcTree> tree;
  std::size_t prune_at = kFirstPrune;  // nodes
  std::vector<CellValue> changes;      // of the window that is flushed
};

PersistentMap::PersistentMap(const OccupancyMapOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
PersistentMap::~PersistentMap() = default;
PersistentMap::PersistentMap(PersistentMap&&) noexcept = default;
PersistentMap& PersistentMap::operator=(PersistentMap&&) noexcept = default;

void PersistentMap::Recentre(const Eigen::Vector3d& p_W, OccupancyMap* map) {
  map->Recentre(p_W);
  Store(map->left());
  for (const CellBox& box : map->entered()) Refill(box, map);
}

void PersistentMap::Refill(OccupancyMap* map) const {
  Refill({map->origin(), map->origin() + map->size()}, map);
}

void PersistentMap::Flush(OccupancyMap* map) {
  impl_->changes.clear();
  map->TakeChanges(&impl_->changes);
  Store(impl_->changes);
}

void PersistentMap::Store(const std::vector<CellValue>& values) {
  octomap::OcTree& tree = *impl_->tree;
  for (const CellValue& value : values) {
    if (!InTree(value.cell)) continue;
    const auto log_odds = static_cast<float>(value.log_odds * OccupancyMap::kLogOddsStep);
    tree.setNodeValue(KeyOf(value.cell), log_odds, true);
  }
  if (tree.size() < impl_->prune_at) return;
  tree.prune();
  impl_->prune_at = std::max(kFirstPrune, 2 * tree.size());
}

void PersistentMap::Refill(const CellBox& box, OccupancyMap* map) const {
  const CellIndex low = box.low.cwiseMax(-kKeyOffset);
  const CellIndex high = box.high.cwiseMin(kKeyOffset);
  if ((low.array() >= high.array()).any()) return;
  const octomap::OcTree& tree = *impl_->tree;
  const auto end = tree.end_leafs_bbx();
  for (auto leaf = tree.begin_leafs_bbx(KeyOf(low), KeyOf(high - CellIndex::Ones())); leaf != end;
       ++leaf) {
    // A leaf above the lowest level stands for all the cells in it.
    const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const CellIndex corner(key[0] - kKeyOffset, key[1] - kKeyOffset, key[2] - kKeyOffset);
    const CellBox cells = {corner.cwiseMax(low), (corner.array() + side).matrix().cwiseMin(high)};
    const std::int8_t log_odds = Steps(leaf->getLogOdds());
    ForEachCell(cells, [&](const CellIndex& cell) { map->Restore({cell, log_odds}); });
  }
}

std::optional<std::int8_t> PersistentMap::LogOdds(const CellIndex& cell) const {
  if (!InTree(cell)) return std::nullopt;
  const octomap::OcTreeNode* node = impl_->tree->search(KeyOf(cell));
  if (node == nullptr) return std::nullopt;
  return Steps(node->getLogOdds());
}

bool PersistentMap::IsOccupied(const CellIndex& cell) const {
  const auto log_odds = LogOdds(cell);
  return log_odds && *log_odds * OccupancyMap::kLogOddsStep >=
                         impl_->tree->getOccupancyThresLog() - 0.5 * OccupancyMap::kLogOddsStep;
}

std::size_t PersistentMap::size() const { return impl_->tree->size(); }

void PersistentMap::Read(std::istream& in) {
  std::ostringstream text;
  text << in.rdbuf();
  const std::string bytes = text.str();
  const OctomapFile file = CheckOctomapFile(bytes);
  const double resolution = impl_->options.resolution;
  if (!(std::abs(file.resolution - resolution) < 1e-6 * resolution)) {
    throw std::invalid_argument("its resolution is " + std::to_string(file.resolution) +
                                " m, it must be " + std::to_string(resolution) +
                                " m, the side of the map's cells");
  }
  std::unique_ptr<octomap::OcTree> tree = impl_->NewTree();
  if (!file.nodes.empty()) {
    std::istringstream nodes{std::string(file.nodes)};
    file.format == MapFormat::kBinary ? tree->readBinaryData(nodes) : tree->readData(nodes);
  }
  // OctoMap reads a root without children, a file in which nothing is known, as one occupied leaf.
  if (tree->size() == 1) tree = impl_->NewTree();
  impl_->tree = std::move(tree);
  impl_->prune_at = std::max(kFirstPrune, 2 * impl_->tree->size());
}

void PersistentMap::Write(std::ostream& out, MapFormat format) {
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
