// SPDX-License-Identifier: BSD-3-Clause
// Where to fly to without a pad. A goal is handed to a planner as its ReplanInput::pad. The body's origin ends at
// `ReplanInput::endpoint.height` above it, which is 1.5 m if it is not set: 0 ends in the goal.
#pragma once

#include <array>
#include <functional>
#include <utility>

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/spline/taylor.h"

namespace touchdown::planning {

/// A point that stands.
class GoalAt final : public estimation::PadPrediction {
 public:
  /// p_W in W [m]. Throws std::invalid_argument if it is not finite.
  explicit GoalAt(const Eigen::Vector3d& p_W);

  estimation::PadState At(double t) const noexcept override;
  bool has_deck() const noexcept override { return false; }

 private:
  Eigen::Vector3d p_W_;
};

/// A point that moves by a function of time.
class MovingGoal final : public estimation::PadPrediction {
 public:
  using Position = std::array<Taylor, 3>;

  /// `position` takes the time as a Taylor series and gives x, y and z in W [m]. Velocity, acceleration and jerk follow
  /// from it exactly. There are + - * /, sqrt, exp, sin and cos (taylor.h):
  ///
  ///     MovingGoal goal([](const Taylor& t) { return MovingGoal::Position{2.0 + 0.5 * t, sin(t), 1.5}; });
  ///
  /// It is called at every question, from any thread, and should not allocate.
  /// Throws std::invalid_argument if there is no function. Where it throws or is not finite, the goal is unknown.
  explicit MovingGoal(std::function<Position(const Taylor& t)> position);

  estimation::PadState At(double t) const noexcept override;
  bool has_deck() const noexcept override { return false; }

 private:
  std::function<Position(const Taylor&)> position_;
};

}  // namespace touchdown::planning
