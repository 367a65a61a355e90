// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "sim/obstacles/obstacle_field.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::sim {

/// Nearest obstacle and how far it is.
struct Clearance {
  double distance = 0.0;  ///< [m]; negative: depth of penetration; +infinity: no obstacle at all
  int obstacle = -1;      ///< index in the field, -1: none
};

/// True distance between the vehicle and the obstacles, by FCL on the exact shapes. It shares no code with map, planner
/// or contact physics. The vehicle is the upright-in-B cylinder of hull_radius from the soles of the feet (-foot_depth)
/// to hull_top. This cylinder holds every colliding part of the vehicle. Ground and pad do not count. For a mesh it is
/// the distance to the surface: it is 0 where the hull touches the surface. For a hull wholly inside a mesh it is
/// positive, as from outside.
class TrueClearance {
 public:
  /// Throws std::invalid_argument naming the value if the model's hull is not a cylinder of
  /// positive size.
  TrueClearance(const ObstacleField& obstacles, const estimation::VehicleModel& model);
  TrueClearance(TrueClearance&&) noexcept;
  TrueClearance& operator=(TrueClearance&&) noexcept;
  ~TrueClearance();

  /// Distance at the vehicle's pose [m], as Clearance::distance.
  double Distance(const estimation::VehicleState& vehicle) const;

  /// The same with the obstacle that is nearest, or deepest when in collision.
  Clearance Nearest(const estimation::VehicleState& vehicle) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The least clearance of a flight. Between two poses no point of the hull moves farther than the origin's way plus the
/// way of the rotation. So only few of thousands of poses need a query, and the result is the same.
class LeastClearance {
 public:
  LeastClearance(const ObstacleField& obstacles, const estimation::VehicleModel& model);

  /// Keeps a pose. Allocates.
  void Add(const estimation::VehicleState& vehicle);
  /// The least of all poses [m]; +infinity without any.
  double Least() const;

 private:
  struct Pose {
    estimation::VehicleState vehicle;
    double way = 0.0;  ///< that any point of the hull may have come to here [m]
  };
  void Search(std::size_t first, double at_first, std::size_t last, double at_last,
              double* least) const;

  TrueClearance clearance_;
  double reach_;  // of the hull from the vehicle's origin [m]
  std::vector<Pose> poses_;
};

}  // namespace touchdown::sim
