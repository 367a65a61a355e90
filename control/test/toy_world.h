// SPDX-License-Identifier: BSD-3-Clause
// A small world for the tests of Onboard, independent of sim/. It has a rigid body with springs
// under its feet, ground, a wall and a pad that drives straight on. It makes the measurements of a
// depth camera, a tag camera and a GPS on the pad.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::control {

inline estimation::VehicleModel ToyQuadrotor() {
  estimation::VehicleModel model;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d p(i == 0 || i == 3 ? 0.12 : -0.12, i < 2 ? 0.12 : -0.12, 0.04);
    model.actuators.push_back(estimation::RotorAt(p, i % 2 == 0 ? 0.016 : -0.016, 7.0));
  }
  model.foot_azimuths = {0.785, 2.356, -2.356, -0.785};
  return model;
}

struct ToyWorld {
  static constexpr double kStep = 0.002, kDeck = 0.5, kHalfDeck = 0.75;
  estimation::VehicleModel model = ToyQuadrotor();
  estimation::VehicleState vehicle;
  Eigen::Vector4d thrusts = Eigen::Vector4d::Constant(0.25 * model.HoverThrust());
  double foot_force = 0.0;                              ///< [N]
  Eigen::Vector3d f_B{0.0, 0.0, estimation::kGravity};  ///< specific force [m/s^2]
  Eigen::Vector3d pad_start = {6.0, 1.0, kDeck}, pad_velocity = {0.5, 0.0, 0.0};
  Eigen::AlignedBox3d wall{Eigen::Vector3d(4.0, -1.0, 0.0), Eigen::Vector3d(4.4, 1.5, 3.0)};

  Eigen::Vector3d Pad() const { return pad_start + vehicle.t * pad_velocity; }
  double Heading() const {
    return std::atan2(pad_velocity.y(), pad_velocity.x());
  }  // it drives ahead
  Eigen::Matrix3d R_PW() const {
    return Eigen::AngleAxisd(-Heading(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

  void Step(const Eigen::Vector4d& command) {
    thrusts += kStep / model.rotor_lag_s * (command - thrusts);
    const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
    Eigen::Vector3d force_W(0.0, 0.0, -model.HoverThrust()), moment_B = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d thrust_B(0.0, 0.0, thrusts[i]);
      force_W += R_WB * thrust_B;
      const estimation::Actuator& rotor = model.actuators[static_cast<std::size_t>(i)];
      moment_B += rotor.p_BR.cross(thrust_B);
      moment_B.z() += rotor.moment_B.z() * thrusts[i];
    }
    foot_force = 0.0;
    for (const double azimuth : model.foot_azimuths) {
      const Eigen::Vector3d p_BF(model.foot_radius * std::cos(azimuth),
                                 model.foot_radius * std::sin(azimuth), -model.foot_depth);
      const Eigen::Vector3d p_PF = R_PW() * (vehicle.p_WB + R_WB * p_BF - Pad());
      if (p_PF.z() > 0.0 || p_PF.head<2>().cwiseAbs().maxCoeff() > kHalfDeck) continue;
      const Eigen::Vector3d v = vehicle.v_WB + R_WB * vehicle.w_WB_B.cross(p_BF) - pad_velocity;
      const double normal = std::max(0.0, -800.0 * p_PF.z() - 20.0 * v.z());
      const Eigen::Vector3d push(-6.0 * v.x(), -6.0 * v.y(), normal);
      foot_force += normal;
      force_W += push;
      moment_B += p_BF.cross(R_WB.transpose() * push);
    }
    const Eigen::Vector3d& I = model.inertia;
    const Eigen::Vector3d w = vehicle.w_WB_B;
    vehicle.w_WB_B += kStep * (moment_B - w.cross(I.cwiseProduct(w))).cwiseQuotient(I);
    vehicle.v_WB += kStep / model.mass_kg * force_W;
    f_B = R_WB.transpose() *
          (force_W / model.mass_kg + Eigen::Vector3d(0.0, 0.0, estimation::kGravity));
    vehicle.p_WB += kStep * vehicle.v_WB;
    const Eigen::Quaterniond rate(0.0, vehicle.w_WB_B.x(), vehicle.w_WB_B.y(), vehicle.w_WB_B.z());
    vehicle.q_WB.coeffs() += 0.5 * kStep * (vehicle.q_WB * rate).coeffs();
    vehicle.q_WB.normalize();
    vehicle.t += kStep;
  }

  estimation::DepthImage Depth() const {
    estimation::DepthImage image;  // 80 x 60 pixels, 90 degrees wide
    image.t = vehicle.t;
    image.p_BC = {0.1, 0.0, 0.0};
    image.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Eigen::Matrix3d R_WC = vehicle.q_WB.toRotationMatrix() * image.R_BC;
    const Eigen::Vector3d p_WC = vehicle.p_WB + vehicle.q_WB * image.p_BC;
    const Eigen::Vector3d half(kHalfDeck, kHalfDeck, 0.0), down(0.0, 0.0, 0.4);
    const Eigen::AlignedBox3d deck(-half - down, half);  // in P
    const Eigen::Vector3d p_PC = R_PW() * (p_WC - Pad());
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 80; ++u) {
        const Eigen::Vector3d ray =
            R_WC * Eigen::Vector3d((u + 0.5 - 40) / 40, (v + 0.5 - 30) / 40, 1.0);
        double depth = ray.z() < 0.0 ? -p_WC.z() / ray.z() : 1e9;
        depth = std::min({depth, Hit(wall, p_WC, ray), Hit(deck, p_PC, R_PW() * ray)});
        const bool seen = depth * ray.norm() <= image.max_range;
        image.depth.push_back(seen ? static_cast<float>(depth)
                                   : std::numeric_limits<float>::infinity());
      }
    }
    return image;
  }

  /// Over the last step, without noise.
  estimation::ImuSample Imu() const { return {vehicle.t, f_B, vehicle.w_WB_B}; }
  estimation::OwnPositionFix Gps() const { return {vehicle.t, vehicle.p_WB, 0.02, 0.04}; }
  estimation::HeightSample Height() const { return {vehicle.t, vehicle.p_WB.z(), 0.1}; }
  estimation::HeadingSample Compass() const {
    return {vehicle.t, estimation::Yaw(vehicle.q_WB), 0.03};
  }

  /// The tags are seen from up to 5 m above, within 40 degrees.
  bool SeesTags() const {
    const Eigen::Vector3d p_BP = vehicle.q_WB.conjugate() * (Pad() - vehicle.p_WB);
    return p_BP.z() < -0.15 && p_BP.z() > -5.0 && p_BP.head<2>().norm() < -0.84 * p_BP.z();
  }
  estimation::PadSighting Sighting() const {
    const Eigen::Vector3d p_BP = vehicle.q_WB.conjugate() * (Pad() - vehicle.p_WB);
    const double yaw = estimation::WrapAngle(Heading() - estimation::Yaw(vehicle.q_WB));
    return {vehicle.t, p_BP, yaw, Eigen::Vector3d::Constant(0.005), 0.01, 5};
  }
  estimation::PadGpsFix PadGps() const { return {vehicle.t, Pad().head<2>(), 0.05}; }

 private:
  static double Hit(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& ray) {
    const Eigen::Array3d a = (box.min() - from).array() / ray.array();
    const Eigen::Array3d b = (box.max() - from).array() / ray.array();
    const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
    return in > 0.0 && in <= out ? in : 1e9;
  }
};

}  // namespace touchdown::control
