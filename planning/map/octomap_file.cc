// SPDX-License-Identifier: BSD-3-Clause
// The head is text. Its first line names the format. Then come lines "id OcTree", "size <nodes>",
// "res <metres>" in any order, comments, and "data". The nodes follow, depth first.
// .ot: each node has its log-odds (float) and a byte with a bit per child.
// .bt: each inner node has two bits per child: none, free leaf, occupied leaf, or inner node.
// As octomap 1.9 writes them (octomap.github.io, AbstractOcTree and OcTreeBaseImpl).

#include "planning/map/octomap_file.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace touchdown::planning {

namespace {

constexpr int kTreeDepth = 16;
constexpr std::uint64_t kMostNodes = 16 << 20;

[[noreturn]] void Refuse(const std::string& sentence) { throw std::invalid_argument(sentence); }

class NodeWalk {
 public:
  explicit NodeWalk(std::string_view data) : rest_(data) {}

  std::uint64_t nodes() const { return nodes_; }
  bool at_end() const { return rest_.empty(); }

  void LogOddsNode(int depth) {
    ++nodes_;
    float log_odds;
    Take(&log_odds, sizeof(log_odds));
    if (!std::isfinite(log_odds)) Refuse("a node's log-odds are not finite");
    std::uint8_t children;
    Take(&children, sizeof(children));
    if (children != 0) CheckDepth(depth + 1);
    for (int i = 0; i < 8; ++i) {
      if ((children >> i & 1) != 0) LogOddsNode(depth + 1);
    }
  }

  void BinaryNode(int depth) {
    ++nodes_;
    std::uint16_t children;
    Take(&children, sizeof(children));
    if (children != 0) CheckDepth(depth + 1);
    int inner = 0;
    for (int i = 0; i < 8; ++i) {
      const int kind = children >> (2 * i) & 3;
      if (kind == 3) ++inner;
      if (kind == 1 || kind == 2) ++nodes_;
    }
    for (; inner > 0; --inner) BinaryNode(depth + 1);
  }

 private:
  void Take(void* to, std::size_t size) {
    if (rest_.size() < size) Refuse("the file ends before its last node");
    std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  static void CheckDepth(int depth) {
    if (depth > kTreeDepth) Refuse("its nodes are mangled: the tree is deeper than 16 levels");
  }

  std::string_view rest_;
  std::uint64_t nodes_ = 0;
};

/// Takes a line off the front.
std::string_view TakeLine(std::string_view* text) {
  const std::size_t end = text->find('\n');
  if (end == std::string_view::npos) Refuse("the head of the file does not end");
  const std::string_view line = text->substr(0, end);
  text->remove_prefix(end + 1);
  return line;
}

}  // namespace

std::string BytesOf(std::istream& in) {
  constexpr std::size_t kAtATime = 1 << 20;
  std::string bytes;
  while (in && bytes.size() <= kMostMapBytes) {
    const std::size_t size = bytes.size();
    bytes.resize(size + kAtATime);
    in.read(bytes.data() + size, kAtATime);
    bytes.resize(size + static_cast<std::size_t>(in.gcount()));
  }
  if (bytes.size() > kMostMapBytes) Refuse("it is larger than the 128 MiB that are read");
  return bytes;
}

OctomapFile CheckOctomapFile(std::string_view file) {
  OctomapFile result = {MapFormat::kLogOdds, 0.0, {}};
  if (file.substr(0, kOctomapBinaryHead.size()) == kOctomapBinaryHead) {
    result.format = MapFormat::kBinary;
  } else if (file.substr(0, kOctomapLogOddsHead.size()) != kOctomapLogOddsHead) {
    Refuse("it is no OctoMap file (.bt or .ot): the first line must be '" +
           std::string(kOctomapBinaryHead) + "' or '" + std::string(kOctomapLogOddsHead) + "'");
  }
  std::string id;
  std::uint64_t size = 0;
  for (bool data = false; !data;) {
    std::istringstream line{std::string(TakeLine(&file))};
    std::string word;
    line >> word;
    if (word == "id") line >> id;
    if (word == "size") line >> size;
    if (word == "res") line >> result.resolution;
    data = word == "data";
  }
  if (id != "OcTree") Refuse("it holds a tree of type '" + id + "', and only OcTree is read");
  if (!(result.resolution >= 1e-3 && result.resolution <= 100.0)) {
    Refuse("its resolution is " + std::to_string(result.resolution) +
           " m; allowed is [0.001, 100] m");
  }
  if (size > kMostNodes) {
    Refuse("its header says " + std::to_string(size) + " nodes; allowed are 16 million");
  }
  NodeWalk walk(file);
  if (size > 0) {
    result.format == MapFormat::kBinary ? walk.BinaryNode(0) : walk.LogOddsNode(0);
  }
  if (walk.nodes() != size) {
    Refuse("its header says " + std::to_string(size) + " nodes, and it holds " +
           std::to_string(walk.nodes()));
  }
  if (!walk.at_end()) Refuse("there is more behind its last node");
  result.nodes = file;
  return result;
}

}  // namespace touchdown::planning
