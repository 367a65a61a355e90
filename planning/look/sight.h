// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "touchdown/planning/look/scout.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::planning {

/// What a depth camera sees of a vehicle that hovers at a viewpoint.
class Sight {
 public:
  /// @param pull_W against which the vehicle leans [m/s^2].
  Sight(const LookCamera& camera, const Viewpoint& from, const Eigen::Vector3d& pull_W);

  /// The place is in the image, not too near and within reach, whatever is between.
  bool Holds(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p_C = R_CW_ * (p_W - p_WC_);
    const Eigen::Array2d across = p_C.head<2>().array();
    return p_C.z() >= kNearest && p_C.z() <= reach_ && (across > p_C.z() * low_).all() &&
           (across < p_C.z() * high_).all();
  }

  /// Nothing that is known to block is before the cell.
  bool Reaches(const CellIndex& cell, const OccupancyMap& map) const;

 private:
  static constexpr double kNearest = 0.25;  // [m]

  double reach_;
  Eigen::Array2d low_, high_;  // the image's edges, over the depth
  Eigen::Matrix3d R_CW_;
  Eigen::Vector3d p_WC_;
};

}  // namespace touchdown::planning
