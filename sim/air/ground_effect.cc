// SPDX-License-Identifier: BSD-3-Clause
// I. C. Cheeseman, W. E. Bennett, "The effect of the ground on a helicopter rotor in forward flight", ARC R&M 3021,
// 1955:
//   T / T_far = 1 / (1 - (R / 4z)^2 / (1 + (V / v_i)^2)),
// with the induced velocity at hover v_i = sqrt(T_far / (2 rho pi R^2)). A rotor's image below the ground slows the
// inflow; forward speed carries the image's flow away. They validate it from z = R/2 on. Each rotor counts alone: what
// quadrotors gain beyond that between their rotors (P. Sanchez-Cuevas, G. Heredia, A. Ollero, Int. J. Aerospace Eng.
// 2017) is left out.

#include "sim/air/ground_effect.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Geometry>

#include "sim/air/drag.h"

namespace touchdown::sim {
namespace {

// Height of a point above the deck or the ground below it [m].
double HeightAbove(const Box& deck, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p =
      Eigen::AngleAxisd(-deck.yaw, Eigen::Vector3d::UnitZ()) * (p_W - deck.center);
  const bool over = p.z() > 0.0 && (p.cwiseAbs() - deck.half_extents).head<2>().maxCoeff() <= 0.0;
  return over ? p.z() - deck.half_extents.z() : p_W.z();
}

}  // namespace

double GroundEffectRatio(double radius, double height, double thrust, double airspeed) {
  if (!(thrust > 0.0)) return 1.0;
  const double image = radius / (4.0 * std::max(height, 0.5 * radius));
  const double inflow2 = thrust / (2.0 * kAirDensity * std::numbers::pi * radius * radius);
  return 1.0 / (1.0 - image * image / (1.0 + airspeed * airspeed / inflow2));
}

GroundEffect GroundEffectOf(const estimation::VehicleModel& model,
                            const estimation::VehicleState& vehicle,
                            const estimation::Commands& thrusts, const Box& deck, double airspeed) {
  GroundEffect effect;
  for (Eigen::Index i = 0; i < thrusts.size(); ++i) {
    const estimation::Actuator& rotor = model.actuators[static_cast<std::size_t>(i)];
    if (rotor.thrust == 0.0) continue;
    const Eigen::Vector3d& p_BR = rotor.p_BR;
    const double height = HeightAbove(deck, vehicle.p_WB + vehicle.q_WB * p_BR);
    const double ratio = GroundEffectRatio(model.rotor_radius, height, thrusts(i), airspeed);
    const double more = (ratio - 1.0) * thrusts(i);
    effect.thrust += more;
    effect.moment_B += more * p_BR.cross(Eigen::Vector3d::UnitZ());
  }
  return effect;
}

}  // namespace touchdown::sim
