// SPDX-License-Identifier: BSD-3-Clause
// Resampling descends the octree of the new cells. A node over which the file has one value is a
// leaf. So large free space costs little, and only at its borders single cells are tested.
#include "planning/map/octomap_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include <octomap/octomap.h>

#include "touchdown/planning/map/cell_box.h"

namespace touchdown::planning {
namespace {

constexpr int kTreeSide = 65536;        // of a tree [cells]
constexpr double kOverlap = 1e-3;       // that is none [cells]
constexpr int kMostLeaves = 5'000'000;  // of a resampled tree

CellIndex ChildOf(unsigned i) { return {i & 1 ? 1 : 0, i & 2 ? 1 : 0, i & 4 ? 1 : 0}; }

class ResampledTree : public octomap::OcTree {
 public:
  ResampledTree(const octomap::OcTree& from, double scale, int occupied)
      : OcTree(from.getResolution()), from_(from), scale_(scale), occupied_(occupied) {
    setProbHit(from.getProbHit());
    setProbMiss(from.getProbMiss());
    setClampingThresMin(from.getClampingThresMin());
    setClampingThresMax(from.getClampingThresMax());
    setOccupancyThres(from.getOccupancyThres());
    if (from.getRoot() == nullptr) return;
    const CellIndex low = CellIndex::Constant(-kTreeSide / 2);
    Fill(low, kTreeSide, {from.getRoot(), low, kTreeSide});
    updateInnerOccupancy();
    prune();
  }

 private:
  using Node = octomap::OcTreeNode;
  using Value = std::optional<int>;  // log-odds [steps]; none: not known
  /// A node of `from`, and its place [its cells].
  struct Part {
    const Node* node;
    CellIndex low;
    int side;
  };
  /// In cells of this tree.
  struct Box {
    Eigen::Array3d low, high;
  };
  /// What is said of a box.
  struct Said {
    std::optional<Value> first;
    bool mixed = false;
    int most = std::numeric_limits<int>::min();

    void Add(const Value& value) {
      mixed |= first && *first != value;
      first = value;
      if (value) most = std::max(most, *value);
    }
  };

  Box BoxOf(const Part& part) const {
    return {scale_ * part.low.cast<double>().array(),
            scale_ * (part.low.array() + part.side).cast<double>()};
  }
  /// Its node is nullptr where nothing is known.
  Part Child(const Part& part, unsigned i) const {
    const int half = part.side / 2;
    return {from_.nodeChildExists(part.node, i) ? from_.getNodeChild(part.node, i) : nullptr,
            part.low + half * ChildOf(i), half};
  }
  bool HasChildren(const Part& part) const {
    return part.node != nullptr && from_.nodeHasChildren(part.node);
  }
  // What is neither free nor occupied is not known.
  Value ValueOf(const Part& part) const {
    if (part.node == nullptr) return std::nullopt;
    const int log_odds = StepsOf(part.node->getLogOdds());
    return log_odds < 0 || log_odds >= occupied_ ? Value(log_odds) : std::nullopt;
  }

  void Fill(const CellIndex& low, int side, Part part) {
    const Box box = {low.cast<double>().array() + kOverlap,
                     (low.array() + side).cast<double>() - kOverlap};
    part = Smallest(part, box);
    Said said;
    const Box all = BoxOf(part);
    if ((box.low < all.low).any() || (box.high > all.high).any()) said.Add(std::nullopt);
    Look(part, box, side > 1, &said);
    if (!said.mixed) {
      if (said.first && *said.first) Set(low, side, **said.first);
    } else if (side > 1) {
      const int half = side / 2;
      for (unsigned i = 0; i < 8; ++i) Fill(low + half * ChildOf(i), half, part);
    } else if (said.most >= occupied_) {
      Set(low, side, said.most);
    } else if (const Value middle = At(part, low.cast<double>().array() + 0.5)) {
      Set(low, side, *middle);
    }
  }

  /// The smallest part of a part that the box is in.
  Part Smallest(Part part, const Box& box) const {
    while (HasChildren(part)) {
      unsigned i = 0;
      while (i < 8 && !Contains(BoxOf(Child(part, i)), box)) ++i;
      if (i == 8) break;
      part = Child(part, i);
    }
    return part;
  }
  static bool Contains(const Box& all, const Box& box) {
    return (all.low <= box.low).all() && (all.high >= box.high).all();
  }

  void Look(const Part& part, const Box& box, bool until_mixed, Said* said) const {
    const Box place = BoxOf(part);
    if ((place.low >= box.high).any() || (place.high <= box.low).any()) return;
    if (!HasChildren(part)) return said->Add(ValueOf(part));
    for (unsigned i = 0; i < 8 && !(until_mixed && said->mixed); ++i) {
      Look(Child(part, i), box, until_mixed, said);
    }
  }

  Value At(Part part, const Eigen::Array3d& p) const {
    const Box all = BoxOf(part);
    if ((p < all.low).any() || (p >= all.high).any()) return std::nullopt;
    while (HasChildren(part)) {
      const Eigen::Array3d middle = scale_ * (part.low.array() + part.side / 2).cast<double>();
      const auto beyond = [&](int axis) { return p[axis] >= middle[axis] ? 1u << axis : 0u; };
      part = Child(part, beyond(0) | beyond(1) | beyond(2));
    }
    return ValueOf(part);
  }

  void Set(const CellIndex& low, int side, int log_odds) {
    if (++leaves_ > kMostLeaves) {
      throw std::invalid_argument(
          "in cells of " + std::to_string(getResolution()) +
          " m it has more than five million leaves; crop the file to the flown area");
    }
    if (root == nullptr) {
      root = new Node;
      ++tree_size;
    }
    Node* node = root;
    for (int half = kTreeSide / 2; half >= side; half /= 2) {
      const auto beyond = [&](int axis) {
        return ((low[axis] + kTreeSide / 2) & half) != 0 ? 1u << axis : 0u;
      };
      const unsigned i = beyond(0) | beyond(1) | beyond(2);
      node = nodeChildExists(node, i) ? getNodeChild(node, i) : createNodeChild(node, i);
    }
    node->setLogOdds(static_cast<float>(log_odds * OccupancyMap::kLogOddsStep));
  }

  const octomap::OcTree& from_;
  const double scale_;
  const int occupied_;
  int leaves_ = 0;
};

}  // namespace

void ReadNodes(const OctomapFile& file, octomap::OcTree* tree) {
  if (file.nodes.empty()) return;
  std::istringstream nodes{std::string(file.nodes)};
  file.format == MapFormat::kBinary ? tree->readBinaryData(nodes) : tree->readData(nodes);
  // OctoMap reads a root without children, a file in which nothing is known, as one occupied leaf.
  if (tree->size() == 1) tree->clear();
}

std::int8_t StepsOf(float log_odds) {
  return static_cast<std::int8_t>(
      std::clamp(std::lround(log_odds / OccupancyMap::kLogOddsStep), -127L, 127L));
}

std::unique_ptr<octomap::OcTree> Resampled(const octomap::OcTree& from, double scale,
                                           int occupied) {
  return std::make_unique<ResampledTree>(from, scale, occupied);
}

}  // namespace touchdown::planning
