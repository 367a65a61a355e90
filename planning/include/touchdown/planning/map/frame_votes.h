// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace touchdown::planning {

/// The votes of one depth frame on the cells of a window: passed by a ray, or hit by a return.
/// Coordinates are in cells, from the window's lowest corner: cell (x, y, z) is [x, x+1) x [y, y+1)
/// x [z, z+1). Allocates in the constructor only (the list of hits grows to its high-water mark).
class FrameVotes {
 public:
  static constexpr std::uint8_t kNone = 0;
  static constexpr std::uint8_t kMiss = 1;
  // Of returns, in the order in which one wins over the others in its cell:
  static constexpr std::uint8_t kPad = 2;    ///< from the pad
  static constexpr std::uint8_t kDoubt = 3;  ///< maybe from the pad
  static constexpr std::uint8_t kHit = 4;    ///< from an obstacle

  /// A window of 2^n cells a side, n <= 10.
  explicit FrameVotes(const Eigen::Vector3i& size_log2);

  /// Begins a frame of a camera at `p_WC` [m], which lies in the window.
  void Begin(const Eigen::Vector3d& p_WC);

  /// Votes miss for the cells within the window that the segment from the camera to `end` passes. The
  /// cell that holds `end` is left out: the ray sees only a part of it.
  void AddRay(const Eigen::Vector3d& end);

  /// Votes for the cell of a return, if it is in the window.
  void AddHit(const Eigen::Vector3d& at, std::uint8_t vote);

  /// Ends the frame: a return in a cell wins over what passed it.
  void Finish();

  /// Box [low, high) that holds every vote of the frame.
  const Eigen::Vector3i& low() const { return low_; }
  const Eigen::Vector3i& high() const { return high_; }

  /// Removes the returns' votes: calls visit(cell, vote) once for every cell in which one ended.
  template <class Visit>
  void TakeReturns(Visit&& visit) {
    for (const Hit& hit : hits_) {
      std::uint8_t& vote = votes_[Address(hit.cell)];
      if (vote != kNone) visit(hit.cell, std::exchange(vote, kNone));
    }
  }

  /// Removes the votes of at most 64 cells from `first` on along x, after the returns' votes. Bit
  /// i: miss.
  std::uint64_t TakeMisses(const Eigen::Vector3i& first, int count);

 private:
  /// A segment from the camera, clipped to the window.
  struct Ray {
    Eigen::Vector3d along;        ///< [cells]
    Eigen::Vector3d per_cell;     ///< ray parameter from one face to the next, on each axis
    Eigen::Vector3d first_cross;  ///< ray parameter of the first face on each axis
    Eigen::Vector3i last;         ///< end cell
    Eigen::Vector3i step;         ///< -1 or 1
    Eigen::Vector3i crossings;    ///< number of faces passed on each axis
  };
  /// A coordinate at successive faces of another axis, in fixed point. Shifted down by point_ it is
  /// the coordinate's share of the address, except for bits below that share.
  struct Track {
    std::int64_t at, by;
  };

  std::size_t Address(const Eigen::Vector3i& cell) const {
    return static_cast<std::size_t>(cell.x()) | static_cast<std::size_t>(cell.y()) << shift_[1] |
           static_cast<std::size_t>(cell.z()) << shift_[2];
  }
  /// The cell of a point in the window; rounding must not put it beyond.
  Eigen::Vector3i CellIn(const Eigen::Vector3d& p) const {
    return p.cast<int>().cwiseMax(0).cwiseMin(size_ - Eigen::Vector3i::Ones());
  }
  Track MakeTrack(const Ray& ray, int axis, int minor) const;
  template <int kAxis>
  void MissBehindFaces(const Ray& ray);

  Eigen::Vector3i size_;
  Eigen::Vector3i shift_;              // of a cell's coordinates in its address
  int point_;                          // of tracks
  double one_;                         // cell, in a track's units before they are shifted
  std::array<std::uint64_t, 3> bits_;  // of each coordinate in an address
  Eigen::Vector3d p_WC_ = Eigen::Vector3d::Zero();
  Eigen::Vector3i first_ = Eigen::Vector3i::Zero();  // the camera's cell
  Eigen::Vector3i low_ = Eigen::Vector3i::Zero();
  Eigen::Vector3i high_ = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> votes_;
  struct Hit {
    Eigen::Vector3i cell;
    std::uint8_t vote;
  };
  std::vector<Hit> hits_;
};

}  // namespace touchdown::planning
