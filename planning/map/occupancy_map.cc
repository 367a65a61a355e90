// SPDX-License-Identifier: BSD-3-Clause
// A rolling window of log-odds cells, addressed modulo its power-of-two size so that moving it
// copies nothing. Log-odds are kept in steps of 1/16 in one byte. Inflation is incremental: every
// cell holds the number of occupied cells whose ball covers it. So one flip costs one ball, and a
// query one load. Fusion as in A. Hornung et al., "OctoMap", Autonomous Robots 2013, section 3.
// Rays clear, end points hit, and each frame updates a cell once, in which hits win. Votes are
// collected first (frame_votes.h) and applied row by row.

#include "touchdown/planning/map/occupancy_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

std::int8_t Quantise(double probability) {
  return static_cast<std::int8_t>(
      std::lround(std::log(probability / (1.0 - probability)) / OccupancyMap::kLogOddsStep));
}

constexpr double kFarthestFree = 1e4;  // [m]

void Require(bool ok, const std::string& sentence) {
  if (!ok) throw std::invalid_argument("OccupancyMap: " + sentence);
}

const Eigen::Vector3i& CheckedSize(const Eigen::Vector3i& size_log2) {
  Require((size_log2.array() >= 4).all() && (size_log2.array() <= 10).all(),
          "size_log2 must be in [4, 10] on every axis");
  return size_log2;
}

/// Counts are added to eight at a time.
constexpr int kLanes = 8;
using Lanes = std::uint16_t __attribute__((vector_size(2 * kLanes)));

