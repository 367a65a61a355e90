// SPDX-License-Identifier: BSD-3-Clause
// A ray enters every cell but its first through one face. The faces of one axis are crossed at
// equal steps of the other two coordinates, so the cells behind them are found axis by axis with
// two additions each, none waiting for a comparison: the order along the ray, which a traversal
// pays for with a branch per cell, does not matter to votes. Coordinates are in fixed point of 2^-40
// cells: over the longest ray the cells are those of a ray displaced by less than 1e-9 cells.
// A vote is one store; rays are clipped to the window first, so that no cell needs a test.

#include "touchdown/planning/frame_votes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace touchdown::planning {

namespace {

constexpr int kFraction = 40;  // bits behind the point
constexpr double kOne = static_cast<double>(std::int64_t{1} << kFraction);

}  // namespace

FrameVotes::FrameVotes(const Eigen::Vector3i& size_log2)
    : shift_(0, size_log2.x(), size_log2.x() + size_log2.y()) {
  for (int c = 0; c < 3; ++c) size_[c] = 1 << size_log2[c];
  votes_.assign(std::size_t{1} << size_log2.sum(), kNone);
  hits_.reserve(1 << 15);
}

void FrameVotes::Begin(const Eigen::Vector3d& eye) {
  eye_ = eye;
  first_ = CellIn(eye);
  low_ = first_;
  high_ = first_ + Eigen::Vector3i::Ones();
  hits_.clear();
}

void FrameVotes::AddRay(const Eigen::Vector3d& end) {
  Ray ray;
  ray.along = end - eye_;
  double leaves = 2.0;  // ray parameter at which it leaves the window; the end is at 1
  for (int c = 0; c < 3; ++c) {
    const bool up = ray.along[c] >= 0.0;
    const double inverse = 1.0 / ray.along[c];  // infinite along the other axes' planes
    ray.step[c] = up ? 1 : -1;
    ray.per_cell[c] = std::abs(inverse);
    ray.first_cross[c] = (up ? first_[c] + 1 - eye_[c] : eye_[c] - first_[c]) * ray.per_cell[c];
    leaves = std::min(leaves, (up ? size_[c] - eye_[c] : eye_[c]) * ray.per_cell[c]);
  }
  const bool ends_within = leaves > 1.0;
  const Eigen::Vector3d stop = ends_within ? end : Eigen::Vector3d(eye_ + leaves * ray.along);
  ray.last = CellIn(stop);
  ray.crossings = (ray.last - first_).cwiseAbs();
  low_ = low_.cwiseMin(ray.last);
  high_ = high_.cwiseMax(ray.last + Eigen::Vector3i::Ones());
  if (ends_within) {
    // The face crossed last leads into the end cell: nothing is said of what is behind it.
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
    if (final_axis < 0) return;  // it ends in the eye's own cell
    --ray.crossings[final_axis];
  }
  votes_[Address(first_)] = kMiss;
  for (int axis = 0; axis < 3; ++axis) MissBehindFaces(ray, axis);
}

FrameVotes::Track FrameVotes::MakeTrack(const Ray& ray, int axis, int minor) const {
  const double at = eye_[minor] + ray.along[minor] * ray.first_cross[axis];
  const double by = ray.along[minor] * ray.per_cell[axis];
  Track track = {static_cast<std::int64_t>(at * kOne), static_cast<std::int64_t>(by * kOne)};
  // A coordinate stays between those of both ends, whatever rounding does.
  const auto [near, far] = std::minmax(first_[minor], ray.last[minor]);
  const std::int64_t lowest = static_cast<std::int64_t>(near) << kFraction;
  const std::int64_t highest = (static_cast<std::int64_t>(far + 1) << kFraction) - 1;
  track.at = std::clamp(track.at, lowest, highest);
  const std::int64_t steps = ray.crossings[axis] - 1;
  const std::int64_t last = track.at + steps * track.by;
  if (last < lowest) track.by = (lowest - track.at) / steps;
  if (last > highest) track.by = (highest - track.at) / steps;
  return track;
}

void FrameVotes::MissBehindFaces(const Ray& ray, int axis) {
  if (ray.crossings[axis] == 0) return;
  const int a = axis == 0 ? 1 : 0;
  const int b = axis == 2 ? 1 : 2;
  const Track on_a = MakeTrack(ray, axis, a);
  const Track on_b = MakeTrack(ray, axis, b);
  const int shift_a = shift_[a];
  const int shift_b = shift_[b];
  const std::int64_t stride = static_cast<std::int64_t>(ray.step[axis]) << shift_[axis];
  std::uint8_t* plane =
      votes_.data() + (static_cast<std::int64_t>(first_[axis] + ray.step[axis]) << shift_[axis]);
  std::int64_t at_a = on_a.at;
  std::int64_t at_b = on_b.at;
  for (int left = ray.crossings[axis]; left > 0; --left) {
    plane[((at_a >> kFraction) << shift_a) + ((at_b >> kFraction) << shift_b)] = kMiss;
    plane += stride;
    at_a += on_a.by;
    at_b += on_b.by;
  }
}

void FrameVotes::AddHit(const Eigen::Vector3d& at, std::uint8_t vote) {
  if ((at.array() < 0.0).any() || (at.array() >= size_.cast<double>().array()).any()) return;
  const Eigen::Vector3i cell = CellIn(at);
  low_ = low_.cwiseMin(cell);
  high_ = high_.cwiseMax(cell + Eigen::Vector3i::Ones());
  hits_.push_back({Address(cell), vote});
}

void FrameVotes::Finish() {
  for (const Hit& hit : hits_) votes_[hit.address] = std::max(votes_[hit.address], hit.vote);
}

}  // namespace touchdown::planning
