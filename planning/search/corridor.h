// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

/// Half-spaces between a free point and the blocked cells around it. Each {p, v} pair takes the
/// nearest blocked cell that no earlier pair keeps off. Its plane touches the cell where it is
/// nearest to the point, across the line to it. Together they hold a convex piece of free space
/// around the point.
class Corridor {
 public:
  static constexpr double kReach = 0.6;  ///< cells farther from the point do not count [m]

  /// Plans keep only `margin` [m] from the floor and the ceiling: the pairs' planes lie `clearance`
  /// - `margin` beyond them. Allocates its scratch memory.
  Corridor(double clearance, double margin);

  /// Appends the pairs of one control point, at most `most` of them, the nearest first. A `point` in
  /// a blocked cell is moved to the nearest free one first; none near: no pairs. Does not allocate if
  /// `pairs` has room.
  void Bind(int control_point, const Eigen::Vector3d& point, const FreeSpace& space,
            std::size_t most, std::vector<ObstaclePair>* pairs);

 private:
  struct Near {
    Eigen::Vector3d p;  // of the cell, nearest to the point
    double distance2;
  };
  void Collect(const Eigen::Vector3d& point, const FreeSpace& space);

  double beyond_;
  std::vector<Near> near_;
};

}  // namespace touchdown::planning
