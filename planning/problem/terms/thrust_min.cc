// SPDX-License-Identifier: BSD-3-Clause
// Least thrust by differential flatness, |a + g e_z - d| >= f_min at the acceleration control
// points A_i, under a steady pull d. Without thrust the attitude has no direction. Not convex, and
// between the knots the thrust may be smaller. D. Mellinger and V. Kumar, ICRA 2011.

#include <algorithm>

#include "planning/problem/terms/of_acceleration.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

namespace {

struct ThrustBelow : OfAcceleration<ThrustBelow> {
  double limit = 1.0;
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< [m/s^2]
  void Update(const LandingContext& context) { pull_W = context.pull_W; }
  double At(const Eigen::Vector3d& a, Eigen::Vector3d* g, Eigen::Matrix3d* H) const {
    const Eigen::Vector3d f = a + estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
    *g = -f / limit;
    *H = -Eigen::Matrix3d::Identity() / limit;
    return (limit * limit - f.squaredNorm()) / (2.0 * limit);
  }
};

}  // namespace

TermEntry ThrustMinTerm() {
  TermEntry entry;
  entry.info = {"thrust_min", "w sum hinge((f_min^2 - |A + g e_z - d|^2) / (2 f_min))", "m/s^2",
                "flatness (Mellinger and Kumar 2011)", false};
  entry.parameters = {HingeWidth(1.0, "m/s^2"),
                      {"floor", 2.0, 0.1, 9.0, "f_min is this or what the rotors give [m/s^2]"}};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    ThrustBelow map;
    map.count = FreeAccelerations(setup);
    map.limit = std::max(setup.Get("floor"), setup.vehicle.thrust_min);
    return MakeLandingTerm(info, map, setup.Hinge(), map.count);
  };
  return entry;
}

}  // namespace touchdown::planning
