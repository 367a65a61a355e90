// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/planning/look/no_way.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::planning {

/// A depth camera, as its images show it.
struct LookCamera {
  estimation::CameraIntrinsics intrinsics;
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();      ///< in B [m]
  Eigen::Matrix3d R_BC = Eigen::Matrix3d::Identity();  ///< C to B
  double reach = 0.0;                                  ///< up to which its rays free cells [m]
  int images = 0;                                      ///< that were used so far
};

/// A place to look from.
struct Viewpoint {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0.0;                                ///< of the vehicle there [rad]
};

/// Notices that a vehicle makes no progress, and says where it goes to look (docs/liveness.md). One instance per
/// vehicle; not thread-safe.
class Scout {
 public:
  explicit Scout(const ReplannerOptions& options);
  ~Scout();

  /// Makes room for maps with this one's window. Otherwise the first question does it, which takes long.
  void Prepare(const OccupancyMap& map);

  /// Where to look from instead of flying to the target of `input`; none: the vehicle makes progress. Call it before
  /// every replanning step, with the step's input.
  /// @param may_look false: the step only counts as time without progress.
  /// @pre `input` has a pad or goal. One that the replanner refuses is passed by. Does not allocate after Prepare.
  std::optional<Viewpoint> Step(const ReplanInput& input, const std::vector<LookCamera>& cameras,
                                const OccupancyMap& map, bool may_look);

  /// What the map knows to block encloses the vehicle, or the goal of the last Step, which stands. What is seen later
  /// may open a way. Empty: there may be one.
  const std::optional<NoWay>& no_way() const;

  /// Why the last look began, or how it ended: "begins: ...", "ends: ...". Empty: there was none.
  std::string_view look_words() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
