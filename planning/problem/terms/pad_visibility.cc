// SPDX-License-Identifier: BSD-3-Clause
// Keeps the pad in the cone of the downward camera. The camera looks against the thrust axis that
// the flat outputs demand. At knot k, with d from the vehicle to the predicted pad and
// f = a + g e_z - pull,
//   u = sqrt(|d|^2 + eps^2) cos(half angle) + d . f / sqrt(|f|^2 + eps^2).
// It is zero on the cone and of the size of the distance. Not convex. D. Mellinger and V. Kumar,
// ICRA 2011 for the axis; docs/formulation.md.

#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

constexpr double kSmoothedEdge = 0.05;  // [m] and [m/s^2]

struct OutOfView {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  double cosine, span;
  const estimation::PadPrediction* pad = &estimation::UnknownPad();
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< [m/s^2]
  LastKnots knots;

  int windows() const { return knots.count; }
  int first_block(int k) const { return knots.first + k; }
  void Update(const LandingContext& context) {
    pad = context.pad;
    pull_W = context.pull_W;
    knots.Update(context, span);
  }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& t, T* u) const {
    using std::sqrt;
    const Triple<T> p = KnotPosition(q), on_pad = PadPosition(*pad, t);
    const Triple<T> d = {on_pad[0] - p[0], on_pad[1] - p[1], on_pad[2] - p[2]};
    Triple<T> f = KnotAcceleration(q, h);
    f[2] += estimation::kGravity;
    for (int c = 0; c < 3; ++c) f[c] -= pull_W[c];
    constexpr double kSmall = kSmoothedEdge * kSmoothedEdge;
    u[0] = cosine * sqrt(Dot(d, d) + kSmall) + Dot(d, f) / sqrt(Dot(f, f) + kSmall);
  }
};

}  // namespace

TermEntry PadVisibilityTerm() {
  TermEntry entry;
  entry.info = {"pad_visibility", "w sum hinge(|d| cos(half angle) + d . f / |f|)", "m",
                "docs/formulation.md", false};
  entry.parameters = {HingeWidth(0.3, "m"),
                      {"span", 3.0, 0.1, 60.0, "acts this long before arrival [s]"}};
  entry.make = [info = entry.info](const TermSetup& setup) {
    const OutOfView map{std::cos(setup.vehicle.camera_half_angle), setup.Get("span")};
    return MakeLandingTerm(info, map, setup.Hinge(), setup.segments() - 1);
  };
  return entry;
}

}  // namespace touchdown::planning
