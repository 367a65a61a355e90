// SPDX-License-Identifier: BSD-3-Clause
// From a scenario's keys to the onboard software.
#pragma once

#include <memory>

#include "touchdown/control/onboard/onboard.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// The pad filter that a scenario flies with.
estimation::PadFilterOptions PadFilterOptionsOf(const Scenario& scenario);

/// The map that a scenario's planner asks.
planning::OccupancyMapOptions MapOptions(const Scenario& scenario,
                                         const estimation::VehicleModel& model,
                                         const Registries& registries);

/// The onboard software of the scenario's vehicle. It knows only estimates. The one exception, on request of the
/// scenario, is an oracle of the pad's future, `truth`. @throws std::invalid_argument naming the file if map.prior
/// cannot be used, and if the backend cannot do what the scenario asks.
control::Onboard MakeOnboard(const Scenario& scenario, const estimation::VehicleModel& model,
                             std::shared_ptr<const sim::PadCourse> truth,
                             const Registries& registries);

}  // namespace touchdown::evaluation
