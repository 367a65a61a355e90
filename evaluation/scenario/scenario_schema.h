// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scenario/scenario_value.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// One key of a scenario file or of an obstacle in it: everything known about it, once.
template <typename Owner>
struct SchemaKey {
  std::string name;   ///< dotted, "pad.speed"
  std::string unit;   ///< empty: none
  std::string range;  ///< allowed values in words, with their unit
  std::string doc;    ///< one line
  /// Reads the value into its member. @throws BadInput
  std::function<void(Owner&, const YAML::Node&, const Where&)> set;
  /// The member as YAML flow text that `set` reads back.
  std::function<std::string(const Owner&)> get;
  bool optional = false;  ///< in an element of a list
};

/// Every scalar and vector key of the program itself, in the order of documentation and of a dump.
const std::vector<SchemaKey<Scenario>>& ScenarioKeys();
/// These, and behind them those of the parts' parameters.
std::vector<SchemaKey<Scenario>> ScenarioKeys(const Registries& registries);
/// The key called `name`: from `keys`, the list above, or an open key: solver.options.<name> and terms.<term>.<key>.
/// Backends and terms know the names and ranges of open keys (CheckScenario asks them). Open keys have no `get`.
std::optional<SchemaKey<Scenario>> FindScenarioKey(const std::string& name,
                                                   const std::vector<SchemaKey<Scenario>>& keys);

/// It is one of the lists (obstacle_keys.h).
bool IsList(const std::string& name);

/// `name` groups open keys.
bool IsOpenGroup(const std::string& name);
/// The parameters and the open keys that are set, as lines of YAML.
std::string DumpOpenKeys(const Scenario& scenario);

/// The schema as Markdown tables by group: docs/reference/scenario_keys.md has this text, a test compares.
std::string ScenarioKeysMarkdown(const Registries& registries);

}  // namespace touchdown::evaluation
