// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "evaluation/scenario/scenario_world.h"
#include "sim/air/wind.h"
#include "sim/world/world.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The air of one trial at the vehicle: wind, and the pad vehicle's wake where it is asked for.
class Air {
 public:
  /// @throws std::invalid_argument for a wind out of range.
  Air(const Scenario& scenario, const TrialDraw& draw, std::uint64_t seed);

  /// The air's velocity in W [m/s] for the step that begins at the world's state now. Call once per
  /// step. Does not allocate.
  const Eigen::Vector3d& Step(const sim::World& world);

  /// Of the last step, in W [m/s].
  const Eigen::Vector3d& velocity() const { return velocity_; }

 private:
  sim::Wind wind_;
  bool pad_wake_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace touchdown::evaluation
