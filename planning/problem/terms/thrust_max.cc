// SPDX-License-Identifier: BSD-3-Clause
// Greatest thrust by differential flatness: the thrust over the mass is |a + g e_z - d| under a
// steady pull d, such as wind. The acceleration is linear between its control points A_i and the
// norm is convex. So a limit kept at the A_i is kept on the whole curve. Convex at fixed h. D.
// Mellinger and V. Kumar, ICRA 2011.

#include "planning/problem/terms/of_acceleration.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

namespace {

struct ThrustAbove : OfAcceleration<ThrustAbove> {
  double limit = 1.0;
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< [m/s^2]
  void Update(const LandingContext& context) { pull_W = context.pull_W; }
  double At(const Eigen::Vector3d& a, Eigen::Vector3d* g, Eigen::Matrix3d* H) const {
    const Eigen::Vector3d f = a + estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
    *g = f / limit;
    *H = Eigen::Matrix3d::Identity() / limit;
    return (f.squaredNorm() - limit * limit) / (2.0 * limit);
  }
};

}  // namespace

TermEntry ThrustMaxTerm() {
  TermEntry entry;
  entry.info = {"thrust_max", "w sum hinge((|A + g e_z - d|^2 - f_max^2) / (2 f_max))", "m/s^2",
                "flatness (Mellinger and Kumar 2011)", true};
  entry.parameters = {HingeWidth(1.0, "m/s^2"), SoftMargin()};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    ThrustAbove map;
    map.count = FreeAccelerations(setup);
    map.limit = (setup.hard ? 1.0 : setup.Get("margin")) * setup.vehicle.thrust_max;
    return MakeLandingTerm(info, map, setup.Hinge(), map.count);
  };
  return entry;
}

}  // namespace touchdown::planning
