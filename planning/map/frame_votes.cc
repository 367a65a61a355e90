// SPDX-License-Identifier: BSD-3-Clause
// A ray enters every cell except its first through one face. The faces of one axis are crossed at equal steps of the
// other two coordinates. So the cells behind them are found axis by axis with two additions each, and no comparison.
// The order along the ray, which costs a traversal a branch per cell, does not matter to votes. Coordinates are in
// fixed point, of 2^-40 cells in a window of 2^22 cells. Over the longest ray the cells are those of a ray displaced
// by less than 1e-9 cells. Each is shifted so that its whole cells are where the address has them. A vote is one
// store, and two are computed at a time. Rays are first clipped to the window, so no cell needs a test.

#include "touchdown/planning/map/frame_votes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace touchdown::planning {

namespace {

constexpr int kVotes = 8;  // looked at in one go
static_assert(std::endian::native == std::endian::little, "a word's first vote is its lowest");
constexpr int kTrackBits = 62;  // of a coordinate in fixed point, its sign left out

std::uint64_t Unsigned(std::int64_t x) { return static_cast<std::uint64_t>(x); }

/// Two numbers in one register, computed at once.
using Pair = std::uint64_t __attribute__((vector_size(16)));

Pair Steps(std::int64_t from, std::int64_t by) { return Pair{Unsigned(from), Unsigned(from + by)}; }
Pair Both(std::int64_t x) { return Pair{Unsigned(x), Unsigned(x)}; }

}  // namespace

FrameVotes::FrameVotes(const Eigen::Vector3i& size_log2)
    : shift_(0, size_log2.x(), size_log2.x() + size_log2.y()),
      point_(kTrackBits - size_log2.sum()),
      one_(std::ldexp(1.0, point_)) {
  for (int c = 0; c < 3; ++c) {
    size_[c] = 1 << size_log2[c];
    bits_[c] = static_cast<std::uint64_t>(size_[c] - 1) << shift_[c];
  }
  votes_.assign((std::size_t{1} << size_log2.sum()) + kVotes, kNone);  // looked at beyond the last
  hits_.reserve(1 << 15);
}

void FrameVotes::Begin(const Eigen::Vector3d& p_WC) {
  p_WC_ = p_WC;
  first_ = CellIn(p_WC);
  low_ = first_;
  high_ = first_ + Eigen::Vector3i::Ones();
  hits_.clear();
}

inline FrameVotes::Track FrameVotes::MakeTrack(const Ray& ray, int axis, int minor) const {
  const double at = p_WC_[minor] + ray.along[minor] * ray.first_cross[axis];
  const double by = ray.along[minor] * ray.per_cell[axis];
  const std::int64_t steps = ray.crossings[axis] - 1;
  // Without a step the ray may be so steep that none could be held.
  Track track = {static_cast<std::int64_t>(at * one_),
                 steps > 0 ? static_cast<std::int64_t>(by * one_) : 0};
  // A coordinate stays between those of both ends, whatever the rounding.
  const auto [near, far] = std::minmax(first_[minor], ray.last[minor]);
  const std::int64_t lowest = static_cast<std::int64_t>(near) << point_;
  const std::int64_t highest = (static_cast<std::int64_t>(far + 1) << point_) - 1;
  track.at = std::clamp(track.at, lowest, highest);
  const std::int64_t last = track.at + steps * track.by;
  if (last < lowest) track.by = (lowest - track.at) / steps;
  if (last > highest) track.by = (highest - track.at) / steps;
  return {track.at << shift_[minor], track.by << shift_[minor]};
}

