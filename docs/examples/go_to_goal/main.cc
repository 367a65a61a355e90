// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that flies its reference exactly goes to a point, through a map that is filled by hand.
#include <iostream>
#include "touchdown/planning/replan/goal.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/solvers/backend_registry.h"
using namespace touchdown::planning;

int main() {
  const Eigen::Vector3d start(-4.0, 0.0, 1.5), there(4.0, 0.5, 1.2);

  OccupancyMap map{OccupancyMapOptions{}};  // rolling, 25.6 x 25.6 x 6.4 m of cells of 0.1 m
  map.Recentre(start);
  for (double y = -1.0; y <= 1.0; y += 0.1) {
    for (double z = 0.05; z < 3.0; z += 0.1) map.SetOccupied({0.0, y, z});
  }
  map.MarkRestFree();  // a plan may only rely on what was seen to be free

  Replanner planner(ReplannerOptions{}, touchdown::solvers::StandardBackends());
  planner.CommitHover(start, 0.0);
  const GoalAt goal(there);
  for (double t = 0.0; t < 20.0; t += 0.1) {
    const FlatState now = planner.Reference(t);
    if ((now.p_WB - there).norm() < 0.05 && now.v_WB.norm() < 0.05) {
      std::cout << "there after " << t << " s\n";
      return 0;
    }
    ReplanInput input;
    input.t_now = t;
    input.t_start = t + 0.02;  // flown from here on
    input.vehicle.p_WB = now.p_WB;
    input.vehicle.v_WB = now.v_WB;
    input.pad = &goal;
    input.endpoint.height = 0.0;  // the end is in the goal, not above it
    const ReplanResult& plan = planner.Replan(input, map);
    if (plan.status != ReplanStatus::kPlanned)
      std::cout << t << " s: " << Explain(plan.reason) << "\n";
  }
  return 1;
}
