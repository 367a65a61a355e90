// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/studies/replan/forest_flight.h"

namespace touchdown::evaluation {

/// Flights of one planner through forests of one kind.
struct ForestFlightPart {
  ForestFlightOptions options;
  std::vector<ForestFlight> flights;

  const char* planner() const { return options.ego ? "ego" : "landing"; }
};

/// A table for people.
std::string ForestFlightText(const std::vector<ForestFlightPart>& parts);

nlohmann::ordered_json ForestFlightJson(const std::vector<ForestFlightPart>& parts);

/// Every flight as a row of an SQLite file, with a manifest. The file appears whole or not at all.
/// @throws SqliteError
void WriteForestFlights(const std::string& path, const std::vector<ForestFlightPart>& parts);

}  // namespace touchdown::evaluation
