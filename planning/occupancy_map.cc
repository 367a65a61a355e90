// SPDX-License-Identifier: BSD-3-Clause
// A rolling window of log-odds cells, addressed modulo its power-of-two size so that moving it
// copies nothing. Log-odds are kept in steps of 1/16 in one byte. Inflation is incremental: every
// cell holds the number of occupied cells whose ball covers it, so that one flip costs one ball and
// a query one load. Fusion as in A. Hornung et al., "OctoMap", Autonomous Robots 2013, section 3:
// rays clear, end points hit, one update per cell and frame in which hits win. Votes are collected
// first (frame_votes.h) and applied row by row.

#include "touchdown/planning/occupancy_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

std::int8_t Quantise(double probability) {
  return static_cast<std::int8_t>(
      std::lround(std::log(probability / (1.0 - probability)) / OccupancyMap::kLogOddsStep));
}

void Require(bool ok, const std::string& sentence) {
  if (!ok) throw std::invalid_argument("OccupancyMap: " + sentence);
}

const Eigen::Vector3i& CheckedSize(const Eigen::Vector3i& size_log2) {
  Require((size_log2.array() >= 4).all() && (size_log2.array() <= 10).all(),
          "size_log2 must be in [4, 10] on every axis");
  return size_log2;
}

/// Bit i: counts[i] > 0.
std::uint64_t NotZero(const std::uint16_t* counts, int n) {
  std::uint64_t bits = 0;
  for (int i = 0; i < n; ++i) bits |= static_cast<std::uint64_t>(counts[i] > 0) << i;
  return bits;
}

std::uint8_t VoteOf(ReturnKind kind) {
  switch (kind) {
    case ReturnKind::kPad:
      return FrameVotes::kPad;
    case ReturnKind::kDoubtful:
      return FrameVotes::kDoubt;
    case ReturnKind::kObstacle:
      break;
  }
  return FrameVotes::kHit;
}

void CheckDepths(const estimation::DepthFrame& frame) {
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  const auto pixels = static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
  if (frame.depth.size() == pixels) return;
  throw std::invalid_argument("OccupancyMap: the frame has " + std::to_string(frame.depth.size()) +
                              " depths, it must have " + std::to_string(k.width) + " x " +
                              std::to_string(k.height));
}

}  // namespace

OccupancyMap::OccupancyMap(const OccupancyMapOptions& options)
    : options_(options), votes_(CheckedSize(options.size_log2)) {
  const auto number = [](double x) { return std::to_string(x); };
  Require(options.resolution > 0.0 && options.resolution <= 1.0,
          "resolution is " + number(options.resolution) + " m, it must be in (0, 1]");
  Require(options.inflation_radius >= 0.0 && options.inflation_radius <= 10 * options.resolution,
          "inflation_radius is " + number(options.inflation_radius) + " m, it must be in [0, " +
              number(10 * options.resolution) + "]");
  Require(options.thinnest_obstacle > 0.0,
          "thinnest_obstacle is " + number(options.thinnest_obstacle) + " m, it must be > 0");
  Require(options.range_noise >= 0.0 && options.range_noise < 1.0 / kNoiseSigmas,
          "range_noise is " + number(options.range_noise) + ", it must be in [0, 1/3)");
  Require(options.probability_min > 0.0 && options.probability_min < options.probability_miss &&
              options.probability_miss < 0.5 && options.probability_hit > 0.5 &&
              options.probability_hit < options.probability_max && options.probability_max < 1.0,
          "probabilities must satisfy 0 < min < miss < 0.5 < hit < max < 1");
  const std::int8_t hit = Quantise(options.probability_hit);
  miss_ = Quantise(options.probability_miss);
  min_ = Quantise(options.probability_min);
  max_ = Quantise(options.probability_max);
  occupied_ = Quantise(options.probability_occupied);
  Require(occupied_ > 0 && occupied_ <= max_, "probability_occupied is " +
                                                  number(options.probability_occupied) +
                                                  ", it must be in (0.5, probability_max]");

  for (int c = 0; c < 3; ++c) size_[c] = 1 << options.size_log2[c];
  mask_ = size_ - CellIndex::Ones();
  const auto cells = static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                     static_cast<std::size_t>(size_.z());
  cells_.assign(cells, Cell{});
  inflation_.assign(cells, 0);
  words_per_row_ = (static_cast<std::size_t>(size_.x()) + kWord - 1) / kWord;
  blocked_.assign(cells / static_cast<std::size_t>(size_.x()) * words_per_row_, 0);
  free_.assign(blocked_.size(), 0);
  for (int old = -128; old < 128; ++old) {
    const auto after = [&](int change) {
      return static_cast<std::int8_t>(
          std::clamp<int>((old == kUnknown ? 0 : old) + change, min_, max_));
    };
    const auto i = static_cast<std::uint8_t>(old);
    after_miss_[i] = after(miss_);
    after_hit_[i] = std::max({occupied_, hit, after(hit)});
  }

  // A cell is blocked if any of its points is nearer than the radius to any point of an occupied
  // cell.
  const double reach = (options.inflation_radius + kChordSagitta) / options.resolution;
  const int n = options.inflation_radius > 0.0 ? static_cast<int>(std::ceil(reach)) + 1 : 0;
  for (int z = -n; z <= n; ++z) {
    for (int y = -n; y <= n; ++y) {
      int half = -1;  // a row is an interval, as a ball is convex
      for (int x = 0; x <= n; ++x) {
        const auto gap = [](int i) { return std::max(0, std::abs(i) - 1); };
        const double distance = std::sqrt(gap(x) * gap(x) + gap(y) * gap(y) + gap(z) * gap(z));
        if (n == 0 || distance < reach) half = x;
      }
      if (half < 0) continue;
      ball_.push_back({half, y, z});
      ball_reach_ = std::max({ball_reach_, half, std::abs(y), std::abs(z)});
    }
  }
  flips_.reserve(1 << 14);
  doubts_.reserve(1 << 14);
  left_.reserve(1 << 14);
  entered_.reserve(3);
  slabs_.reserve(3);
  origin_ = -size_ / 2;
}

