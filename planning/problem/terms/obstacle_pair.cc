// SPDX-License-Identifier: BSD-3-Clause
// The ESDF-free collision term. Every {p, v} pair is a half-space of one control point, d = (Q_i -
// p) . v >= s_f. So neither value nor gradient needs the map. Convex. X. Zhou et al.,
// "EGO-Planner", RA-L 2020, eq. 4-5.

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

namespace {

struct HalfSpaces {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;

  double clearance;
  std::span<const ObstaclePair> pairs;

  int windows() const { return static_cast<int>(pairs.size()); }
  int first_block(int k) const { return pairs[k].control_point; }
  void Update(const LandingContext& context) { pairs = context.pairs; }

  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    const ObstaclePair& pair = pairs[k];
    u[0] = clearance;
    for (int c = 0; c < 3; ++c) u[0] -= (q[c] - pair.p[c]) * pair.v[c];
  }

  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    (*this)(k, q, h, t, u);
    for (int c = 0; c < 3; ++c) du[c] = -pairs[k].v[c];
    du_dh[0] = 0.0;
  }
};

}  // namespace

TermEntry ObstaclePairTerm() {
  TermEntry entry;
  entry.info = {"obstacle_pair", "w sum hinge(s_f - (Q - p) . v)", "m", "EGO-Planner eq. 4-5",
                true};
  entry.default_weight = 3000.0;
  entry.parameters = {{"clearance", 0.30, 0.01, 5.0, "s_f, beyond the inflation radius [m]"}};
  entry.is_clearance = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    const double clearance = setup.Get("clearance");
    return MakeLandingTerm(info, HalfSpaces{clearance, {}},
                           solvers::HingeLoss(setup.weight, clearance), setup.max_pairs);
  };
  return entry;
}

}  // namespace touchdown::planning
