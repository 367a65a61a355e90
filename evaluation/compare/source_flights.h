// SPDX-License-Identifier: BSD-3-Clause
// Flights whose replanning steps pose the problems that solver backends are compared on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

/// A flight that can be flown with any registries: the given registries decide who observes its solves.
struct SourceFlight {
  std::string command;  ///< that flies it alone
  /// Says in a sentence how the flight differed from the file's; empty: it was the same, or nothing is known. Throws
  /// what RunTrial or a replay throws.
  std::function<std::string(const Registries& registries)> fly;
};

struct FlightSource {
  std::optional<int> flights;  ///< how many there are; none: without end
  std::function<SourceFlight(int index)> flight;
};

/// Landings without end: even ones through the scenario `forest`, odd ones in worlds of the hostile study,
/// within its assumptions. `overrides` ("solver.limits=hard") hold in all of them. The same seed and
/// index are the same flight. The source throws BadInput for an override that a flight cannot take.
FlightSource DrawnFlights(std::uint64_t seed, const std::vector<std::string>& overrides,
                          const Registries& registries);

/// The flights of a file. The steps of a record are asked again one by one, with the planner's knowledge of that time.
/// The trials of a sweep or a study are flown again from their seeds, without those that crashed, hung or ended in an
/// error. Throws BadInput with one sentence for another file, and for a flight whose plans take as long as the clock
/// says.
FlightSource FlightsOf(const std::string& path, const std::vector<std::string>& overrides,
                       const Registries& registries);

}  // namespace touchdown::evaluation