bool OccupancyMap::IsOccupied(const CellIndex& cell) const {
  return InWindow(cell) && Blocks(cells_[Address(cell)]);
}

bool OccupancyMap::IsKnown(const CellIndex& cell) const {
  return InWindow(cell) && cells_[Address(cell)].log_odds != kUnknown;
}

std::int64_t OccupancyMap::CountObservedFree() const {
  std::int64_t count = 0;
  for (const std::uint64_t word : free_) count += std::popcount(word);
  return count;
}

void OccupancyMap::Integrate(const estimation::DepthFrame& frame, const PadOutline& pad) {
  flips_.clear();
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  CheckDepths(frame);
  const bool pose_known = frame.p_WC.allFinite() && frame.R_WC.allFinite();
  if (!pose_known || !InWindow(CellOf(frame.p_WC))) return;
  const double cells_per_metre = 1.0 / options_.resolution;
  const Eigen::Vector3d corner = origin_.cast<double>();
  const auto in_window = [&](const Eigen::Vector3d& p_W) -> Eigen::Vector3d {
    return p_W * cells_per_metre - corner;
  };
  votes_.Begin(in_window(frame.p_WC));
  const double per_pixel = 1.0 / k.focal;
  // Farther away an obstacle may stand between two pixels.
  const double resolved = options_.thinnest_obstacle * k.focal;
  sharp_ = 0.5 * resolved;
  const double short_of_return = 1.0 - kNoiseSigmas * options_.range_noise;
  const float* depth = frame.depth.data();
  for (int v = 0; v < k.height; ++v) {
    const double down = (v + 0.5 - k.cy) * per_pixel;
    const Eigen::Vector3d row_W = frame.R_WC.col(2) + frame.R_WC.col(1) * down;
    for (int u = 0; u < k.width; ++u) {
      double along = *depth++;        // the optical axis [m]
      if (!(along >= 0.0)) continue;  // an invalid pixel says nothing
      const double right = (u + 0.5 - k.cx) * per_pixel;
      const double per_depth = std::sqrt(1.0 + right * right + down * down);
      const bool returned = std::isfinite(along);
      if (!returned) along = frame.max_range / per_depth;
      if (along * per_depth < options_.min_ray) continue;
      const Eigen::Vector3d ray_W = row_W + frame.R_WC.col(0) * right;
      const double freed = std::min(returned ? along * short_of_return : along, resolved);
      votes_.AddRay(in_window(frame.p_WC + ray_W * freed));
      if (!returned) continue;
      const Eigen::Vector3d end = frame.p_WC + ray_W * along;
      if (end.z() <= options_.ground_height) continue;
      votes_.AddHit(in_window(end), VoteOf(pad.Classify(end, ToleranceAt(along * per_depth))));
    }
  }
  votes_.Finish();
  ApplyVotes(frame.p_WC, frame.t);
}

