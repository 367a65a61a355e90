// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/planning/map/cell_blocks.h"
#include "touchdown/planning/map/cell_box.h"
#include "touchdown/planning/map/frame_votes.h"
#include "touchdown/planning/map/pad_outline.h"

namespace touchdown::planning {

/// Largest distance between a chord of the whole-curve check and the curve [m]. The inflation is
/// larger by it, so that what is checked on chords holds on the curve.
inline constexpr double kChordSagitta = 0.002;

/// Parameters of the rolling grid. Probabilities as in EGO-Planner's map, except the threshold: a cell seen once
/// blocks, as in OctoMap.
struct OccupancyMapOptions {
  double resolution = 0.1;                ///< cell side [m]
  Eigen::Vector3i size_log2 = {8, 8, 6};  ///< window of 2^n cells a side: 25.6 x 25.6 x 6.4 m
  double inflation_radius = 0.40;         ///< obstacles are grown by this [m]
  double probability_hit = 0.65;
  double probability_miss = 0.35;
  double probability_min = 0.12;  ///< clamps
  double probability_max = 0.90;
  double probability_occupied = 0.60;  ///< a cell at least this likely blocks: one hit on an
                                       ///< unknown cell does
  double min_ray = 0.2;                ///< nearer returns are ignored [m]
  double thinnest_obstacle = 0.1;  ///< that is promised to be seen: a ray frees cells only where
                                   ///< neighbouring pixels are no farther apart [m]
  double range_noise = 0.0;        ///< 1 sigma of a return's range over the range
  double ground_height = 0.15;     ///< returns below are ground, not obstacles [m]
};

/// It lies below the ground's height as a whole: there are no obstacles.
inline bool IsGround(const CellIndex& cell, const OccupancyMapOptions& options) {
  return (cell.z() + 1) * options.resolution <= options.ground_height;
}

/// The state of a cell for a planner. kFree is observed free. All other cells that do not block are unknown to it.
enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Rolling log-odds occupancy grid with incremental inflation. The window follows the vehicle. Cells
/// that leave it are forgotten here, and handed to the listener that keeps them
/// (touchdown/planning/map/persistent_map.h).
///
/// Plans treat unknown cells as free. Stops must not (docs/safety.md): they stay in cells that were
/// observed free, which are fewer. A cell is observed free once a ray has passed it
/// - at a depth at which no obstacle of `thinnest_obstacle` fits between neighbouring pixels,
/// - short of the ray's return by kNoiseSigmas of its noise.
///
/// A hit ends that at once. A cell that was hit takes a miss only from nearer than the hit, or from so near that two
/// pixels fall on the thinnest obstacle. It needs as many misses as its log-odds demand. Cells read from memory are
/// not observed.
///
/// Returns that may be the pad's are kept apart (touchdown/planning/map/pad_outline.h): their cells are neither free
/// nor occupied until ExplainDoubts.
///
/// Allocates in the constructor only (the list of hits grows to its high-water mark).
class OccupancyMap {
 public:
  static constexpr double kLogOddsStep = 1.0 / 16.0;
  static constexpr double kNoiseSigmas = 3.0;  ///< of a return, in front of which nothing is freed

  /// Throws std::invalid_argument on a resolution, size, radius or probability out of range.
  explicit OccupancyMap(const OccupancyMapOptions& options);

  const OccupancyMapOptions& options() const { return options_; }
  double resolution() const { return options_.resolution; }

  /// Keeps the window's centre near p_W. It is centred along the axis on which p_W is farthest off, once that is four
  /// cells. It is centred along all axes once p_W is 16 cells off on any, or an eighth of the window. Cells that
  /// enter are unknown. Cells that leave are forgotten. Those that have changed since they entered or were last taken
  /// are first put in `memory`.
  void Recentre(const Eigen::Vector3d& p_W, CellBlocks* memory = nullptr);

  /// Moves the window so that `origin` is its lowest cell.
  void MoveWindow(const CellIndex& origin, CellBlocks* memory = nullptr);

  /// Sets one cell as a planner sees it. Out of the window: ignored.
  void SetState(const CellIndex& cell, CellState state);

  /// What entered in the last Recentre or MoveWindow: disjoint boxes, at most three.
  const std::vector<CellBox>& entered() const { return entered_; }

