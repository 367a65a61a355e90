// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace touchdown::planning {

/// Positions near a vehicle at rest from which the forward camera sees a cell better than from its own.
class Vantages {
 public:
  /// Of a vehicle at p_WB that does not see place_W, both in W [m]. It leans against `pull_W` [m/s^2], and the
  /// camera with it. Does not allocate.
  Vantages(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& place_W,
           const Eigen::Vector3d& pull_W) noexcept;

  /// From the vehicle [m], the best one first.
  const Eigen::Vector3d* begin() const { return shifts_.data(); }
  const Eigen::Vector3d* end() const { return shifts_.data() + size_; }
  std::size_t size() const { return size_; }

  static constexpr double kFarthest = 0.6;  ///< [m]

 private:
  std::array<Eigen::Vector3d, 30> shifts_;
  std::size_t size_ = 0;
};

/// How far a place is above or below the middle of the image of a level-mounted camera at p_WB that is turned to it
/// [rad]. The vehicle leans against `pull_W`.
double OffSight(const Eigen::Vector3d& place_W, const Eigen::Vector3d& p_WB,
                const Eigen::Vector3d& pull_W) noexcept;

}  // namespace touchdown::planning
