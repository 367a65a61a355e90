// SPDX-License-Identifier: BSD-3-Clause
// The planner alone, on an installed library. A wall is put into the map by hand, the pad drives
// straight, and one certified plan leads around the wall.
#include <iostream>

#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/solvers/backend_registry.h"

namespace {

/// A pad that drives along x at constant speed.
class StraightPad : public touchdown::estimation::PadPrediction {
 public:
  touchdown::estimation::PadState At(double t) const noexcept override {
    touchdown::estimation::PadState pad;
    pad.p_WP = {6.0 + 0.8 * t, 0.0, 0.5};
    pad.v_WP = {0.8, 0.0, 0.0};
    return pad;
  }
};

}  // namespace

int main() {
  namespace planning = touchdown::planning;
  const Eigen::Vector3d start(0.0, 0.0, 2.0);

  planning::OccupancyMap map{planning::OccupancyMapOptions{}};
  map.Recentre(start);
  map.MarkFree(start, 2.0);  // observed: the vehicle may move here
  for (double y = -1.0; y <= 1.0; y += 0.1) {
    for (double z = 0.05; z < 4.0; z += 0.1) map.SetOccupied({3.0, y, z});
  }

  planning::Replanner replanner(planning::ReplannerOptions{},
                                touchdown::solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  const StraightPad pad;
  planning::ReplanInput input;
  input.t_start = 0.02;  // flown from here on
  input.vehicle.p_WB = start;
  input.pad = &pad;
  input.endpoint = {.t_reference = 0.0, .height = 1.5, .height_floor = 1.5};
  const planning::ReplanResult& plan = replanner.Replan(input, map);

  std::cout << planning::ToString(plan.status) << ": " << planning::Explain(plan.reason) << "\n";
  for (double t = plan.curve.t0(); t < plan.curve.t_end(); t += 0.5) {
    std::cout << "t " << t << "  p_WB " << replanner.Reference(t).p_WB.transpose() << "\n";
  }
  return plan.status == planning::ReplanStatus::kPlanned && plan.certificate.passed() ? 0 : 1;
}