  /// Gives a cell its remembered value, which does not count as a change. The log-odds are clamped to this map's
  /// limits. Ignored out of the window, and for an obstacle that lies below ground_height as a whole: that is ground.
  void Restore(const CellValue& value);

  /// Appends every cell of the window that changed since it entered or was last taken.
  void TakeChanges(std::vector<CellValue>* changes);

  /// Fuses one depth frame. Every cell is updated at most once: as hit if a return ends in it, else as miss if a ray
  /// frees it. A return from the ground hits nothing. `pad` is where the pad was when the frame was taken. A return
  /// from it makes its cell unknown, one that may be from it makes it doubtful. A frame is ignored if its camera is
  /// out of the window or impossible (estimation::IsPossible).
  /// @throws std::invalid_argument if the frame has not width x height depths.
  void Integrate(const estimation::DepthFrame& frame, const PadOutline& pad);

  /// Settles the doubtful cells, now that the pad is known: `outline_at(t)` [s] gives a PadOutline. If the outline
  /// explains every return of a cell at its time, the cell becomes unknown, otherwise occupied.
  template <class OutlineAt>
  void ExplainDoubts(OutlineAt&& outline_at);

  /// Sets one cell to surely occupied, as prior knowledge or in tests. Out of the window: ignored. Throws
  /// std::invalid_argument where p_W is not finite.
  void SetOccupied(const Eigen::Vector3d& p_W);

  /// Marks the cells within `radius` of p_W that are not occupied as observed free: those around the start, or known
  /// otherwise. Throws std::invalid_argument unless p_W is finite and radius in [0, 1e4] m.
  void MarkFree(const Eigen::Vector3d& p_W, double radius);

  /// Marks every cell of the window that is not occupied as observed free: the whole map is known
  /// beforehand.
  void MarkRestFree();

  /// A place so near that its cell has an index. Farther off, or not finite, it is in no window.
  bool HasIndex(const Eigen::Vector3d& p_W) const {
    constexpr double kMostCells = 1e9;  // that an index counts
    return (p_W.array().abs() < kMostCells * options_.resolution).all();
  }
  /// @pre HasIndex(p_W).
  CellIndex CellOf(const Eigen::Vector3d& p_W) const {
    return (p_W / options_.resolution).array().floor().matrix().cast<int>();
  }
  Eigen::Vector3d CentreOf(const CellIndex& cell) const {
    return (cell.cast<double>().array() + 0.5).matrix() * options_.resolution;
  }
  bool InWindow(const CellIndex& cell) const {
    return ((cell - origin_).array() >= 0).all() && ((cell - origin_ - size_).array() < 0).all();
  }

  /// Blocked after inflation. Out of the window: free (unknown).
  bool IsBlocked(const CellIndex& cell) const { return InWindow(cell) && BlockedRow(cell, 1) != 0; }
  /// A place with a number that is not finite is blocked.
  bool IsBlocked(const Eigen::Vector3d& p_W) const {
    return HasIndex(p_W) ? IsBlocked(CellOf(p_W)) : !p_W.allFinite();
  }
  /// Bit i: the cell i beyond `first` along x is blocked. `count` (at most 64) cells, all in the window.
  std::uint64_t BlockedRow(const CellIndex& first, int count) const {
    return Row(blocked_, first, count);
  }
  /// The same of the cells that were observed free.
  std::uint64_t ObservedFreeRow(const CellIndex& first, int count) const {
    return Row(free_, first, count);
  }
  /// The same of the cells that are occupied themselves, without inflation.
  std::uint64_t OccupiedRow(const CellIndex& first, int count) const {
    return Row(obstacles_, first, count);
  }
  bool IsOccupied(const CellIndex& cell) const {
    return InWindow(cell) && OccupiedRow(cell, 1) != 0;
  }
  /// Observed at least once, free or occupied or doubtful.
  bool IsKnown(const CellIndex& cell) const { return InWindow(cell) && Row(known_, cell, 1) != 0; }
  /// See above. Out of the window: no.
  bool IsObservedFree(const CellIndex& cell) const {
    return InWindow(cell) && ObservedFreeRow(cell, 1) != 0;
  }
  /// Hit by returns that may be the pad's.
  bool IsDoubtful(const CellIndex& cell) const {
    return InWindow(cell) && cells_[Address(cell)].doubtful;
  }
  /// Cells of the window that were observed free.
  std::int64_t CountObservedFree() const;

