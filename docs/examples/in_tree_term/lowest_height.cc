// SPDX-License-Identifier: BSD-3-Clause
// Keeps the trajectory, except for its two ends, above a height over the ground. u = height - z for
// every control point that is free to move. Convex. Source: this example.

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

namespace {

struct BelowHeight {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  int control_points;
  double height;
  int windows() const { return control_points - 6; }  // the ends fix three on either side
  int first_block(int k) const { return k + 3; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = height - q[2];
  }
};

}  // namespace

TermEntry LowestHeightTerm() {
  TermEntry entry;
  entry.info = {"lowest_height", "w sum hinge(height - Q_z)", "m", "docs/examples", true};
  entry.parameters = {HingeWidth(0.2, "m"), {"height", 1.0, 0.0, 100.0, "above the ground [m]"}};
  entry.make = [info = entry.info](const TermSetup& setup) {
    const BelowHeight map{setup.control_points, setup.Get("height")};
    return MakeLandingTerm(info, map, setup.Hinge(), map.windows());
  };
  return entry;
}

}  // namespace touchdown::planning
