// SPDX-License-Identifier: BSD-3-Clause
// The nodes that a search has seen and not expanded yet. For source files: it draws in a heap of Boost.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>

#include <boost/heap/d_ary_heap.hpp>

namespace touchdown::planning {

/// Addresses of nodes, the least f first, and of these the one that came first.
class SearchQueue {
 public:
  void Reserve(std::size_t size) { nodes_.reserve(size); }
  void Clear() {
    nodes_.clear();
    order_ = 0;
  }
  bool empty() const { return nodes_.empty(); }
  /// @param f must not be negative.
  void Push(float f, std::uint32_t address) {
    // The bits of positive floats are ordered as they are.
    const auto upper = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(f)) << 32;
    nodes_.push({upper | order_++, address});
  }
  std::uint32_t Pop() {
    const std::uint32_t address = nodes_.top().address;
    nodes_.pop();
    return address;
  }

 private:
  struct Node {
    std::uint64_t key;  // f, then the order of insertion
    std::uint32_t address;
    bool operator>(const Node& other) const { return key > other.key; }
  };
  // With four children a node: half the levels of a binary heap, and these are next to each other.
  boost::heap::d_ary_heap<Node, boost::heap::arity<4>, boost::heap::compare<std::greater<Node>>>
      nodes_;
  std::uint32_t order_ = 0;
};

}  // namespace touchdown::planning
