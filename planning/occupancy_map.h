// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/measurements.h"
#include "touchdown/planning/cell_box.h"
#include "touchdown/planning/frame_votes.h"
#include "touchdown/planning/pad_outline.h"

namespace touchdown::planning {

/// Largest distance between a chord of the whole-curve check and the curve [m]. The inflation is
/// larger by it, so that what is checked on chords holds on the curve.
inline constexpr double kChordSagitta = 0.002;

/// Parameters of the rolling grid. Probabilities as in EGO-Planner's map, but for the threshold: what
/// was seen once blocks, as in OctoMap.
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

/// What a planner can tell of a cell: kFree is observed free. All else that does not block is unknown to it.
enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// A cell that became blocked or free, before inflation.
struct CellFlip {
  CellIndex cell;
  bool occupied;
};

/// What was observed of a cell.
struct CellValue {
  CellIndex cell;
  std::int8_t log_odds;  ///< in steps of OccupancyMap::kLogOddsStep
};

/// Rolling log-odds occupancy grid with incremental inflation. The window follows the vehicle; what
/// leaves it is forgotten here, and handed to whoever keeps it (planning/persistent_map.h).
///
/// Plans take unknown cells for free. Stops may not (docs/safety.md): they stay in cells that were
/// observed free, which is less. A cell is observed free once a ray has passed it
///  - at a depth at which no obstacle of `thinnest_obstacle` fits between neighbouring pixels,
///  - short of the ray's return by kNoiseSigmas of its noise;
/// a hit ends that at once. A cell that was hit takes a miss only from nearer than it was hit from, or from
/// so near that two pixels fall on the thinnest obstacle, and needs as many as its log-odds ask for. What was read from memory is not observed.
///
/// Returns that may be the pad's are kept apart (planning/pad_outline.h): their cells are neither free
/// nor occupied until ExplainDoubts.
///
/// Allocates in the constructor only (the lists of flips, hits, doubts and cells that left grow to their
/// high-water mark).
class OccupancyMap {
 public:
  static constexpr double kLogOddsStep = 1.0 / 16.0;
  static constexpr double kNoiseSigmas = 3.0;  ///< of a return, in front of which nothing is freed

  /// Throws std::invalid_argument on a resolution, size, radius or probability out of range.
  explicit OccupancyMap(const OccupancyMapOptions& options);

  const OccupancyMapOptions& options() const { return options_; }
  double resolution() const { return options_.resolution; }

  /// Moves the window so that it is centred at p_W, once p_W is a sixteenth of the window's size
  /// off its centre; cells that enter are unknown, cells that leave are forgotten.
  void Recentre(const Eigen::Vector3d& p_W);

  /// Moves the window so that `origin` is its lowest cell.
  void MoveWindow(const CellIndex& origin);

  /// Sets one cell as a planner sees it. Out of the window: ignored.
  void SetState(const CellIndex& cell, CellState state);

  /// Cells that left in the last Recentre or MoveWindow and had changed since they entered or were last taken.
  const std::vector<CellValue>& left() const { return left_; }
  /// What entered in it: disjoint boxes, at most three.
  const std::vector<CellBox>& entered() const { return entered_; }

  /// Gives a cell what is remembered of it; that is no change. The log-odds are clamped to this map's
  /// limits. Ignored out of the window, and for an obstacle that lies below ground_height as a whole:
  /// that is ground. Adds to flips().
  void Restore(const CellValue& value);

  /// Appends every cell of the window that changed since it entered or was last taken.
  void TakeChanges(std::vector<CellValue>* changes);

  /// Fuses one depth frame. Every cell is updated at most once: as hit if a return ends in it, else
  /// as miss if a ray frees it. A return from the ground hits nothing; one from `pad`, which is where the
  /// pad was when the frame was taken, makes its cell unknown, one that may be from it makes it
  /// doubtful. A camera out of the window or at a pose that is not finite says nothing.
  /// @throws std::invalid_argument if the frame has not width x height depths.
  void Integrate(const estimation::DepthFrame& frame, const PadOutline& pad);

  /// Settles what was doubtful, now that the pad is known: `outline_at(t)` [s] gives a PadOutline. Doubtful
  /// cells whose every return it explains at its time become unknown, the others occupied.
  template <class OutlineAt>
  void ExplainDoubts(OutlineAt&& outline_at);

  /// Sets one cell to surely occupied, as prior knowledge or in tests. Out of the window: ignored.
  void SetOccupied(const Eigen::Vector3d& p_W);

  /// Marks the cells within `radius` of p_W that are not occupied as observed free: what is given around
  /// the start, or known otherwise.
  void MarkFree(const Eigen::Vector3d& p_W, double radius);

