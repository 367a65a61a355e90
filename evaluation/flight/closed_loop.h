// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "evaluation/flight/trial_record.h"
#include "evaluation/flight/trial_samples.h"
#include "evaluation/judge/trial_result.h"
#include "touchdown/evaluation/scenario/scenario.h"
#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::evaluation {

/// Flies one trial from hover to its outcome: physics and tracking at 500 Hz, mission at 100 Hz, sensors and replanning
/// at the scenario's rates. A pure function of scenario and seed, except for the result's timing, unless
/// planning.latency is `measured`. Any number may run in threads at a time.
/// @param record filled if not null.
/// @param map the map at the end, filled if not null.
/// @param samples filled, if not null, with the cost of every replanning step and depth image, and with the input of
/// the pad filter.
/// @param each_step called after every step, if set. If it throws something that is no std::exception, the flight ends.
/// Physics that fails is an outcome, `unstable`.
/// @throws BadInput if the scenario cannot be set up, std::runtime_error with the time of flight if
/// a part of the program fails.
TrialResult RunTrial(const Scenario& scenario, std::uint64_t seed, const Registries& registries,
                     TrialRecord* record = nullptr,
                     std::optional<planning::PersistentMap>* map = nullptr,
                     TrialSamples* samples = nullptr, const std::function<void()>& each_step = {});

}  // namespace touchdown::evaluation
