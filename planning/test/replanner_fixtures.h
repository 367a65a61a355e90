// SPDX-License-Identifier: BSD-3-Clause
// A replanner over random pillars, shared by its tests.
#pragma once

#include <limits>

#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {

/// A map of observed free space with random pillars between start and pad.
inline OccupancyMap ObservedMap(double inflation = 0.35) {
  OccupancyMapOptions options;
  options.inflation_radius = inflation;
  OccupancyMap map(options);
  map.MarkFree(Eigen::Vector3d(0, 0, 0), 11.0);
  return map;
}

inline void AddPillar(const Eigen::Vector2d& at, OccupancyMap* map) {
  for (double dx = -0.25; dx <= 0.3; dx += 0.1) {
    for (double dy = -0.25; dy <= 0.3; dy += 0.1) {
      for (double z = 0.05; z < 3.1; z += 0.1) map->SetOccupied({at.x() + dx, at.y() + dy, z});
    }
  }
}

inline ReplannerOptions Options(ArrivalMode arrival) {
  ReplannerOptions options;
  options.arrival = arrival;
  return options;
}

/// Flying at v_WB since before t = 0.
inline void FlyAlong(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& v_WB,
                     Replanner* replanner) {
  ControlPoints points(3, 8);
  for (int i = 0; i < 8; ++i) points.col(i) = p_WB + (i - 3) * v_WB;
  ReplannerState state = replanner->state();
  state.current.curve = state.next.curve = UniformBspline(points, 1.0, -2.0);
  state.current.t_stop = state.next.t_stop = std::numeric_limits<double>::infinity();
  replanner->Restore(state);
}

inline ReplanInput Input(const Eigen::Vector3d& p_WB, const estimation::PadPrediction& pad,
                         double t) {
  ReplanInput input;
  input.t_now = t;
  input.t_start = t + 0.02;
  input.vehicle.t = t;
  input.vehicle.p_WB = p_WB;
  input.pad = &pad;
  input.endpoint = {t, 1.3, 0.0, 1.3};
  return input;
}

}  // namespace touchdown::planning
