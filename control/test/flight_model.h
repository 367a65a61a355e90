// SPDX-License-Identifier: BSD-3-Clause
// A small quadrotor for the control tests, independent of sim/. It is a rigid body with quaternion,
// mixer, first-order rotor lag and linear rotor drag. Integration is fourth-order Runge-Kutta, with
// control at 500 Hz held over each step.
#pragma once

#include <functional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/tracking/mixer.h"
#include "control/tracking/rotor_lead.h"
#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

/// Rotors on the diagonals, 0.2 m from the centre.
inline estimation::VehicleModel TestVehicle() {
  estimation::VehicleModel model;
  const double a = 0.1414;
  model.actuators = {estimation::RotorAt({a, -a, 0.02}, 0.016, 7.0),
                     estimation::RotorAt({-a, a, 0.02}, 0.016, 7.0),
                     estimation::RotorAt({a, a, 0.02}, -0.016, 7.0),
                     estimation::RotorAt({-a, -a, 0.02}, -0.016, 7.0)};
  return model;
}

class FlightModel {
 public:
  using Reference = std::function<planning::FlatState(double)>;
  static constexpr double kStep = 0.002;

  FlightModel(const estimation::VehicleModel& model, const Controller& controller)
      : model_(model), mixer_(model), controller_(controller) {
    thrusts_.setConstant(0.25 * model.HoverThrust());
  }

  estimation::VehicleState state;
  bool saturated = false;     ///< in the last step
  RotorLead* lead = nullptr;  ///< on the rotors' commands, if given

  void Step(const planning::FlatState& reference) {
    MixerOutput command = mixer_.Mix(controller_.Update(state, reference).wrench);
    if (lead != nullptr) command.thrusts = lead->Command(command.thrusts, state.t);
    saturated = command.saturated;
    Vector17 x;
    x << state.p_WB, state.v_WB, state.q_WB.coeffs(), state.w_WB_B, thrusts_;
    const Vector17 k1 = Derivative(x, command.thrusts);
    const Vector17 k2 = Derivative(x + 0.5 * kStep * k1, command.thrusts);
    const Vector17 k3 = Derivative(x + 0.5 * kStep * k2, command.thrusts);
    const Vector17 k4 = Derivative(x + kStep * k3, command.thrusts);
    x += kStep / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    state.t += kStep;
    state.p_WB = x.segment<3>(0);
    state.v_WB = x.segment<3>(3);
    state.q_WB.coeffs() = x.segment<4>(6).normalized();
    state.w_WB_B = x.segment<3>(10);
    thrusts_ = x.segment<4>(13);
  }

  /// Flies to time t; `watch` sees the reference after every step.
  void Fly(double t, const Reference& reference,
           const std::function<void(const planning::FlatState&)>& watch = {}) {
    while (state.t < t - 0.5 * kStep) {
      Step(reference(state.t));
      if (watch) watch(reference(state.t));
    }
  }

 private:
  using Vector17 = Eigen::Matrix<double, 17, 1>;

  Vector17 Derivative(const Vector17& x, const Eigen::Vector4d& command) const {
    const Eigen::Vector3d v_WB = x.segment<3>(3);
    const Eigen::Quaterniond q_WB(
        Eigen::Quaterniond(Eigen::Vector4d(x.segment<4>(6))).normalized());
    const Eigen::Vector3d w_B = x.segment<3>(10);
    const Eigen::Matrix3d R_WB = q_WB.toRotationMatrix();
    const Wrench wrench = mixer_.Apply(estimation::Commands(x.segment<4>(13)));
    const Eigen::Vector3d drag_B = -model_.rotor_drag.cwiseProduct(R_WB.transpose() * v_WB);
    const Eigen::Vector3d force_W =
        R_WB * (Eigen::Vector3d(0.0, 0.0, wrench.thrust) + drag_B) -
        model_.mass_kg * estimation::kGravity * Eigen::Vector3d::UnitZ();
    const Eigen::Quaterniond rate(0.0, w_B.x(), w_B.y(), w_B.z());
    Vector17 dx;
    dx.segment<3>(0) = v_WB;
    dx.segment<3>(3) = force_W / model_.mass_kg;
    dx.segment<4>(6) = 0.5 * (q_WB * rate).coeffs();
    dx.segment<3>(10) = model_.AccelerationUnder(wrench.moment_B - model_.GyroscopicMoment(w_B));
    dx.segment<4>(13) = (command - x.segment<4>(13)) / model_.rotor_lag_s;
    return dx;
  }

  estimation::VehicleModel model_;
  Mixer mixer_;
  const Controller& controller_;
  Eigen::Vector4d thrusts_;
};

}  // namespace touchdown::control
