// SPDX-License-Identifier: BSD-3-Clause
// What planners, pad motions, controllers and pad predictors have in common. Each has a name, by which a scenario
// chooses it, and numbers of its own in the scenario.
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/evaluation/base/value_range.h"

namespace touchdown::evaluation {

struct Scenario;
struct Registries;

/// A number that a scenario may give to a part.
struct Parameter {
  std::string key;     ///< of the scenario, in a group: "ego.horizon"
  double value = 0.0;  ///< default
  ValueRange range;
  std::string doc;  ///< one line
};

/// What every entry of a registry gives.
struct Part {
  std::string name;     ///< the word in a scenario
  std::string summary;  ///< one line of `touchdown list`
  std::vector<Parameter>
      parameters;  ///< several parts may share one, then with the same default and range
};

/// What a part is made from. It is valid while the part is made.
struct PartSetup {
  const Scenario& scenario;
  std::span<const Parameter> parameters;

  /// The value that the scenario gives to a parameter of the part, or its default.
  /// Throws std::invalid_argument if the part has none with this key.
  double Get(std::string_view key) const;
};

/// A number of some options as a parameter: its default is theirs.
template <class Options>
struct OptionKey {
  std::string key;
  double& (*of)(Options& options);
  ValueRange range;
  std::string doc;
};

template <class Options>
std::vector<Parameter> ParametersOf(const std::vector<OptionKey<Options>>& keys) {
  Options defaults;
  std::vector<Parameter> parameters;
  for (const OptionKey<Options>& key : keys) {
    parameters.push_back({key.key, key.of(defaults), key.range, key.doc});
  }
  return parameters;
}

/// Sets each number to what the scenario says.
template <class Options>
void Set(const PartSetup& setup, const std::vector<OptionKey<Options>>& keys, Options* options) {
  for (const OptionKey<Options>& key : keys) key.of(*options) = setup.Get(key.key);
}

/// The names of a registry.
template <class Entry>
std::vector<std::string> NamesOf(const std::vector<Entry>& registry) {
  std::vector<std::string> names;
  for (const Part& part : registry) names.push_back(part.name);
  return names;
}

/// nullptr: there is none of that name.
template <class Entry>
const Entry* FindPart(const std::vector<Entry>& registry, std::string_view name) {
  const auto has_name = [&](const Entry& entry) { return entry.name == name; };
  const auto found = std::find_if(registry.begin(), registry.end(), has_name);
  return found == registry.end() ? nullptr : &*found;
}

/// Throws std::invalid_argument if there is none. `what`: a planner, ...
template <class Entry>
const Entry& PartNamed(const std::vector<Entry>&& registry, std::string_view name,
                       const char* what) = delete;  // it would dangle
template <class Entry>
const Entry& PartNamed(const std::vector<Entry>& registry, std::string_view name,
                       const char* what) {
  if (const Entry* entry = FindPart(registry, name)) return *entry;
  throw std::invalid_argument(std::string("there is no ") + what + " " + std::string(name));
}

/// What an entry makes. Throws std::invalid_argument if that is nothing. `what`: a planner, ...
template <class Entry, class Setup>
auto MadeBy(const Entry& entry, const Setup& setup, const char* what) {
  auto made = entry.make(setup);
  if (made) return made;
  throw std::invalid_argument(std::string("the ") + what + " " + entry.name + " made nothing");
}

}  // namespace touchdown::evaluation
