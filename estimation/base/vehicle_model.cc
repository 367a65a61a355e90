// SPDX-License-Identifier: BSD-3-Clause
// The wrench is linear in the commands: column i is the wrench of actuator i per unit. With four independent
// actuators the matrix B is inverted. With more, the shortest of all commands that make a wrench is taken, each as a
// share of its range. That is W B^T (B W B^T)^-1 w with the squares of the ranges in W. Without W a weak actuator of
// another unit would have to do most of the work.

#include "touchdown/estimation/base/vehicle_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

#include "estimation/base/argument_check.h"

namespace touchdown::estimation {
namespace {

constexpr double kNoShare = 1e-9;  // of an actuator that makes moments alone, up to rounding

[[noreturn]] void Refuse(const std::string& what) {
  throw std::invalid_argument("VehicleModel.actuators: " + what);
}

void CheckActuator(const Actuator& actuator, std::size_t i) {
  const bool finite = actuator.p_BR.allFinite() && actuator.moment_B.allFinite() &&
                      std::isfinite(actuator.min) && std::isfinite(actuator.max);
  const bool pushes = actuator.thrust == 1.0;
  if (!finite || !(pushes || actuator.thrust == 0.0) || !(actuator.min < actuator.max) ||
      (pushes && actuator.min < 0.0)) {
    Refuse("number " + std::to_string(i) + " has the range " + NumberText(actuator.min) + " to " +
           NumberText(actuator.max) + " and thrust " + NumberText(actuator.thrust) +
           "; allowed: finite figures, min < max, thrust 0 or 1, and min >= 0 with 1");
  }
}

}  // namespace

Allocation AllocationOf(const VehicleModel& model) {
  const auto count = static_cast<Eigen::Index>(model.actuators.size());
  if (count < kLeastActuators || count > kMostActuators) {
    Refuse(std::to_string(count) + " of them; allowed: 4 to 8");
  }
  Allocation allocation;
  auto& wrench = allocation.wrench_of_commands;
  wrench.resize(4, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Actuator& actuator = model.actuators[static_cast<std::size_t>(i)];
    CheckActuator(actuator, static_cast<std::size_t>(i));
    const Eigen::Vector3d& p = actuator.p_BR;
    wrench.col(i) << actuator.thrust, actuator.thrust * p.y() + actuator.moment_B.x(),
        -actuator.thrust * p.x() + actuator.moment_B.y(), actuator.moment_B.z();
  }
  Commands squares(count);  // of the ranges
  for (Eigen::Index i = 0; i < count; ++i) {
    const Actuator& actuator = model.actuators[static_cast<std::size_t>(i)];
    squares(i) = (actuator.max - actuator.min) * (actuator.max - actuator.min);
  }
  const Eigen::Matrix4d square =
      count == 4 ? Eigen::Matrix4d(wrench.leftCols<4>())
                 : Eigen::Matrix4d(wrench * squares.asDiagonal() * wrench.transpose());
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(square);
  if (!lu.isInvertible()) {
    Refuse("their places and reaction torques do not span thrust and three moments");
  }
  auto& commands = allocation.commands_of_wrench;
  if (count == 4) {
    commands = lu.inverse();
  } else {
    commands = squares.asDiagonal() * wrench.transpose() * lu.inverse();
  }
  allocation.thrust_max = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Actuator& actuator = model.actuators[static_cast<std::size_t>(i)];
    double& share = commands(i, 0);
    if (std::abs(share) < kNoShare && actuator.thrust == 0.0) share = 0.0;
    if (actuator.thrust > 0.0 && !(share > 0.0)) {
      Refuse("share of number " + std::to_string(i) + " in thrust without a moment = " +
             NumberText(share) + ", allowed: > 0 (centre of mass between the rotors)");
    }
    if (share == 0.0) continue;
    const bool with = share > 0.0;
    allocation.thrust_min =
        std::max(allocation.thrust_min, (with ? actuator.min : actuator.max) / share);
    allocation.thrust_max =
        std::min(allocation.thrust_max, (with ? actuator.max : actuator.min) / share);
  }
  return allocation;
}

Eigen::Vector3d HoverTurn(const VehicleModel& model) {
  const Allocation allocation = AllocationOf(model);
  const Eigen::Matrix3d inertia_B =
      model.R_BI * model.inertia.asDiagonal() * model.R_BI.transpose();
  Eigen::Vector3d turn;
  for (int axis = 0; axis < 3; ++axis) {
    turn(axis) = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < allocation.commands_of_wrench.rows(); ++i) {
      const Actuator& actuator = model.actuators[static_cast<std::size_t>(i)];
      const double level = allocation.Shares()(i) * model.HoverThrust();
      const double room = std::max(0.0, std::min(level - actuator.min, actuator.max - level));
      // About one axis alone: the moment for it has parts about the others.
      const double per_turn =
          std::abs(allocation.commands_of_wrench.row(i).tail<3>().dot(inertia_B.col(axis)));
      if (per_turn > 0.0) turn(axis) = std::min(turn(axis), room / per_turn);
    }
  }
  return turn;
}

}  // namespace touchdown::estimation
