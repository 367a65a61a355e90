// SPDX-License-Identifier: BSD-3-Clause
// Smoothness: the exact integral of |a|^2 + w_j |j|^2 over a uniform cubic B-spline, one window of
// four control points per segment. Convex at fixed h.

#include "planning/problem/terms/smoothness.h"

namespace touchdown::planning {

TermEntry SmoothnessTerm() {
  TermEntry entry;
  entry.info = {"smoothness", "w int (|a|^2 + w_j |j|^2) dt", "m/s^1.5", "paper eq. 15", true};
  entry.default_weight = 1.0;
  entry.parameters = {
      {"jerk", 0.1, 0.0, 1e3, "w_j, of the jerk relative to the acceleration [s^2]"}};
  entry.can_be_hard = false;
  entry.make = [info = entry.info](const TermSetup& setup) {
    // The square loss is w u^2 / 2; the integral wants w u^2.
    return MakeLandingTerm(info, SegmentDerivatives(setup.segments(), setup.Get("jerk")),
                           solvers::SquareLoss(2.0 * setup.weight), setup.segments());
  };
  return entry;
}

}  // namespace touchdown::planning
