// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/truth_map.h"

#include <cmath>

namespace touchdown::evaluation {

void ObserveTruth(const sim::ObstacleField& obstacles, const Eigen::Vector3d& drift_W,
                  planning::OccupancyMap* map) {
  map->MarkRestFree();
  const double reach = 0.5 * std::sqrt(3.0) * map->resolution();  // of a cell from its centre
  const Eigen::Vector3d around = drift_W.cwiseAbs().array() + map->resolution();
  for (const sim::Obstacle& obstacle : obstacles.obstacles()) {
    const sim::Bounds bounds = sim::BoundsOf(obstacle);
    const planning::CellIndex first = map->CellOf(bounds.min - around).cwiseMax(map->origin());
    const planning::CellIndex last =
        map->CellOf(bounds.max + around)
            .cwiseMin(map->origin() + map->size() - planning::CellIndex::Ones());
    planning::ForEachCell({first, last}, [&](const planning::CellIndex& cell) {
      if (map->IsOccupied(cell)) return;
      if (sim::SignedDistance(obstacle, map->CentreOf(cell) - drift_W) > reach) return;
      map->SetState(cell, planning::CellState::kUnknown);
    });
  }
}

}  // namespace touchdown::evaluation