Lanes Load(const std::uint16_t* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

/// All bits of the first n lanes.
Lanes First(int n) {
  constexpr std::uint16_t k = 0xffff;
  constexpr std::array<std::uint16_t, 2 * kLanes> kSome = {k, k, k, k, k, k, k, k};
  return Load(&kSome[static_cast<std::size_t>(kLanes - n)]);
}

/// Bit i: lane i is not zero.
std::uint64_t NotZero(const Lanes& counts) {
  const Lanes bits = (counts != 0) & Lanes{1, 2, 4, 8, 16, 32, 64, 128};
  std::array<std::uint64_t, 2> half;
  std::memcpy(half.data(), &bits, sizeof(bits));
  std::uint64_t all = half[0] | half[1];
  all |= all >> 32;
  all |= all >> 16;
  return all & 0xff;
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
  const std::size_t padded = cells + kLevelPadding * static_cast<std::size_t>(size_.z());
  cells_.assign(padded, Cell{});
  inflation_.assign(padded + kLanes, 0);  // a row's last lanes may be beyond
  words_per_row_ = static_cast<std::size_t>((size_.x() + kWord - 1) / kWord);
  for (Bits* bits : {&blocked_, &free_, &known_, &obstacles_, &settled_}) {
    bits->assign(cells / static_cast<std::size_t>(size_.x()) * words_per_row_, 0);
  }
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
  std::stable_sort(ball_.begin(), ball_.end(),
                   [](const BallRow& a, const BallRow& b) { return a.half < b.half; });
  doubts_.reserve(kMostDoubts);
  entered_.reserve(3);
  slabs_.reserve(3);
  origin_ = -size_ / 2;
}

std::int64_t OccupancyMap::CountObservedFree() const {
  std::int64_t count = 0;
  for (const std::uint64_t word : free_) count += std::popcount(word);
  return count;
}

void OccupancyMap::Integrate(const estimation::DepthFrame& frame, const PadOutline& pad) {
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  CheckDepths(frame);
  if (!estimation::IsPossible(frame) || !HasIndex(frame.p_WC)) return;
  if (!InWindow(CellOf(frame.p_WC))) return;
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
  const double farthest = frame.max_range * (1.0 + kNoiseSigmas * options_.range_noise + 1e-6);
  const float* depth = frame.depth.data();
  for (int v = 0; v < k.height; ++v) {
    const double down = (v + 0.5 - k.cy) * per_pixel;
    const Eigen::Vector3d row_W = frame.R_WC.col(2) + frame.R_WC.col(1) * down;
    for (int u = 0; u < k.width; ++u) {
      double along = *depth++;  // the optical axis [m]
      const double right = (u + 0.5 - k.cx) * per_pixel;
      const double per_depth = std::sqrt(1.0 + right * right + down * down);
      const bool returned = along != std::numeric_limits<double>::infinity();
      if (!returned) along = frame.max_range / per_depth;
      const double range = along * per_depth;
      if (!(range > 0.0 && range >= options_.min_ray && range <= farthest))
        continue;  // it says nothing
      const Eigen::Vector3d ray_W = row_W + frame.R_WC.col(0) * right;
      const double freed = std::min(returned ? along * short_of_return : along, resolved);
      votes_.AddRay(in_window(frame.p_WC + ray_W * freed));
      if (!returned) continue;
      const Eigen::Vector3d end = frame.p_WC + ray_W * along;
      if (end.z() <= options_.ground_height) continue;
      votes_.AddHit(in_window(end), VoteOf(pad.Classify(end, ToleranceAt(range))));
    }
  }
  votes_.Finish();
  votes_.TakeReturns([&](const Eigen::Vector3i& cell, std::uint8_t vote) {
    ApplyReturn(vote, origin_ + cell, frame.p_WC, frame.t);
  });
  ApplyMisses(frame.p_WC);
}

void OccupancyMap::ApplyMisses(const Eigen::Vector3d& p_WC) {
  ForEachStretch({origin_ + votes_.low(), origin_ + votes_.high()}, [&](const Stretch& s) {
    // Nearly all votes say again that free space is free.
    std::uint64_t misses =
        votes_.TakeMisses(s.first - origin_, s.count) & ~(settled_[s.word] >> s.shift);
    std::uint64_t freed = 0, settled = 0;
    for (; misses != 0; misses &= misses - 1) {
      const int i = std::countr_zero(misses);
      Cell& cell = cells_[s.address + static_cast<std::size_t>(i)];
      if (cell.log_odds >= 0) {
        ApplyMissToHit(s.first + i * CellIndex::UnitX(), p_WC);
        continue;
      }
      const std::uint64_t bit = std::uint64_t{1} << i;
      freed |= bit;
      settled |= cell.log_odds == min_ ? bit : 0;
      cell.changed |= cell.log_odds != min_ || (free_[s.word] >> s.shift & bit) == 0;
      cell.log_odds = after_miss_[static_cast<std::uint8_t>(cell.log_odds)];
    }
    free_[s.word] |= freed << s.shift;
    known_[s.word] |= freed << s.shift;
    settled_[s.word] |= settled << s.shift;
  });
}

int OccupancyMap::RangeOf(const CellIndex& cell, const Eigen::Vector3d& p_WC) const {
  const double steps = (CentreOf(cell) - p_WC).norm() / kRangeStep;
  return std::min(static_cast<int>(steps), kFarthest);
}

void OccupancyMap::ApplyMissToHit(const CellIndex& cell, const Eigen::Vector3d& p_WC) {
  Cell value = cells_[Address(cell)];
  // What may have been the pad has moved on with it. Any other hit needs a better look.
  const bool better = value.doubtful || RangeOf(cell, p_WC) < value.hit_range ||
                      (CentreOf(cell) - p_WC).norm() <= sharp_;
  if (!better) return;
  value.log_odds = after_miss_[static_cast<std::uint8_t>(value.log_odds)];
  if (value.log_odds < 0) value.doubtful = false;
  Set(cell, value);
  SetBit(cell, value.log_odds < 0, &free_);
}

void OccupancyMap::ApplyReturn(std::uint8_t vote, const CellIndex& cell,
                               const Eigen::Vector3d& p_WC, double t) {
  Cell value = cells_[Address(cell)];
  SetBit(cell, false, &free_);
  if (vote == FrameVotes::kPad) {
    value.log_odds = kUnknown;
    value.doubtful = false;
    return Set(cell, value);
  }
  const bool firm = Blocks(value);
  if (vote == FrameVotes::kDoubt && firm) return;
  const int range = RangeOf(cell, p_WC);
  value.hit_range = static_cast<std::uint8_t>(
      (value.log_odds >= 0 ? std::min<int>(value.hit_range, range) : range) & kFarthest);
  value.doubtful = vote == FrameVotes::kDoubt;
  value.log_odds = after_hit_[static_cast<std::uint8_t>(value.log_odds)];
  Set(cell, value);
  if (!value.doubtful) return;
  // A pad that is not known for long is no reason to call its sides obstacles. Their cells stay in doubt.
  if (doubts_.size() == kMostDoubts)
    doubts_.erase(doubts_.begin(), doubts_.begin() + kMostDoubts / 2);
  // The cell's centre will represent the return, which was anywhere in it.
  const double offset = 0.5 * options_.resolution;
  doubts_.push_back({t, cell, ToleranceAt((CentreOf(cell) - p_WC).norm()) + offset});
}

void OccupancyMap::MakeCertain(const CellIndex& cell, bool explained) {
  Cell value = cells_[Address(cell)];
  value.doubtful = false;
  if (explained) value.log_odds = kUnknown;
  Set(cell, value);
}

void OccupancyMap::SetOccupied(const Eigen::Vector3d& p_W) {
  Require(p_W.allFinite(), "SetOccupied at a point that is not finite");
  if (!HasIndex(p_W)) return;
  SetState(CellOf(p_W), CellState::kOccupied);
}

void OccupancyMap::SetState(const CellIndex& cell, CellState state) {
  if (!InWindow(cell)) return;
  Cell value;
  if (state != CellState::kUnknown) value.log_odds = state == CellState::kFree ? min_ : max_;
  Set(cell, value);
  SetBit(cell, state == CellState::kFree, &free_);
}

void OccupancyMap::MarkFree(const Eigen::Vector3d& p_W, double radius) {
  Require(p_W.allFinite(), "MarkFree at a point that is not finite");
  Require(radius >= 0.0 && radius <= kFarthestFree,
          "MarkFree with radius " + std::to_string(radius) + " m, it must be in [0, 1e4]");
  if (!HasIndex(p_W)) return;
  const CellIndex low = CellOf(p_W.array() - radius).cwiseMax(origin_);
  const CellIndex high =
      (CellOf(p_W.array() + radius) + CellIndex::Ones()).cwiseMin(origin_ + size_);
  ForEachCell({low, high}, [&](const CellIndex& cell) {
    if ((CentreOf(cell) - p_W).norm() > radius) return;
    Cell value = cells_[Address(cell)];
    if (Blocks(value)) return;
    if (value.log_odds >= 0 || value.log_odds == kUnknown) value.log_odds = miss_;
    value.doubtful = false;
    Set(cell, value);
    SetBit(cell, true, &free_);
  });
}

void OccupancyMap::MarkRestFree() {
  ForEachStretch(window(), [&](const Stretch& s) {
    const std::uint64_t rest = s.mask() & ~obstacles_[s.word];
    known_[s.word] |= rest;
    free_[s.word] |= rest;
    settled_[s.word] &= ~rest;
    for (Cell* cell = &cells_[s.address]; cell != &cells_[s.address] + s.count; ++cell) {
      if (Blocks(*cell)) continue;
      cell->log_odds = min_;
      cell->doubtful = false;
      cell->changed = true;
    }
  });
}

void OccupancyMap::SetBit(const CellIndex& cell, bool on, Bits* bits) const {
  const int x = cell.x() & mask_.x();
  std::uint64_t& word =
      (*bits)[RowIndex(cell.y(), cell.z()) * words_per_row_ + static_cast<std::size_t>(x / kWord)];
  const std::uint64_t bit = std::uint64_t{1} << (x % kWord);
  word = on ? word | bit : word & ~bit;
}

void OccupancyMap::Set(const CellIndex& cell, Cell value) {
  Cell& stored = cells_[Address(cell)];
  const bool was = Blocks(stored);
  const bool is = Blocks(value);
  stored = value;
  stored.changed = true;
  SetBit(cell, value.log_odds != kUnknown, &known_);
  SetBit(cell, false, &settled_);
  if (was == is) return;
  SetBit(cell, is, &obstacles_);
  Inflate(cell, is ? 1 : -1, window());
}

/// Adds to the cells of the obstacle's ball that are in a box within the window.
void OccupancyMap::Inflate(const CellIndex& cell, int increment, const CellBox& within) {
  if (((cell.array() + ball_reach_ < within.low.array()) ||
       (cell.array() - ball_reach_ >= within.high.array()))
          .any()) {
    return;
  }
  for (std::size_t begin = 0, end = 0; begin < ball_.size(); begin = end) {
    const int half = ball_[begin].half;
    while (end < ball_.size() && ball_[end].half == half) ++end;
    ForEachStretch(std::max(cell.x() - half, within.low.x()),
                   std::min(cell.x() + half + 1, within.high.x()), 0, 0,
                   [&](const Stretch& s) { AddToRows(cell, begin, end, s, increment, within); });
  }
}

/// Adds to one stretch, given as one of the row (0, 0), in the rows [begin, end) of an obstacle's ball.
void OccupancyMap::AddToRows(const CellIndex& cell, std::size_t begin, std::size_t end,
                             const Stretch& s, int increment, const CellBox& within) {
  std::array<Lanes, kWord / kLanes> adds;
  std::size_t chunks = 0;
  for (int from = 0; from < s.count; from += kLanes) {
    adds[chunks++] =
        static_cast<std::uint16_t>(increment) & First(std::min(kLanes, s.count - from));
  }
  const std::uint64_t mask = s.mask();
  for (std::size_t i = begin; i < end; ++i) {
    const int y = cell.y() + ball_[i].y, z = cell.z() + ball_[i].z;
    if (y < within.low.y() || y >= within.high.y() || z < within.low.z() || z >= within.high.z()) {
      continue;
    }
    std::uint16_t* covers = &inflation_[RowAddress(y, z) + s.address];
    std::uint64_t covered = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk, covers += kLanes) {
      const Lanes counts = Load(covers) + adds[chunk];
      std::memcpy(covers, &counts, sizeof(counts));
      if (increment < 0) covered |= NotZero(counts) << (chunk * kLanes);
    }
    std::uint64_t& word = blocked_[RowIndex(y, z) * words_per_row_ + s.word];
    word |= mask;
    if (increment < 0) word &= ~mask | covered << s.shift;
  }
}

}  // namespace touchdown::planning