void OccupancyMap::ApplyVotes(const Eigen::Vector3d& eye, double t) {
  constexpr int kVotes = 8;  // looked at in one go: most have none
  static_assert(std::endian::native == std::endian::little, "a word's first vote is its lowest");
  CellIndex cell;
  for (int z = votes_.low().z(); z < votes_.high().z(); ++z) {
    cell.z() = origin_.z() + z;
    for (int y = votes_.low().y(); y < votes_.high().y(); ++y) {
      cell.y() = origin_.y() + y;
      const std::size_t row = RowAddress(cell.y(), cell.z());
      std::uint8_t* votes = votes_.Row(y, z);
      for (int x = votes_.low().x() / kVotes * kVotes; x < votes_.high().x(); x += kVotes) {
        std::uint64_t word;
        std::memcpy(&word, votes + x, sizeof(word));
        if (word == 0) continue;
        std::memset(votes + x, FrameVotes::kNone, sizeof(word));
        cell.x() = origin_.x() + x;
        for (; word != 0; word >>= 8, ++cell.x()) {
          const auto vote = static_cast<std::uint8_t>(word & 0xff);
          if (vote == FrameVotes::kNone) continue;
          Cell& stored = cells_[row | static_cast<std::size_t>(cell.x() & mask_.x())];
          // Nearly all votes say again that free space is free.
          const bool settled = vote == FrameVotes::kMiss && stored.log_odds == min_;
          if (!settled || !IsObservedFree(cell)) Apply(vote, cell, eye, t);
        }
      }
    }
  }
}

int OccupancyMap::RangeOf(const CellIndex& cell, const Eigen::Vector3d& eye) const {
  const double steps = (CentreOf(cell) - eye).norm() / kRangeStep;
  return std::min(static_cast<int>(steps), kFarthest);
}

void OccupancyMap::Apply(std::uint8_t vote, const CellIndex& cell, const Eigen::Vector3d& eye,
                         double t) {
  Cell value = cells_[Address(cell)];
  const auto old = static_cast<std::uint8_t>(value.log_odds);
  const bool was_hit = value.log_odds >= 0;
  if (vote == FrameVotes::kMiss) {
    // What may have been the pad has moved on with it; any other hit is outweighed by a better look only.
    const bool better = value.doubtful || RangeOf(cell, eye) < value.hit_range ||
                        (CentreOf(cell) - eye).norm() <= sharp_;
    if (was_hit && !better) return;
    value.log_odds = after_miss_[old];
    if (value.log_odds < 0) value.doubtful = false;
    Set(cell, value);
    SetObservedFree(cell, value.log_odds < 0);
    return;
  }
  SetObservedFree(cell, false);
  if (vote == FrameVotes::kPad) {
    value.log_odds = kUnknown;
    value.doubtful = false;
    return Set(cell, value);
  }
  const bool firm = Blocks(value);
  if (vote == FrameVotes::kDoubt && firm) return;
  const int range = RangeOf(cell, eye);
  value.hit_range = static_cast<std::uint8_t>(
      (was_hit ? std::min<int>(value.hit_range, range) : range) & kFarthest);
  value.doubtful = vote == FrameVotes::kDoubt;
  value.log_odds = after_hit_[old];
  Set(cell, value);
  if (!value.doubtful) return;
  if (doubts_.size() == doubts_.capacity()) return MakeCertain(cell, false);  // no room: it blocks
  // The cell's centre will stand for the return, which was anywhere in it.
  const double offset = 0.5 * options_.resolution;
  doubts_.push_back({t, cell, ToleranceAt((CentreOf(cell) - eye).norm()) + offset});
}

void OccupancyMap::MakeCertain(const CellIndex& cell, bool explained) {
  Cell value = cells_[Address(cell)];
  value.doubtful = false;
  if (explained) value.log_odds = kUnknown;
  Set(cell, value);
}

void OccupancyMap::SetOccupied(const Eigen::Vector3d& p_W) {
  SetState(CellOf(p_W), CellState::kOccupied);
}

void OccupancyMap::SetState(const CellIndex& cell, CellState state) {
  flips_.clear();
  if (!InWindow(cell)) return;
  Cell value;
  if (state != CellState::kUnknown) value.log_odds = state == CellState::kFree ? min_ : max_;
  Set(cell, value);
  SetObservedFree(cell, state == CellState::kFree);
}

