// SPDX-License-Identifier: BSD-3-Clause
// A rolling window of log-odds cells, addressed modulo its power-of-two size so that moving it
// copies nothing. Log-odds are kept in steps of 1/16 in one byte. Inflation is incremental: every
// cell holds the number of occupied cells whose ball covers it, so that one flip costs one ball and
// a query one load. Fusion as in A. Hornung et al., "OctoMap", Autonomous Robots 2013, section 3:
// rays clear, end points hit, one update per cell and frame in which hits win.

#include "touchdown/planning/occupancy_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "touchdown/planning/voxel_traversal.h"

namespace touchdown::planning {

namespace {

constexpr double kStepsPerLogOdds = 16.0;
// Never observed. Outside the clamps, so that no update can reach it.
constexpr std::int8_t kUnknown = -128;

std::int8_t Quantise(double probability) {
  return static_cast<std::int8_t>(
      std::lround(kStepsPerLogOdds * std::log(probability / (1.0 - probability))));
}

void Require(bool ok, const std::string& sentence) {
  if (!ok) throw std::invalid_argument("OccupancyMap: " + sentence);
}

}  // namespace

OccupancyMap::OccupancyMap(const OccupancyMapOptions& options) : options_(options) {
  const auto number = [](double x) { return std::to_string(x); };
  Require(options.resolution > 0.0 && options.resolution <= 1.0,
          "resolution is " + number(options.resolution) + " m, it must be in (0, 1]");
  Require((options.size_log2.array() >= 4).all() && (options.size_log2.array() <= 10).all(),
          "size_log2 must be in [4, 10] on every axis");
  Require(options.inflation_radius >= 0.0 && options.inflation_radius <= 10 * options.resolution,
          "inflation_radius is " + number(options.inflation_radius) + " m, it must be in [0, " +
              number(10 * options.resolution) + "]");
  Require(options.probability_min > 0.0 && options.probability_min < options.probability_miss &&
              options.probability_miss < 0.5 && options.probability_hit > 0.5 &&
              options.probability_hit < options.probability_max && options.probability_max < 1.0,
          "probabilities must satisfy 0 < min < miss < 0.5 < hit < max < 1");
  hit_ = Quantise(options.probability_hit);
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
  log_odds_.assign(cells, kUnknown);
  inflation_.assign(cells, 0);
  stamp_.assign(cells, 0);

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
  touched_.reserve(1 << 17);
  flips_.reserve(1 << 14);
  origin_ = -size_ / 2;
}

bool OccupancyMap::IsOccupied(const CellIndex& cell) const {
  return InWindow(cell) && log_odds_[Address(cell)] >= occupied_;
}

bool OccupancyMap::IsKnown(const CellIndex& cell) const {
  return InWindow(cell) && log_odds_[Address(cell)] != kUnknown;
}

namespace {

/// Calls visit(cell) for every cell in [lo, hi).
template <class Visit>
void ForEachCell(const CellIndex& lo, const CellIndex& hi, Visit&& visit) {
  CellIndex cell;
  for (cell.z() = lo.z(); cell.z() < hi.z(); ++cell.z()) {
    for (cell.y() = lo.y(); cell.y() < hi.y(); ++cell.y()) {
      for (cell.x() = lo.x(); cell.x() < hi.x(); ++cell.x()) visit(cell);
    }
  }
}

/// The window's share of the slab of `thickness` cells at its upper (positive) or lower end.
void Slab(const CellIndex& origin, const CellIndex& size, int axis, bool upper, int thickness,
          CellIndex* lo, CellIndex* hi) {
  *lo = origin;
  *hi = origin + size;
  if (upper) (*lo)[axis] = (*hi)[axis] - thickness;
  if (!upper) (*hi)[axis] = (*lo)[axis] + thickness;
}

}  // namespace

void OccupancyMap::Recentre(const Eigen::Vector3d& p_W) {
  flips_.clear();
  const CellIndex target = CellOf(p_W) - size_ / 2;
  // A shift costs whole slabs of cells, so the window waits until there is one to move.
  const CellIndex slack = size_ / 16;
  const CellIndex offset = (target - origin_).cwiseAbs();
  if (((offset - slack).array() >= 0).any()) MoveWindow(target);
}

void OccupancyMap::MoveWindow(const CellIndex& target) {
  flips_.clear();
  const CellIndex old_origin = origin_;
  const CellIndex shift = target - old_origin;
  const CellIndex moved = shift.cwiseAbs().cwiseMin(size_);
  CellIndex lo, hi;

  // Forget what leaves while its ball can still be taken back.
  for (int axis = 0; axis < 3; ++axis) {
    Slab(old_origin, size_, axis, shift[axis] < 0, moved[axis], &lo, &hi);
    ForEachCell(lo, hi, [&](const CellIndex& cell) {
      if (log_odds_[Address(cell)] != kUnknown) SetLogOdds(cell, kUnknown);
    });
  }
  // What enters takes over addresses of what left; its inflation is counted anew from the obstacles
  // that stay within a ball's reach of it.
  origin_ = target;
  const CellIndex old_end = old_origin + size_;
  for (int axis = 0; axis < 3; ++axis) {
    Slab(origin_, size_, axis, shift[axis] > 0, moved[axis], &lo, &hi);
    ForEachCell(lo, hi, [&](const CellIndex& cell) { inflation_[Address(cell)] = 0; });
  }
  CellIndex band_lo[3], band_hi[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int reach = moved[axis] == 0 ? 0 : std::min(moved[axis] + ball_reach_, size_[axis]);
    Slab(origin_, size_, axis, shift[axis] > 0, reach, &band_lo[axis], &band_hi[axis]);
    ForEachCell(band_lo[axis], band_hi[axis], [&](const CellIndex& cell) {
      if (log_odds_[Address(cell)] < occupied_) return;
      for (int earlier = 0; earlier < axis; ++earlier) {
        const bool counted = ((cell - band_lo[earlier]).array() >= 0).all() &&
                             ((cell - band_hi[earlier]).array() < 0).all();
        if (counted) return;
      }
      for (const BallRow& row : ball_) {
        const int y = cell.y() + row.y, z = cell.z() + row.z;
        const int begin = cell.x() - row.half, end = cell.x() + row.half + 1;
        const bool new_row =
            y < old_origin.y() || y >= old_end.y() || z < old_origin.z() || z >= old_end.z();
        AddToRow(y, z, begin, new_row ? end : std::min(end, old_origin.x()), 1);
        if (!new_row) AddToRow(y, z, std::max(begin, old_end.x()), end, 1);
      }
    });
  }
}

bool OccupancyMap::IsObservedFree(const CellIndex& cell) const {
  if (!InWindow(cell)) return false;
  const std::int8_t log_odds = log_odds_[Address(cell)];
  return log_odds != kUnknown && log_odds < 0;
}

void OccupancyMap::Integrate(const estimation::DepthFrame& frame, const ExcludedVolume& excluded) {
  flips_.clear();
  touched_.clear();
  frame_ += 2;  // the lowest bit of a stamp says "hit"
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const double depth = frame.depth[static_cast<std::size_t>(v * k.width + u)];
      Eigen::Vector3d ray_C((u + 0.5 - k.cx) / k.focal, (v + 0.5 - k.cy) / k.focal, 1.0);
      const double per_depth = ray_C.norm();
      const bool returned = std::isfinite(depth);
      if (std::isnan(depth)) continue;  // an invalid pixel says nothing
      const double range = returned ? depth * per_depth : frame.max_range;
      if (range < options_.min_ray) continue;
      const Eigen::Vector3d end = frame.p_WC + frame.R_WC * (ray_C * (range / per_depth));
      MarkRay(frame.p_WC, end, returned, excluded);
    }
  }
  for (const CellIndex& cell : touched_) {
    const std::size_t address = Address(cell);
    const bool hit = (stamp_[address] & 1u) != 0u;
    const int old = log_odds_[address] == kUnknown ? 0 : log_odds_[address];
    const int updated = std::clamp<int>(old + (hit ? hit_ : miss_), min_, max_);
    SetLogOdds(cell, static_cast<std::int8_t>(updated));
  }
}

