// SPDX-License-Identifier: BSD-3-Clause
// Limit on the tilt of the thrust axis f = a + g e_z - d, with d a steady pull, in cone form. At
// the acceleration control points A_i its horizontal part, smoothed, is at most tan(tilt) times its
// vertical part. The cone is convex and the acceleration linear between the A_i. So a limit kept
// there is kept on the whole curve. Convex at fixed h. D. Mellinger and V. Kumar, ICRA 2011.

#include <cmath>

#include "planning/problem/terms/of_acceleration.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {

namespace {

constexpr double kSmoothedTip = 0.1;  // [m/s^2]

struct OutsideCone : OfAcceleration<OutsideCone> {
  double slope = 1.0;
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< [m/s^2]
  void Update(const LandingContext& context) { pull_W = context.pull_W; }
  double At(const Eigen::Vector3d& a, Eigen::Vector3d* g, Eigen::Matrix3d* H) const {
    const Eigen::Vector3d f = a + estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
    const double s = std::sqrt(f.head<2>().squaredNorm() + kSmoothedTip * kSmoothedTip);
    const Eigen::Vector2d w = f.head<2>() / s;
    *g << w, -slope;
    H->setZero();
    H->topLeftCorner<2, 2>() = (Eigen::Matrix2d::Identity() - w * w.transpose()) / s;
    return s - slope * f.z();
  }
};

}  // namespace

TermEntry TiltLimitTerm() {
  TermEntry entry;
  entry.info = {"tilt_limit",
                "w sum hinge(sqrt(f_x^2 + f_y^2 + eps^2) - tan(tilt) f_z), f = A + g e_z - d",
                "m/s^2", "flatness (Mellinger and Kumar 2011)", true};
  entry.parameters = {HingeWidth(1.0, "m/s^2"), SoftMargin()};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    OutsideCone map;
    map.count = FreeAccelerations(setup);
    map.slope = (setup.hard ? 1.0 : setup.Get("margin")) * std::tan(setup.vehicle.tilt_max);
    return MakeLandingTerm(info, map, setup.Hinge(), map.count);
  };
  return entry;
}

}  // namespace touchdown::planning
