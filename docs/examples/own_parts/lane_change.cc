// SPDX-License-Identifier: BSD-3-Clause
// A chain of stretches whose curvature is linear in the way, so that position, heading and curvature
// are continuous. Source: this example.

#include "lane_change.h"

namespace own {

touchdown::sim::CurvatureChain LaneChange(const Eigen::Vector2d& start, double heading,
                                          const LaneChangeTurns& turns) {
  touchdown::sim::CurvatureChain chain(start, heading);
  chain.Append(turns.after, 0.0, 0.0);
  const double held = turns.angle / turns.curvature - turns.ramp;
  for (const double curvature : {turns.curvature, -turns.curvature}) {
    chain.Append(turns.ramp, 0.0, curvature);
    chain.Append(held, curvature, curvature);
    chain.Append(turns.ramp, curvature, 0.0);
  }
  chain.Append(0.0, 0.0, 0.0);
  return chain;
}

}  // namespace own