void OccupancyMap::MarkRay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool hit,
                           const ExcludedVolume& excluded) {
  const bool pad = excluded.radius > 0.0 && to.z() < excluded.top &&
                   (to.head<2>() - excluded.centre).norm() < excluded.radius;
  const bool counts = hit && to.z() > options_.ground_height && !pad;
  const CellIndex last = CellOf(to);
  TraverseCells(from, to, options_.resolution, [&](const CellIndex& cell) {
    if (!InWindow(cell)) return false;
    const bool end = cell == last;
    // The end cell of a return that does not count is neither free nor occupied.
    if (!end) Vote(cell, false);
    if (end && counts) Vote(cell, true);
    if (end && !hit) Vote(cell, false);
    return true;
  });
}

void OccupancyMap::Vote(const CellIndex& cell, bool hit) {
  std::uint32_t& stamp = stamp_[Address(cell)];
  if ((stamp & ~1u) != frame_) {
    stamp = frame_;
    touched_.push_back(cell);
  }
  if (hit) stamp |= 1u;
}

void OccupancyMap::SetOccupied(const Eigen::Vector3d& p_W) {
  flips_.clear();
  const CellIndex cell = CellOf(p_W);
  if (InWindow(cell)) SetLogOdds(cell, max_);
}

void OccupancyMap::SetState(const CellIndex& cell, CellState state) {
  flips_.clear();
  if (!InWindow(cell)) return;
  const bool known = state != CellState::kUnknown;
  SetLogOdds(cell, !known ? kUnknown : state == CellState::kOccupied ? max_ : min_);
}

