// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <Eigen/Core>

#include "touchdown/planning/flatness.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// Plans, re-plans and holds the committed trajectory (docs/architecture.md). One instance
/// per vehicle; not thread-safe; different instances are independent.
class Replanner {
 public:
  /// Throws std::invalid_argument if an option is out of range, or if the backend is unknown or
  /// cannot do what the options ask (the sentence says which).
  Replanner(const ReplannerOptions& options, const solvers::BackendRegistry& backends);
  ~Replanner();
  Replanner(Replanner&&) noexcept;
  Replanner& operator=(Replanner&&) noexcept;

  /// The vehicle hovers at p_W from t on: the first committed trajectory.
  void CommitHover(const Eigen::Vector3d& p_W, double t);

  /// One replanning step against the map. The result stays valid until the next call. What the map
  /// has not observed cannot be braked in: a map that was filled by hand needs MarkOwnVolume around
  /// the vehicle, as a sensor's map needs the vehicle's own hull.
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map);

  /// Comes to rest and stays, for want of a pad to go to: a certified braking trajectory, or with
  /// `climb` > 0 [m] one that ends that much higher. Once it is under way and clear it is kept.
  /// `input.pad` and `input.endpoint` are not used.
  const ReplanResult& Rest(const ReplanInput& input, double climb, const OccupancyMap& map);

  /// The committed reference at time t (yaw fields zero). The plan made by Replan takes over at its
  /// t_start; before that the older one is flown. Does not allocate.
  FlatState Reference(double t) const;

  const ReplannerOptions& options() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
