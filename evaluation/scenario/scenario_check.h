// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/scenario/scenario_value.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// A scenario with the place each of its values came from.
struct ScenarioSource {
  Scenario scenario;
  std::string file;
  std::map<std::string, Where> where;  ///< by key, "obstacles.boxes[2]" for list elements

  /// Where `key` was set; the file as a whole if it has its default.
  Where WhereOf(const std::string& key) const;
};

/// Checks what no single key shows. Refused are:
/// - obstacles or the pad on the start, obstacles on the pad's way, a goal in an obstacle or beyond floor and ceiling;
/// - a GPS outage that ends before it begins, a latency beyond the replanning period;
/// - a deck smaller than the sheet that the camera must see on it;
/// - a clearance below the hull, a ceiling below what is flown;
/// - a vehicle file or map file that cannot be read;
/// - an airframe or a wind direction without effect;
/// - a backend, term, option or parameter that the registries do not know or allow;
/// - a formulation that the backend refuses.
/// A pad faster than the vehicle is not refused: the flight shows the consequence. @throws BadInput
void CheckScenario(const ScenarioSource& source, const Registries& registries);

/// Checks that images of the pad can be made: there is room for its printed sheet. @param where begins the sentence.
/// @param with what makes them. @throws BadInput
void RequireSheetRoom(const Scenario& scenario, const std::string& where, const std::string& with);

/// A term by its name. Throws std::invalid_argument suggesting the right name.
const planning::TermEntry& TermNamed(const planning::TermRegistry& terms, const std::string& name);

}  // namespace touchdown::evaluation
