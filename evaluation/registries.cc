// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/registries.h"

#include <set>

#include <fmt/format.h>

#include "touchdown/evaluation/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

/// Calls `see` with each part of the registries and with what it is.
template <class See>
void ForEachPart(const Registries& registries, See&& see) {
  for (const PlannerEntry& part : registries.planners) see("planner", part, !part.make);
  for (const PadMotionEntry& part : registries.pad_motions) see("pad motion", part, !part.make);
  for (const ControllerEntry& part : registries.controllers) see("controller", part, !part.make);
  for (const PredictorEntry& part : registries.predictors) see("pad predictor", part, !part.make);
}

bool Same(const Parameter& a, const Parameter& b) {
  return a.value == b.value && a.range.lo == b.range.lo && a.range.hi == b.range.hi &&
         a.range.above_lo == b.range.above_lo;
}

void RequireKey(const char* what, const std::string& part, const Parameter& parameter,
                const std::vector<Parameter>& others) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        fmt::format("{} {}: parameter {} {}", what, part, parameter.key, why));
  };
  const std::size_t dot = parameter.key.find('.');
  if (dot == 0 || dot == std::string::npos || dot + 1 == parameter.key.size()) {
    refuse("must be written GROUP.NAME");
  }
  for (const SchemaKey<Scenario>& key : ScenarioKeys()) {
    const bool below =
        key.name.starts_with(parameter.key + ".") || parameter.key.starts_with(key.name + ".");
    if (key.name == parameter.key || below) refuse("has the name of a key that there is already");
  }
  if (IsOpenGroup(parameter.key.substr(0, dot))) refuse("is in a group of others");
  for (const Parameter& other : others) {
    if (other.key == parameter.key && !Same(other, parameter)) {
      refuse("has another default or range in another part");
    }
  }
}

}  // namespace

Registries StandardRegistries() {
  return {solvers::StandardBackends(), planning::StandardTerms(), StandardPlanners(),
          StandardPadMotions(),        StandardControllers(),     StandardPredictors()};
}

std::vector<Parameter> ParametersOf(const Registries& registries) {
  std::vector<Parameter> all;
  ForEachPart(registries, [&](const char*, const Part& part, bool) {
    for (const Parameter& parameter : part.parameters) {
      const bool known = std::any_of(all.begin(), all.end(), [&](const Parameter& other) {
        return other.key == parameter.key;
      });
      if (!known) all.push_back(parameter);
    }
  });
  return all;
}

void RequireDistinct(const Registries& registries) {
  planning::RequireDistinct(registries.terms);
  const std::vector<Parameter> all = ParametersOf(registries);
  std::set<std::string> seen;
  ForEachPart(registries, [&](const char* what, const Part& part, bool nothing_to_make) {
    if (!seen.insert(what + (" " + part.name)).second) {
      throw std::invalid_argument(fmt::format("there are two of the {} {}", what, part.name));
    }
    if (nothing_to_make) {
      throw std::invalid_argument(fmt::format("{} {}: it has no function `make`", what, part.name));
    }
    for (const Parameter& parameter : part.parameters) RequireKey(what, part.name, parameter, all);
  });
}

}  // namespace touchdown::evaluation