void OccupancyMap::CopyStates(std::vector<CellState>* states) const {
  states->resize(log_odds_.size());
  CellState* out = states->data();
  const auto copy = [&](const std::int8_t* from, const std::int8_t* to) {
    for (; from != to; ++from, ++out) {
      const CellState free =
          *from < 0 && *from != kUnknown ? CellState::kFree : CellState::kUnknown;
      *out = *from >= occupied_ ? CellState::kOccupied : free;
    }
  };
  // Addresses wrap around once in a row.
  const int wrap = origin_.x() & mask_.x();
  for (int z = origin_.z(); z < origin_.z() + size_.z(); ++z) {
    for (int y = origin_.y(); y < origin_.y() + size_.y(); ++y) {
      const std::int8_t* row = &log_odds_[RowAddress(y, z)];
      copy(row + wrap, row + size_.x());
      copy(row, row + wrap);
    }
  }
}

void OccupancyMap::MarkOwnVolume(const Eigen::Vector3d& p_W, double radius) {
  const CellIndex lo = CellOf(p_W.array() - radius);
  const CellIndex hi = CellOf(p_W.array() + radius) + CellIndex::Ones();
  ForEachCell(lo, hi, [&](const CellIndex& cell) {
    if (!InWindow(cell) || (CentreOf(cell) - p_W).norm() > radius) return;
    std::int8_t& stored = log_odds_[Address(cell)];
    // A stray hit that does not block yet is outweighed by being here.
    if (stored == kUnknown || (stored >= 0 && stored < occupied_)) stored = miss_;
  });
}

void OccupancyMap::MarkRestFree() {
  flips_.clear();
  for (std::int8_t& stored : log_odds_) {
    if (stored < occupied_) stored = min_;
  }
}

void OccupancyMap::Clear(const ExcludedVolume& excluded) {
  flips_.clear();
  if (!(excluded.radius > 0.0)) return;
  const double r = excluded.radius;
  const CellIndex lo = CellOf({excluded.centre.x() - r, excluded.centre.y() - r, 0.0});
  const CellIndex hi = CellOf({excluded.centre.x() + r, excluded.centre.y() + r, excluded.top});
  ForEachCell(lo, hi + CellIndex::Ones(), [&](const CellIndex& cell) {
    const bool inside = (CentreOf(cell).head<2>() - excluded.centre).norm() < r;
    const bool hit = InWindow(cell) && log_odds_[Address(cell)] >= 0;
    if (inside && hit) SetLogOdds(cell, min_);
  });
}

void OccupancyMap::SetLogOdds(const CellIndex& cell, std::int8_t value) {
  std::int8_t& stored = log_odds_[Address(cell)];
  const bool was = stored >= occupied_;
  const bool is = value >= occupied_;
  stored = value;
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

// Cells [x_begin, x_end) of a row, as far as they are in the window.
void OccupancyMap::AddToRow(int y, int z, int x_begin, int x_end, int increment) {
  const CellIndex end = origin_ + size_;
  if (y < origin_.y() || y >= end.y() || z < origin_.z() || z >= end.z()) return;
  x_begin = std::max(x_begin, origin_.x());
  x_end = std::min(x_end, end.x());
  std::uint16_t* row = &inflation_[RowAddress(y, z)];
  const auto add = [&](int from, int to) {
    for (int x = from; x < to; ++x) row[x] = static_cast<std::uint16_t>(row[x] + increment);
  };
  // Addresses wrap around once in the window, at a multiple of its size.
  const int from = x_begin & mask_.x();
  const int to = from + (x_end - x_begin);
  add(from, std::min(to, size_.x()));
  add(0, to - size_.x());
}

}  // namespace touchdown::planning
