// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/rendering/scene_mjcf.h"

namespace touchdown::sim {

/// The scene of SceneMjcf for people to watch. It has sky, sun and shadows, and a mocap body "vehicle" that looks as
/// LooksOf says. Throws as both do.
std::string FlightSceneMjcf(const VisualScene& scene, const std::string& vehicle_mjcf,
                            const ViewConfig& view);

}  // namespace touchdown::sim