void OccupancyMap::MarkFree(const Eigen::Vector3d& p_W, double radius) {
  const CellIndex low = CellOf(p_W.array() - radius);
  const CellIndex high = CellOf(p_W.array() + radius) + CellIndex::Ones();
  ForEachCell({low, high}, [&](const CellIndex& cell) {
    if (!InWindow(cell) || (CentreOf(cell) - p_W).norm() > radius) return;
    Cell value = cells_[Address(cell)];
    if (Blocks(value)) return;
    if (value.log_odds >= 0 || value.log_odds == kUnknown) value.log_odds = miss_;
    value.doubtful = false;
    Set(cell, value);
    SetObservedFree(cell, true);
  });
}

void OccupancyMap::MarkRestFree() {
  flips_.clear();
  ForEachCell({origin_, origin_ + size_}, [&](const CellIndex& cell) {
    Cell value = cells_[Address(cell)];
    if (Blocks(value)) return;
    value.log_odds = min_;
    value.doubtful = false;
    Set(cell, value);
    SetObservedFree(cell, true);
  });
}

void OccupancyMap::SetObservedFree(const CellIndex& cell, bool free) {
  const auto x = static_cast<std::size_t>(cell.x() & mask_.x());
  std::uint64_t& word = free_[RowIndex(cell.y(), cell.z()) * words_per_row_ + x / kWord];
  const std::uint64_t bit = std::uint64_t{1} << (x % kWord);
  word = free ? word | bit : word & ~bit;
}

void OccupancyMap::Set(const CellIndex& cell, Cell value) {
  Cell& stored = cells_[Address(cell)];
  const bool was = Blocks(stored);
  const bool is = Blocks(value);
  stored = value;
  stored.changed = true;
  if (was == is) return;
  Inflate(cell, is ? 1 : -1);
  flips_.push_back({cell, is});
}

void OccupancyMap::Inflate(const CellIndex& cell, int increment) {
  for (const BallRow& row : ball_) {
    AddToRow(cell.y() + row.y, cell.z() + row.z, cell.x() - row.half, cell.x() + row.half + 1,
             increment);
  }
}

/// Calls visit(from, count) for the at most kWord cells long stretches of addresses in a row of the
/// window that hold the cells [x_begin, x_end), none of which crosses a word's edge.
template <class Visit>
void OccupancyMap::ForEachStretch(int x_begin, int x_end, Visit&& visit) const {
  constexpr int kCells = static_cast<int>(kWord);
  for (int x = x_begin; x < x_end;) {
    const int from = x & mask_.x();
    const int room = std::min(kCells - from % kCells, size_.x() - from);
    const int count = std::min(room, x_end - x);
    visit(from, count);
    x += count;
  }
}

/// Bits of the addresses [from, from + count), which are in one word of a row.
void OccupancyMap::StoreBits(std::size_t row, int from, int count, std::uint64_t bits) {
  const auto x = static_cast<std::size_t>(from);
  const std::uint64_t these = ~std::uint64_t{0} >> (static_cast<int>(kWord) - count) << (x % kWord);
  std::uint64_t& word = blocked_[row * words_per_row_ + x / kWord];
  word = (word & ~these) | (bits << (x % kWord) & these);
}

// Cells [x_begin, x_end) of a row, as far as they are in the window.
void OccupancyMap::AddToRow(int y, int z, int x_begin, int x_end, int increment) {
  const CellIndex end = origin_ + size_;
  if (y < origin_.y() || y >= end.y() || z < origin_.z() || z >= end.z()) return;
  x_begin = std::max(x_begin, origin_.x());
  x_end = std::min(x_end, end.x());
  const std::size_t row = RowIndex(y, z);
  ForEachStretch(x_begin, x_end, [&](int from, int count) {
    std::uint16_t* covers = &inflation_[RowAddress(y, z) + static_cast<std::size_t>(from)];
    for (int i = 0; i < count; ++i) covers[i] = static_cast<std::uint16_t>(covers[i] + increment);
    StoreBits(row, from, count, increment > 0 ? ~std::uint64_t{0} : NotZero(covers, count));
  });
}

/// As if there were no obstacle: of cells that enter the window.
void OccupancyMap::ClearRow(int y, int z, int x_begin, int x_end) {
  ForEachStretch(x_begin, x_end, [&](int from, int count) {
    std::fill_n(&inflation_[RowAddress(y, z) + static_cast<std::size_t>(from)], count, 0);
    StoreBits(RowIndex(y, z), from, count, 0);
  });
}

}  // namespace touchdown::planning
