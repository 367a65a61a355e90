// SPDX-License-Identifier: BSD-3-Clause
// Mixer: the paper's eq. 8 for any four rotors. The wrench is linear in the thrusts; the 4x4 matrix
// is inverted once. Saturation by priority: with the contribution r of the roll and pitch moment, a
// collective thrust T is possible if low <= s r_i + c_i T <= high for every rotor i (c_i > 0: share
// of rotor i in pure thrust). The greatest scale s <= 1 that leaves such a T, none above what is wanted or what
// the thrust may be raised to, follows in closed form from all rotors and pairs of them; T is clamped to its
// interval; yaw takes what is left.

#include "control/tracking/mixer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

namespace touchdown::control {

Mixer::Mixer(const estimation::VehicleModel& model)
    : min_(model.rotor_thrust_min), max_(model.rotor_thrust_max) {
  if (!(std::isfinite(min_) && std::isfinite(max_) && min_ >= 0.0 && min_ < max_)) {
    throw std::invalid_argument("VehicleModel.rotor_thrust_min, _max = " + std::to_string(min_) +
                                ", " + std::to_string(max_) + ", allowed: 0 <= min < max");
  }
  for (int i = 0; i < 4; ++i) {
    const estimation::Rotor& rotor = model.rotors[static_cast<std::size_t>(i)];
    wrench_from_thrusts_.col(i) << 1.0, rotor.p_BR.y(), -rotor.p_BR.x(),
        rotor.spin * model.torque_per_thrust;
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(wrench_from_thrusts_);
  if (!wrench_from_thrusts_.allFinite() || !lu.isInvertible()) {
    throw std::invalid_argument(
        "VehicleModel.rotors: positions, spins and torque_per_thrust do not span thrust and three "
        "moments");
  }
  thrusts_from_wrench_ = lu.inverse();
  const double least_share = thrusts_from_wrench_.col(0).minCoeff();
  if (least_share <= 0.0) {
    throw std::invalid_argument("VehicleModel.rotors: least share of a rotor in pure thrust = " +
                                std::to_string(least_share) +
                                ", allowed: > 0 (centre of mass between the rotors)");
  }
  const double lowest = min_ / least_share;
  raised_thrust_ = lowest + kRaisedThrust * std::max(0.0, model.HoverThrust() - lowest);
}

MixerOutput Mixer::Mix(const Wrench& wrench) const noexcept {
  MixerOutput output;
  Eigen::Vector4d demand;
  demand << wrench.thrust, wrench.moment_B;
  if (!demand.allFinite()) {
    output.thrusts.setConstant(min_);
    output.saturated = true;
    return output;
  }
  output.thrusts = thrusts_from_wrench_ * demand;
  if (output.thrusts.minCoeff() >= min_ && output.thrusts.maxCoeff() <= max_) return output;
  output.saturated = true;

  const Eigen::Vector4d share = thrusts_from_wrench_.col(0);
  const Eigen::Vector4d yaw = thrusts_from_wrench_.col(3) * demand(3);
  Eigen::Vector4d thrusts = thrusts_from_wrench_.middleCols<2>(1) * demand.segment<2>(1);

  const double highest_thrust = std::max(demand(0), raised_thrust_);
  double scale = 1.0;
  for (int i = 0; i < 4; ++i) {
    const double room = std::max(0.0, highest_thrust * share(i) - min_);
    if (-thrusts(i) * scale > room) scale = room / -thrusts(i);
    for (int j = 0; j < 4; ++j) {
      const double needed = thrusts(j) / share(j) - thrusts(i) / share(i);
      const double available = max_ / share(j) - min_ / share(i);
      if (needed > 0.0 && needed * scale > available) scale = std::max(0.0, available / needed);
    }
  }
  thrusts *= scale;

  const Eigen::Vector4d lowest = (Eigen::Vector4d::Constant(min_) - thrusts).cwiseQuotient(share);
  const Eigen::Vector4d highest = (Eigen::Vector4d::Constant(max_) - thrusts).cwiseQuotient(share);
  const double low = lowest.maxCoeff();
  const double high = std::max(low, highest.minCoeff());  // equal up to rounding if scale < 1
  thrusts += share * std::clamp(demand(0), low, high);

  double yaw_scale = 1.0;
  for (int i = 0; i < 4; ++i) {
    const double room = yaw(i) > 0.0 ? max_ - thrusts(i) : thrusts(i) - min_;
    if (std::abs(yaw(i)) * yaw_scale > room) yaw_scale = std::max(0.0, room / std::abs(yaw(i)));
  }
  thrusts += yaw_scale * yaw;
  output.thrusts = thrusts.cwiseMax(min_).cwiseMin(max_);  // rounding only
  return output;
}

Wrench Mixer::Apply(const Eigen::Vector4d& thrusts) const noexcept {
  const Eigen::Vector4d w = wrench_from_thrusts_ * thrusts;
  return {w(0), w.tail<3>()};
}

}  // namespace touchdown::control
