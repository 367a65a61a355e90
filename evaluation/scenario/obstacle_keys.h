// SPDX-License-Identifier: BSD-3-Clause
// The lists in a scenario, each once: its name, its elements, their keys.
#pragma once

#include <string>
#include <vector>

#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation {

template <typename Element>
using ElementKeys = std::vector<SchemaKey<Element>>;

const ElementKeys<BoxObstacle>& BoxKeys();
const ElementKeys<CylinderObstacle>& CylinderKeys();
const ElementKeys<SphereObstacle>& SphereKeys();
const ElementKeys<WallObstacle>& WallKeys();
const ElementKeys<MeshObstacle>& MeshKeys();
const ElementKeys<HeightFieldObstacle>& HeightFieldKeys();
const ElementKeys<OctomapObstacle>& OctomapKeys();
const ElementKeys<DepthMount>& DepthMountKeys();

/// Calls `visit(name, elements, keys)` for each list, in the order of the obstacles. `scenario` may be const.
template <typename AScenario, typename Visit>
void ForEachObstacleList(AScenario& scenario, Visit&& visit) {
  visit("obstacles.boxes", scenario.boxes, BoxKeys());
  visit("obstacles.cylinders", scenario.cylinders, CylinderKeys());
  visit("obstacles.spheres", scenario.spheres, SphereKeys());
  visit("obstacles.walls", scenario.walls, WallKeys());
  visit("obstacles.meshes", scenario.meshes, MeshKeys());
  visit("obstacles.height_fields", scenario.height_fields, HeightFieldKeys());
  visit("obstacles.octomaps", scenario.octomaps, OctomapKeys());
}

/// The same for every list.
template <typename AScenario, typename Visit>
void ForEachList(AScenario& scenario, Visit&& visit) {
  visit("depth.cameras", scenario.depth.cameras, DepthMountKeys());
  ForEachObstacleList(scenario, visit);
}

}  // namespace touchdown::evaluation
