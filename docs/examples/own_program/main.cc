// SPDX-License-Identifier: BSD-3-Clause
// The whole program `touchdown` with its own term. It keeps the pad's distance to every knot below
// `reach`, as seen at the knot's own time:
// u = |p(t_k) - P(t_k)|^2 / (2 reach) - reach / 2.

#include "touchdown/evaluation/program/program.h"
#include "touchdown/planning/problem/term_kinematics.h"

namespace planning = touchdown::planning;

struct TooFar {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;
  double reach;
  planning::LandingContext context = {};
  int windows() const { return context.segments - 1; }
  int first_block(int k) const { return k + 1; }
  void Update(const planning::LandingContext& now) { context = now; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& t, T* u) const {
    planning::Triple<T> d = planning::KnotPosition(q);
    const planning::Triple<T> pad = planning::PadPosition(*context.pad, t);
    for (int c = 0; c < 3; ++c) d[c] -= pad[c];
    u[0] = planning::Dot(d, d) * (0.5 / reach) - 0.5 * reach;
  }
};

int main(int argc, char** argv) {
  planning::TermEntry entry;
  entry.info = {"reach", "w sum hinge((|p - P|^2 - reach^2) / (2 reach))", "m", "this file", true};
  entry.default_weight = 10.0;
  entry.parameters = {planning::HingeWidth(1.0, "m"), {"reach", 50.0, 1.0, 1e4, "longest [m]"}};
  entry.make = [info = entry.info](const planning::TermSetup& setup) {
    const TooFar map{setup.Get("reach")};
    return planning::MakeLandingTerm(info, map, setup.Hinge(), setup.segments() - 1);
  };
  touchdown::evaluation::Registries registries = touchdown::evaluation::StandardRegistries();
  registries.terms.push_back(entry);
  return touchdown::evaluation::RunProgram(argc, argv, registries);
}
