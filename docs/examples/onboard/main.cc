// SPDX-License-Identifier: BSD-3-Clause
// A landing with the part that would fly, in a world of its own: no simulator, no scenario, no file. The vehicle has an
// autopilot that takes thrust and attitude; a wall stands on the way to a pad that drives straight on.
#include <algorithm>
#include <cstdio>
#include <limits>

#include <touchdown/control/onboard/envelope.h>
#include <touchdown/control/onboard/onboard.h>

using namespace touchdown;
using Eigen::Vector3d;

constexpr double kStep = 0.002, kDeck = 0.5,
                 kHalf = 0.75;  // [s], height and half the side of the deck [m]

struct World {
  estimation::VehicleModel model;
  estimation::VehicleState vehicle;
  double foot_force = 0.0;
  Eigen::AlignedBox3d wall{Vector3d(4.0, -1.0, 0.0), Vector3d(4.4, 1.5, 3.0)};

  World() {
    vehicle.p_WB = {0.0, 0.0, 2.0};
    for (int i = 0; i < 4; ++i) {
      const Vector3d hub(i == 0 || i == 3 ? 0.12 : -0.12, i < 2 ? 0.12 : -0.12, 0.04);
      model.actuators.push_back(estimation::RotorAt(hub, i % 2 == 0 ? 0.016 : -0.016, 7.0));
    }
  }
  Vector3d Pad() const { return Vector3d(6.0 + 0.5 * vehicle.t, 1.0, kDeck); }

  // The autopilot is at the wanted attitude in 50 ms. Where the set-point does not count any more, it levels out and
  // hovers. Feet stand on a spring.
  void Step(const control::Setpoint& setpoint) {
    const bool counts = setpoint.CountsAt(vehicle.t);
    const Eigen::Quaterniond before = vehicle.q_WB;
    const Eigen::Quaterniond wanted(counts ? setpoint.R_WB : Eigen::Matrix3d::Identity());
    vehicle.q_WB = before.slerp(kStep / 0.05, wanted);
    vehicle.w_WB_B = 2.0 / kStep * (before.conjugate() * vehicle.q_WB).vec();
    const double thrust = counts ? setpoint.wrench.thrust : model.HoverThrust();
    Vector3d force = vehicle.q_WB * Vector3d(0.0, 0.0, thrust);
    const Vector3d p = vehicle.p_WB - Pad(), v = vehicle.v_WB - Vector3d(0.5, 0.0, 0.0);
    const bool stands = p.z() < model.foot_depth && p.head<2>().cwiseAbs().maxCoeff() < kHalf;
    foot_force = stands ? std::max(0.0, 2000.0 * (model.foot_depth - p.z()) - 60.0 * v.z()) : 0.0;
    force.z() += foot_force - model.HoverThrust();
    if (stands) force.head<2>() -= 20.0 * v.head<2>();
    vehicle.v_WB += kStep / model.mass_kg * force;
    vehicle.p_WB += kStep * vehicle.v_WB;
    vehicle.t += kStep;
  }

  estimation::DepthImage Depth() const {
    estimation::DepthImage image;  // 80 x 60 pixels, 90 degrees wide
    image.t = vehicle.t;
    image.p_BC = {0.1, 0.0, 0.0};
    image.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Vector3d from = vehicle.p_WB + vehicle.q_WB * image.p_BC, half(kHalf, kHalf, 0.0);
    const Eigen::AlignedBox3d deck(Pad() - half - Vector3d(0.0, 0.0, 0.4), Pad() + half);
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 80; ++u) {
        const Vector3d pixel((u - 39.5) / 40.0, (v - 29.5) / 40.0, 1.0);
        const Vector3d ray = vehicle.q_WB * (image.R_BC * pixel);
        double depth = ray.z() < 0.0 ? -from.z() / ray.z() : 1e9;
        for (const auto& box : {wall, deck}) depth = std::min(depth, Hit(box, from, ray));
        const bool seen = depth * ray.norm() <= image.max_range;
        image.depth.push_back(static_cast<float>(seen ? depth : 1.0 / 0.0));
      }
    }
    return image;
  }

  static double Hit(const Eigen::AlignedBox3d& box, const Vector3d& from, const Vector3d& ray) {
    const Eigen::Array3d a = (box.min() - from).array() / ray.array();
    const Eigen::Array3d b = (box.max() - from).array() / ray.array();
    const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
    return in > 0.0 && in <= out ? in : 1e9;
  }

  Vector3d PadInBody() const { return vehicle.q_WB.conjugate() * (Pad() - vehicle.p_WB); }
  bool SeesTags() const {  // within 40 degrees of straight down
    return PadInBody().z() < -0.15 && PadInBody().head<2>().norm() < -0.84 * PadInBody().z();
  }
};

int main() {
  World world;
  control::OnboardOptions options = control::LandingOptions(world.model, kDeck);
  options.estimate_disturbance = false;  // the autopilot sees to that
  control::Onboard onboard(options, control::LandingParts(options));
  onboard.Take(world.vehicle);
  onboard.Begin(0.0, Eigen::Vector4d::Constant(0.25 * world.model.HoverThrust()));

  for (int k = 0; k < 30000; ++k) {
    const double t = world.vehicle.t;
    onboard.Take(world.vehicle);  // as by motion capture
    onboard.Take(estimation::FootForce{t, world.foot_force});
    if (k % 50 == 0) onboard.Take(estimation::PadGpsFix{t, world.Pad().head<2>(), 0.05});
    if (k % 50 == 0) onboard.Take(world.Depth());
    if (k % 25 == 0 && world.SeesTags()) {
      onboard.Take(estimation::PadSighting{t, world.PadInBody(),
                                           -estimation::Yaw(world.vehicle.q_WB),
                                           Vector3d::Constant(0.005), 0.01, 5});
    }
    const control::Setpoint& setpoint = onboard.Step(t);
    const control::OnboardStatus& status = onboard.status();
    if (status.time != control::StepTime::kGood) {
      std::printf("%5.2f s  step: %s\n", t, ToString(status.time).data());
    }
    if (status.mission_step && status.mission.reason != control::TransitionReason::kNone) {
      std::printf("%5.2f s  %s (%s)\n", t, ToString(status.mission.mode).data(),
                  ToString(status.mission.reason).data());
    }
    if (!setpoint.armed) {
      const double off = (world.vehicle.p_WB - world.Pad()).head<2>().norm();
      std::printf("landed %.3f m from the middle of the pad\n", off);
      return off < 0.3 ? 0 : 1;
    }
    world.Step(setpoint);
  }
  std::printf("not landed: %s\n", ToString(onboard.status().mission.mode).data());
  return 1;
}
