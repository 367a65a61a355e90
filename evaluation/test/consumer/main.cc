// SPDX-License-Identifier: BSD-3-Clause
// Plans around nothing on an installed library: a straight spline, and the names of what it links.
#include <iostream>

#include "touchdown/planning/term_registry.h"
#include "touchdown/planning/uniform_bspline.h"
#include "touchdown/solvers/backend_registry.h"

int main() {
  namespace planning = touchdown::planning;
  planning::ControlPoints points(3, 5);
  for (int i = 0; i < 5; ++i) points.col(i) = Eigen::Vector3d(i, 0.0, 1.0);
  const planning::UniformBspline curve(points, 0.5, 0.0);
  for (const auto& entry : touchdown::solvers::StandardBackends()) std::cout << entry.name << "\n";
  for (const auto& term : planning::StandardTerms()) std::cout << term.info.name << "\n";
  // One control point a knot interval: 1 m in 0.5 s.
  return std::abs(curve.Evaluate(0.3).v_WB.x() - 2.0) < 1e-12 ? 0 : 1;
}
