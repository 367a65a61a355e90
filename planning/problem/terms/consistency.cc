// SPDX-License-Identifier: BSD-3-Clause
// Stays near the previous plan: w int |p(t) - p_previous(t)|^2 dt at the same absolute times, by
// one point per knot. The previous plan goes on at its last velocity. Without a previous plan the
// term is off. Convex at fixed h. Source: docs/formulation.md.

#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

struct OffPrevious {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 3;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = true;

  const UniformBspline* previous = nullptr;
  int segments = 0;

  int windows() const { return previous ? segments - 1 : 0; }
  int first_block(int k) const { return k + 1; }
  void Update(const LandingContext& context) {
    previous = context.previous;
    segments = context.segments;
  }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& t, T* u) const {
    using std::sqrt;
    FlatState at = previous->Evaluate(ValueOf(t));
    if (const double past = ValueOf(t) - previous->t_end(); past > 0.0) {
      at.p_WB += past * at.v_WB;
      at.a_WB.setZero();
    }
    const Triple<T> p = KnotPosition(q), before = AtTime(t, at.p_WB, at.v_WB, at.a_WB);
    for (int c = 0; c < 3; ++c) u[c] = sqrt(h) * (p[c] - before[c]);
  }
};

}  // namespace

TermEntry ConsistencyTerm() {
  TermEntry entry;
  entry.info = {"consistency", "w sum h |p(t_k) - p_previous(t_k)|^2", "m s^0.5",
                "docs/formulation.md", true};
  entry.can_be_hard = false;
  entry.make = [info = entry.info](const TermSetup& setup) {
    return MakeLandingTerm(info, OffPrevious{}, solvers::SquareLoss(2.0 * setup.weight),
                           setup.segments() - 1);
  };
  return entry;
}

}  // namespace touchdown::planning
