// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/obstacles/obstacle_field.h"

struct mjModel_;
struct mjData_;

namespace touchdown::sim {

/// A place where the vehicle touches an obstacle.
struct Touch {
  int obstacle = -1;                              ///< index in the field
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
};

/// Finds out when the vehicle's parts touch obstacles. The kinds and the number of obstacles do not matter, and nothing
/// is pushed back. By FCL on the shapes themselves; a mesh of the vehicle counts by its triangles.
class ObstacleTouch {
 public:
  /// @param geoms the vehicle's parts that can touch.
  /// @throws std::invalid_argument naming a part of a kind that is none: plane, height field.
  ObstacleTouch(const ObstacleField& obstacles, const mjModel_& model,
                const std::vector<int>& geoms);
  ObstacleTouch(ObstacleTouch&&) noexcept;
  ObstacleTouch& operator=(ObstacleTouch&&) noexcept;
  ~ObstacleTouch();

  /// The first touch that is found with the parts where `data` has them; `p_W` is the vehicle's origin then. Allocates
  /// where an obstacle is within the vehicle's reach.
  std::optional<Touch> Find(const mjData_& data, const Eigen::Vector3d& p_W) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::sim
