// SPDX-License-Identifier: BSD-3-Clause
// Mixer: the paper's eq. 8 for any actuators. The wrench is linear in the commands; the matrix is inverted once.
// Saturation by priority, with the contribution r of the roll and pitch moment:
// 1. A collective thrust T is possible if low_i <= s r_i + c_i T <= high_i for every actuator i. c_i is its share in
//    pure thrust. It is 0 for an actuator that makes a moment alone, which bounds s by itself.
// 2. Take the greatest scale s <= 1 with such a T that does not exceed the wanted or raised thrust.
//    It follows in closed form from all rotors and pairs of them.
// 3. Clamp T to its interval. Yaw takes what is left.

#include "control/tracking/mixer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchdown::control {

Mixer::Mixer(const estimation::VehicleModel& model) : allocation_(estimation::AllocationOf(model)) {
  const auto count = static_cast<Eigen::Index>(model.actuators.size());
  min_.resize(count);
  max_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    min_(i) = model.actuators[static_cast<std::size_t>(i)].min;
    max_(i) = model.actuators[static_cast<std::size_t>(i)].max;
  }
  const double lowest = allocation_.thrust_min;
  raised_thrust_ = lowest + kRaisedThrust * std::max(0.0, model.HoverThrust() - lowest);
}

MixerOutput Mixer::Mix(const Wrench& wrench) const noexcept {
  MixerOutput output;
  const Eigen::Index count = min_.size();
  if (!std::isfinite(wrench.thrust) || !wrench.moment_B.allFinite()) {
    output.thrusts = Commands::Zero(count).cwiseMax(min_).cwiseMin(max_);
    output.saturated = true;
    return output;
  }
  const auto& per_wrench = allocation_.commands_of_wrench;
  const Commands share = per_wrench.col(0);
  const Commands yaw = per_wrench.col(3) * wrench.moment_B.z();
  Commands thrusts =
      per_wrench.col(1) * wrench.moment_B.x() + per_wrench.col(2) * wrench.moment_B.y();
  output.thrusts = Level(wrench.thrust);
  for (int axis = 0; axis < 3; ++axis) {
    output.thrusts += per_wrench.col(axis + 1) * wrench.moment_B(axis);
  }
  if ((output.thrusts.array() >= min_.array()).all() &&
      (output.thrusts.array() <= max_.array()).all()) {
    return output;
  }
  output.saturated = true;

  const double highest_thrust = std::max(wrench.thrust, raised_thrust_);
  double scale = 1.0;
  const auto shorten = [&scale](double needed, double available) {
    if (needed > 0.0 && needed * scale > available) scale = std::max(0.0, available / needed);
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    if (share(i) == 0.0) {
      shorten(-thrusts(i), -min_(i));
      shorten(thrusts(i), max_(i));
      continue;
    }
    const double sign = share(i) > 0.0 ? 1.0 : -1.0;
    shorten(-sign * thrusts(i), sign * (highest_thrust * share(i) - AtLeastThrust(i)));
    for (Eigen::Index j = 0; j < count; ++j) {
      if (share(j) == 0.0) continue;
      shorten(thrusts(j) / share(j) - thrusts(i) / share(i),
              AtMostThrust(j) / share(j) - AtLeastThrust(i) / share(i));
    }
  }
  thrusts *= scale;

  double low = -std::numeric_limits<double>::infinity(), highest = -low;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (share(i) == 0.0) continue;
    low = std::max(low, (AtLeastThrust(i) - thrusts(i)) / share(i));
    highest = std::min(highest, (AtMostThrust(i) - thrusts(i)) / share(i));
  }
  const double high = std::max(low, highest);  // equal up to rounding if scale < 1
  thrusts += share * std::clamp(wrench.thrust, low, high);

  double yaw_scale = 1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double room = yaw(i) > 0.0 ? max_(i) - thrusts(i) : thrusts(i) - min_(i);
    if (std::abs(yaw(i)) * yaw_scale > room) yaw_scale = std::max(0.0, room / std::abs(yaw(i)));
  }
  thrusts += yaw_scale * yaw;
  output.thrusts = thrusts.cwiseMax(min_).cwiseMin(max_);  // rounding only
  return output;
}

Wrench Mixer::Apply(const Commands& thrusts) const noexcept {
  Eigen::Vector4d w = allocation_.wrench_of_commands.col(0) * thrusts(0);
  for (Eigen::Index i = 1; i < thrusts.size(); ++i) {
    w += allocation_.wrench_of_commands.col(i) * thrusts(i);
  }
  return {w(0), w.tail<3>()};
}

estimation::Commands Mixer::Level(double thrust) const noexcept {
  return allocation_.Shares() * thrust;
}

}  // namespace touchdown::control
