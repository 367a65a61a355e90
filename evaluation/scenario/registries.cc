// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/registries.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "evaluation/base/words.h"
#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

/// Calls `see` with each part of the registries and its kind.
template <class See>
void ForEachPart(const Registries& registries, See&& see) {
  for (const PlannerEntry& part : registries.planners) see("planner", part, !part.make);
  for (const PadMotionEntry& part : registries.pad_motions) see("pad motion", part, !part.make);
  for (const ControllerEntry& part : registries.controllers) see("controller", part, !part.make);
  for (const PredictorEntry& part : registries.predictors) see("pad predictor", part, !part.make);
}

bool IsWord(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

bool Same(const Parameter& a, const Parameter& b) {
  return a.value == b.value && a.range.lo == b.range.lo && a.range.hi == b.range.hi &&
         a.range.above_lo == b.range.above_lo && a.range.unit == b.range.unit;
}

void RequireKey(const char* what, const std::string& part, const Parameter& parameter,
                const std::vector<Parameter>& others) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        fmt::format("{} {}: parameter {} {}", what, part, parameter.key, why));
  };
  const std::vector<std::string> words = Split(parameter.key, '.');
  if (words.size() < 2 || !std::all_of(words.begin(), words.end(), IsWord)) {
    refuse("must be written GROUP.NAME, of letters, digits, _ and -");
  }
  for (const SchemaKey<Scenario>& key : ScenarioKeys()) {
    const bool below =
        key.name.starts_with(parameter.key + ".") || parameter.key.starts_with(key.name + ".");
    if (key.name == parameter.key || below) refuse("has the name of a key that there is already");
  }
  for (std::size_t end = parameter.key.find('.'); end != std::string::npos;
       end = parameter.key.find('.', end + 1)) {
    const std::string group = parameter.key.substr(0, end);
    if (group == "obstacles" || IsOpenGroup(group)) refuse("is in a group of others");
  }
  const ValueRange& range = parameter.range;
  const double value = parameter.value;
  const bool in_range =
      (range.above_lo ? value > range.lo : value >= range.lo) && value <= range.hi;
  if (!in_range || !std::isfinite(value)) {
    refuse(fmt::format("has the default {}, which is not in {}", value, range.ToString()));
  }
  for (const Parameter& other : others) {
    if (other.key == parameter.key && !Same(other, parameter)) {
      refuse("is given twice, with another default or range");
    }
    if (other.key.starts_with(parameter.key + ".")) refuse("is the group of " + other.key);
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
  for (const PlannerEntry& entry : registries.planners) {
    if (entry.rate >= 0.0 && std::isfinite(entry.rate)) continue;
    throw std::invalid_argument(
        fmt::format("planner {}: its rate is {}, it must be >= 0 Hz", entry.name, entry.rate));
  }
  std::set<std::string> seen;
  ForEachPart(registries, [&](const char* what, const Part& part, bool nothing_to_make) {
    if (!seen.insert(what + (" " + part.name)).second) {
      throw std::invalid_argument(fmt::format("there are two of the {} {}", what, part.name));
    }
    if (!IsWord(part.name)) {
      throw std::invalid_argument(
          fmt::format("{} '{}': its name must be of letters, digits, _ and -", what, part.name));
    }
    if (nothing_to_make) {
      throw std::invalid_argument(fmt::format("{} {}: it has no function `make`", what, part.name));
    }
    for (const Parameter& parameter : part.parameters) RequireKey(what, part.name, parameter, all);
  });
}

}  // namespace touchdown::evaluation
