// SPDX-License-Identifier: BSD-3-Clause
// A sphere to stay out of, evaluated at every inner knot. With its centre c and radius r
//   u = (r^2 - |p - c|^2) / (2 r).
// It is smooth everywhere, zero on the surface, and near it about the depth. Not convex. Not
// checked between the knots. Source: docs/formulation.md.

#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

struct InsideSphere {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  Eigen::Vector3d centre_W;
  double radius;
  int inner_knots;
  int windows() const { return inner_knots; }
  int first_block(int k) const { return k + 1; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    Triple<T> d = KnotPosition(q);
    for (int c = 0; c < 3; ++c) d[c] -= centre_W[c];
    u[0] = 0.5 * radius - Dot(d, d) * (0.5 / radius);
  }
};

Eigen::Vector3d CentreOf(const TermSetup& setup) {
  return {setup.Get("x"), setup.Get("y"), setup.Get("z")};
}

}  // namespace

TermEntry KeepOutTerm() {
  TermEntry entry;
  entry.info = {"keep_out", "w sum hinge((r^2 - |p - c|^2) / (2 r))", "m", "docs/formulation.md",
                false};
  entry.parameters = {HingeWidth(0.3, "m"),
                      {"x", 0.0, -1000.0, 1000.0, "of the centre in W [m]"},
                      {"y", 0.0, -1000.0, 1000.0, "of the centre in W [m]"},
                      {"z", 0.0, -1000.0, 1000.0, "of the centre in W [m]"},
                      {"radius", 1.0, 0.1, 100.0, "of the sphere [m]"}};
  entry.zones = [](const TermSetup& setup) -> std::vector<TermZone> {
    const double across = 2.0 * setup.Get("radius");
    return {{TermZone::Shape::kSphere, CentreOf(setup), Eigen::Vector3d::Constant(across)}};
  };
  entry.make = [info = entry.info](const TermSetup& setup) {
    const InsideSphere map{CentreOf(setup), setup.Get("radius"), setup.segments() - 1};
    return MakeLandingTerm(info, map, setup.Hinge(), map.windows());
  };
  return entry;
}

}  // namespace touchdown::planning