  /// States of the window's cells, x fastest, from origin() on. Allocates if `states` is too small.
  void CopyStates(std::vector<CellState>* states) const;

  /// Lowest cell of the window and its extent [cells].
  const CellIndex& origin() const { return origin_; }
  const CellIndex& size() const { return size_; }

 private:
  using Bits = std::vector<std::uint64_t>;
  static constexpr int kWord = 64;  // cells
  // Between levels of cells. Without it the cells above each other compete for the same lines of the cache.
  static constexpr std::size_t kLevelPadding = 96;
  static constexpr std::int8_t kUnknown = kUnknownLogOdds;

  struct Cell {
    std::int8_t log_odds = kUnknown;    // in steps of kLogOddsStep
    std::uint8_t hit_range : 6 = 0;     // nearest that it was hit from, in steps of kRangeStep
    std::uint8_t doubtful : 1 = false;  // hit by what may be the pad
    std::uint8_t changed : 1 = false;   // since it entered the window or was last taken
  };
  static constexpr double kRangeStep = 0.2;  // [m]
  static constexpr int kFarthest = 63;       // steps
  /// A return that may be the pad's.
  struct Doubt {
    double t;
    CellIndex cell;
    double tolerance;  ///< of the return [m]
  };
  static constexpr std::size_t kMostDoubts = 1 << 14;
  /// Offsets (-half..half, y, z) from an obstacle's cell.
  struct BallRow {
    int half;
    int y, z;
  };

  std::size_t RowIndex(int y, int z) const {
    return (static_cast<std::size_t>(z & mask_.z()) << options_.size_log2.y()) |
           static_cast<std::size_t>(y & mask_.y());
  }
  std::size_t RowAddress(int y, int z) const {
    return (RowIndex(y, z) << options_.size_log2.x()) +
           kLevelPadding * static_cast<std::size_t>(z & mask_.z());
  }
  std::size_t Address(const CellIndex& cell) const {
    return RowAddress(cell.y(), cell.z()) + static_cast<std::size_t>(cell.x() & mask_.x());
  }
  std::uint64_t Row(const Bits& bits_of, const CellIndex& first, int count) const {
    const std::uint64_t* row = &bits_of[RowIndex(first.y(), first.z()) * words_per_row_];
    const int x = first.x() & mask_.x();
    const int bit = x % kWord;
    const int per_word = std::min(kWord, size_.x());
    const auto word = static_cast<std::size_t>(x / kWord);
    std::uint64_t bits = row[word] >> bit;
    if (bit + count > per_word) {  // the row goes on, or wraps around
      bits |= row[(word + 1) & (words_per_row_ - 1)] << (per_word - bit);
    }
    return bits & ~std::uint64_t{0} >> (kWord - count);
  }
  /// Cells along x that are neighbours in memory and have their bits in one word.
  struct Stretch {
    CellIndex first;
    int count;
    std::size_t address;  ///< of the first
    std::size_t word;
    int shift;  ///< of the first one's bit in it
    std::uint64_t mask() const { return ~std::uint64_t{0} >> (int{kWord} - count) << shift; }
  };
  template <class Visit>
  void ForEachStretch(int x_begin, int x_end, int y, int z, Visit&& visit) const;
  template <class Visit>
  void ForEachStretch(const CellBox& box, Visit&& visit) const;
  template <class Visit>
  void ForEachSet(const Bits& bits, const CellBox& box, Visit&& visit) const;
  void SetBit(const CellIndex& cell, bool on, Bits* bits) const;