  /// Takes every cell of the window that is not occupied as observed free: all of the map is known
  /// beforehand.
  void MarkRestFree();

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
  bool IsBlocked(const CellIndex& cell) const {
    if (!InWindow(cell)) return false;
    const auto x = static_cast<std::size_t>(cell.x() & mask_.x());
    const std::size_t row = RowIndex(cell.y(), cell.z()) * words_per_row_;
    return (blocked_[row + x / kWord] >> (x % kWord) & 1u) != 0;
  }
  bool IsBlocked(const Eigen::Vector3d& p_W) const { return IsBlocked(CellOf(p_W)); }
  /// Bit i: the cell i beyond `first` along x is blocked. `count` (at most 64) cells, all in the window.
  std::uint64_t BlockedRow(const CellIndex& first, int count) const {
    return Row(blocked_, first, count);
  }
  /// The same of the cells that were observed free.
  std::uint64_t ObservedFreeRow(const CellIndex& first, int count) const {
    return Row(free_, first, count);
  }
  /// Occupied itself, without inflation.
  bool IsOccupied(const CellIndex& cell) const;
  /// Observed at least once, free or occupied or doubtful.
  bool IsKnown(const CellIndex& cell) const;
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

  /// Cells that became blocked or free in the last Integrate, SetOccupied, Clear or Recentre, and the
  /// Restores since.
  const std::vector<CellFlip>& flips() const { return flips_; }

 private:
  static constexpr std::size_t kWord = 64;  // cells
  // Never observed. Outside the clamps, so that no update can reach it.
  static constexpr std::int8_t kUnknown = -128;

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
  /// Offsets (-half..half, y, z) from an obstacle's cell.
  struct BallRow {
    int half;
    int y, z;
  };

  std::size_t RowIndex(int y, int z) const {
    return (static_cast<std::size_t>(z & mask_.z()) << options_.size_log2.y()) |
           static_cast<std::size_t>(y & mask_.y());
  }
  std::size_t RowAddress(int y, int z) const { return RowIndex(y, z) << options_.size_log2.x(); }
  std::size_t Address(const CellIndex& cell) const {
    return RowAddress(cell.y(), cell.z()) | static_cast<std::size_t>(cell.x() & mask_.x());
  }
  std::uint64_t Row(const std::vector<std::uint64_t>& grid, const CellIndex& first,
                    int count) const {
    const std::uint64_t* row = &grid[RowIndex(first.y(), first.z()) * words_per_row_];
    const auto x = static_cast<std::size_t>(first.x() & mask_.x());
    const std::size_t bit = x % kWord;
    const std::size_t per_word = std::min(kWord, static_cast<std::size_t>(size_.x()));
    std::uint64_t bits = row[x / kWord] >> bit;
    if (bit + static_cast<std::size_t>(count) > per_word) {  // the row goes on, or wraps around
      bits |= row[(x / kWord + 1) & (words_per_row_ - 1)] << (per_word - bit);
    }
    return bits & ~std::uint64_t{0} >> (static_cast<int>(kWord) - count);
  }
  bool Blocks(const Cell& cell) const { return cell.log_odds >= occupied_ && !cell.doubtful; }
  void SetObservedFree(const CellIndex& cell, bool free);
  int RangeOf(const CellIndex& cell, const Eigen::Vector3d& eye) const;
  /// Error of a return from `range`: the map's, and the camera's [m].
  double ToleranceAt(double range) const {
    return options_.resolution + kNoiseSigmas * options_.range_noise * range;
  }
  void ApplyVotes(const Eigen::Vector3d& eye, double t);
  void Apply(std::uint8_t vote, const CellIndex& cell, const Eigen::Vector3d& eye, double t);
  void MakeCertain(const CellIndex& cell, bool explained);
  template <class Visit>
  void ForEachAddress(const CellBox& box, Visit&& visit) const;
  void Forget(const CellIndex& cell, Cell* stored);
  void CountInflation(const CellIndex& cell, const CellBox& but_for);
  void Set(const CellIndex& cell, Cell value);
  void Inflate(const CellIndex& cell, int increment);
  void AddToRow(int y, int z, int x_begin, int x_end, int increment);
  void ClearRow(int y, int z, int x_begin, int x_end);
  template <class Visit>
  void ForEachStretch(int x_begin, int x_end, Visit&& visit) const;
  void StoreBits(std::size_t row, int from, int count, std::uint64_t bits);

  OccupancyMapOptions options_;
  CellIndex origin_ = CellIndex::Zero();
  CellIndex size_;
  CellIndex mask_;
  std::int8_t miss_, min_, max_, occupied_;  // log-odds in steps of kLogOddsStep
  // What log-odds become by a miss and by a hit: unknown and the clamps are settled here once.
  std::array<std::int8_t, 256> after_miss_, after_hit_;
  std::vector<BallRow> ball_;  // cells that one obstacle cell blocks
  int ball_reach_ = 0;         // its largest extent along an axis
  std::vector<Cell> cells_;
  std::vector<std::uint16_t> inflation_;  // number of obstacle cells whose ball holds it
  std::vector<std::uint64_t> blocked_;    // bit by bit along x: that number is not zero
  std::vector<std::uint64_t> free_;       // bit by bit along x: observed free
  std::size_t words_per_row_ = 0;
  double sharp_ =
      0.0;  // of the frame at hand: up to here two pixels fall on the thinnest obstacle [m]
  FrameVotes votes_;
  std::vector<Doubt> doubts_;
  std::vector<CellFlip> flips_;
  std::vector<CellValue> left_;
  std::vector<CellBox> entered_;
  std::vector<CellBox> slabs_;  // of the Recentre at hand
};

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
