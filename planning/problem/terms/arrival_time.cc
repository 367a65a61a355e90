// SPDX-License-Identifier: BSD-3-Clause
// Price of time, w T with T = M h, which free arrival weighs against smoothness and limits. The
// inner map is sqrt(T) under a square loss, so that least-squares backends accept it too. Not
// convex with the rest, as h is free.

#include <cmath>

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

namespace {

struct RootOfDuration {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = true;
  double segments;
  int windows() const { return 1; }
  int first_block(int /*k*/) const { return 0; }
  template <class T>
  void operator()(int /*k*/, const T* /*q*/, const T& h, const T& /*t*/, T* u) const {
    using std::sqrt;
    u[0] = sqrt(segments * h);
  }
};

}  // namespace

TermEntry ArrivalTimeTerm() {
  TermEntry entry;
  entry.info = {"arrival_time", "w T", "s^0.5", "docs/formulation.md", false};
  entry.default_weight = 30.0;
  entry.can_be_hard = false;
  entry.use = TermUse::kFreeArrival;
  entry.make = [info = entry.info](const TermSetup& setup) {
    const RootOfDuration map{static_cast<double>(setup.segments())};
    return MakeLandingTerm(info, map, solvers::SquareLoss(2.0 * setup.weight), 1);
  };
  return entry;
}

}  // namespace touchdown::planning