  CellBox window() const { return {origin_, origin_ + size_}; }
  bool Blocks(const Cell& cell) const { return cell.log_odds >= occupied_ && !cell.doubtful; }
  int RangeOf(const CellIndex& cell, const Eigen::Vector3d& p_WC) const;
  /// Error of a return from `range`: the map's, and the camera's [m].
  double ToleranceAt(double range) const {
    return options_.resolution + kNoiseSigmas * options_.range_noise * range;
  }
  void ApplyReturn(std::uint8_t vote, const CellIndex& cell, const Eigen::Vector3d& p_WC, double t);
  void ApplyMisses(const Eigen::Vector3d& p_WC);
  void ApplyMissToHit(const CellIndex& cell, const Eigen::Vector3d& p_WC);
  void MakeCertain(const CellIndex& cell, bool explained);
  void Forget(const CellIndex& cell, const CellBox& stays, CellBlocks* memory);
  void Set(const CellIndex& cell, Cell value);
  void Inflate(const CellIndex& cell, int increment, const CellBox& within);
  void AddToRows(const CellIndex& cell, std::size_t begin, std::size_t end, const Stretch& s,
                 int increment, const CellBox& within);

  OccupancyMapOptions options_;
  CellIndex origin_ = CellIndex::Zero();
  CellIndex size_;
  CellIndex mask_;
  std::int8_t miss_, min_, max_, occupied_;  // log-odds in steps of kLogOddsStep
  // Log-odds after a miss and after a hit: unknown and the clamps are settled here once.
  std::array<std::int8_t, 256> after_miss_, after_hit_;
  std::vector<BallRow> ball_;  // cells that one obstacle cell blocks, by half
  int ball_reach_ = 0;         // its largest extent along an axis
  std::vector<Cell> cells_;
  std::vector<std::uint16_t> inflation_;  // number of obstacle cells whose ball holds it
  // Bit by bit along x, so that what has nothing to tell is passed a word at a time:
  Bits blocked_;    // that number is not zero
  Bits free_;       // observed free
  Bits known_;      // log-odds that are not kUnknown
  Bits obstacles_;  // Blocks
  Bits settled_;    // observed free so often that a miss changes nothing
  std::size_t words_per_row_ = 0;
  double sharp_ =
      0.0;  // of the frame at hand: up to here two pixels fall on the thinnest obstacle [m]
  FrameVotes votes_;
  std::vector<Doubt> doubts_;
  std::vector<CellBox> entered_;
  std::vector<CellBox> slabs_;  // of the Recentre at hand
};

/// The stretches that the cells [x_begin, x_end) of a row make.
template <class Visit>
void OccupancyMap::ForEachStretch(int x_begin, int x_end, int y, int z, Visit&& visit) const {
  const std::size_t row = RowIndex(y, z);
  for (int x = x_begin; x < x_end;) {
    const int from = x & mask_.x();
    const int room = std::min(kWord - from % kWord, size_.x() - from);
    const int count = std::min(room, x_end - x);
    visit(Stretch{{x, y, z},
                  count,
                  RowAddress(y, z) + static_cast<std::size_t>(from),
                  row * words_per_row_ + static_cast<std::size_t>(from / kWord),
                  from % kWord});
    x += count;
  }
}

template <class Visit>
void OccupancyMap::ForEachStretch(const CellBox& box, Visit&& visit) const {
  for (int z = box.low.z(); z < box.high.z(); ++z) {
    for (int y = box.low.y(); y < box.high.y(); ++y) {
      ForEachStretch(box.low.x(), box.high.x(), y, z, visit);
    }
  }
}

/// Calls visit(cell) for the box's cells whose bit is set.
template <class Visit>
void OccupancyMap::ForEachSet(const Bits& bits, const CellBox& box, Visit&& visit) const {
  ForEachStretch(box, [&](const Stretch& s) {
    for (std::uint64_t left = (bits[s.word] & s.mask()) >> s.shift; left != 0; left &= left - 1) {
      visit(CellIndex(s.first.x() + std::countr_zero(left), s.first.y(), s.first.z()));
    }
  });
}

template <class OutlineAt>
void OccupancyMap::ExplainDoubts(OutlineAt&& outline_at) {
  // One return that the pad does not explain makes an obstacle, whatever else was in the cell.
  for (const bool explained : {false, true}) {
    for (const Doubt& doubt : doubts_) {
      if (!IsDoubtful(doubt.cell)) continue;
      const ReturnKind kind = outline_at(doubt.t).Classify(CentreOf(doubt.cell), doubt.tolerance);
      if ((kind != ReturnKind::kObstacle) == explained) MakeCertain(doubt.cell, explained);
    }
  }
  doubts_.clear();
}

}  // namespace touchdown::planning