template <int kAxis>
inline void FrameVotes::MissBehindFaces(const Ray& ray) {
  const int faces = ray.crossings[kAxis];
  if (faces == 0) return;
  constexpr int kA = kAxis == 0 ? 1 : 0;
  constexpr int kB = kAxis == 2 ? 1 : 2;
  const Track on_a = MakeTrack(ray, kAxis, kA);
  const Track on_b = MakeTrack(ray, kAxis, kB);
  const std::int64_t stride = static_cast<std::int64_t>(ray.step[kAxis]) << shift_[kAxis];
  std::uint8_t* plane =
      votes_.data() + (static_cast<std::int64_t>(first_[kAxis] + ray.step[kAxis]) << shift_[kAxis]);
  const int point = point_;
  const std::uint64_t bits_a = bits_[kA], bits_b = bits_[kB];
  // The first face alone, then pairs that begin with it or with the second. So an odd number of
  // faces needs no branch, which would be predicted only half of the time.
  plane[(Unsigned(on_a.at) >> point & bits_a) + (Unsigned(on_b.at) >> point & bits_b)] = kMiss;
  const std::int64_t odd = -(faces & 1);
  Pair at_a = Steps(on_a.at + (on_a.by & odd), on_a.by);
  Pair at_b = Steps(on_b.at + (on_b.by & odd), on_b.by);
  Pair at = Steps(stride & odd, stride);
  const Pair by_a = Both(2 * on_a.by), by_b = Both(2 * on_b.by), by = Both(2 * stride);
  for (int pairs = faces / 2; pairs > 0; --pairs) {
    const Pair address = (at_a >> point & bits_a) + (at_b >> point & bits_b) + at;
    plane[static_cast<std::ptrdiff_t>(address[0])] = kMiss;
    plane[static_cast<std::ptrdiff_t>(address[1])] = kMiss;
    at_a += by_a;
    at_b += by_b;
    at += by;
  }
}

void FrameVotes::AddRay(const Eigen::Vector3d& end) {
  Ray ray;
  ray.along = end - p_WC_;
  double leaves = 2.0;  // ray parameter at which it leaves the window; the end is at 1
  for (int c = 0; c < 3; ++c) {
    const bool up = ray.along[c] >= 0.0;
    const double inverse = 1.0 / ray.along[c];  // infinite along the other axes' planes
    ray.step[c] = up ? 1 : -1;
    ray.per_cell[c] = std::abs(inverse);
    ray.first_cross[c] = (up ? first_[c] + 1 - p_WC_[c] : p_WC_[c] - first_[c]) * ray.per_cell[c];
    leaves = std::min(leaves, (up ? size_[c] - p_WC_[c] : p_WC_[c]) * ray.per_cell[c]);
  }
  const bool ends_within = leaves > 1.0;
  const Eigen::Vector3d stop = ends_within ? end : Eigen::Vector3d(p_WC_ + leaves * ray.along);
  ray.last = CellIn(stop);
  ray.crossings = (ray.last - first_).cwiseAbs();
  low_ = low_.cwiseMin(ray.last);
  high_ = high_.cwiseMax(ray.last + Eigen::Vector3i::Ones());
  if (ends_within) {
    // The face crossed last leads into the end cell. What is behind it gets no vote.
    int final_axis = -1;
    double latest = -1.0;
    for (int c = 0; c < 3; ++c) {
      if (ray.crossings[c] == 0) continue;
      const double t = ray.first_cross[c] + (ray.crossings[c] - 1) * ray.per_cell[c];
      if (t > latest) {
        latest = t;
        final_axis = c;
      }
    }
    if (final_axis < 0) return;  // it ends in the camera's cell
    --ray.crossings[final_axis];
  }
  votes_[Address(first_)] = kMiss;
  MissBehindFaces<0>(ray);
  MissBehindFaces<1>(ray);
  MissBehindFaces<2>(ray);
}

void FrameVotes::AddHit(const Eigen::Vector3d& at, std::uint8_t vote) {
  if ((at.array() < 0.0).any() || (at.array() >= size_.cast<double>().array()).any()) return;
  const Eigen::Vector3i cell = CellIn(at);
  low_ = low_.cwiseMin(cell);
  high_ = high_.cwiseMax(cell + Eigen::Vector3i::Ones());
  hits_.push_back({cell, vote});
}

void FrameVotes::Finish() {
  for (const Hit& hit : hits_) {
    std::uint8_t& vote = votes_[Address(hit.cell)];
    vote = std::max(vote, hit.vote);
  }
}

std::uint64_t FrameVotes::TakeMisses(const Eigen::Vector3i& first, int count) {
  std::uint8_t* votes = &votes_[Address(first)];
  std::uint64_t misses = 0;
  for (int i = 0; i < count; i += kVotes) {
    std::uint64_t eight;
    std::memcpy(&eight, votes + i, sizeof(eight));
    // Each of them is 0 or 1: the product has them side by side in its highest byte.
    misses |= (eight * 0x0102'0408'1020'4080 >> 56) << i;
  }
  misses &= ~std::uint64_t{0} >> (64 - count);
  if (misses != 0) std::memset(votes, kNone, static_cast<std::size_t>(count));
  return misses;
}

}  // namespace touchdown::planning
