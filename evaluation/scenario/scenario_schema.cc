// SPDX-License-Identifier: BSD-3-Clause
// The one table of scenario keys, put together from its sections. Files, --set, dumps and the documentation
// all go through it; the defaults are those of a default-constructed Scenario and stand nowhere else.
#include "evaluation/scenario/scenario_schema.h"

#include <fmt/format.h>

#include "evaluation/base/words.h"
#include "evaluation/scenario/obstacle_keys.h"
#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation {

const std::vector<SchemaKey<Scenario>>& ScenarioKeys() {
  static const std::vector<SchemaKey<Scenario>> keys = [] {
    schema::KeyList list;
    schema::AddDescription(list);
    schema::AddPadKeys(list);
    schema::AddVehicleKeys(list);
    schema::AddAirKeys(list);
    schema::AddSensorKeys(list);
    schema::AddOwnStateKeys(list);
    schema::AddTaskKeys(list);
    schema::AddPlanningKeys(list);
    schema::AddTrialKeys(list);
    return list;
  }();
  return keys;
}

namespace {

/// The names of a registry are what the key may be.
template <class Entry>
void Offer(const std::string& name, const std::vector<Entry>& registry,
           std::vector<SchemaKey<Scenario>>* keys) {
  const std::vector<std::string> names = NamesOf(registry);
  for (SchemaKey<Scenario>& key : *keys) {
    if (key.name != name) continue;
    key.type = "choice";
    key.range = Enumerate(names);
    for (const Part& part : registry) key.doc += fmt::format("; {}: {}", part.name, part.summary);
    key.set = [name, names, take = key.set](Scenario& s, const YAML::Node& n, const Where& w) {
      ReadChoice(n, w, name, names);
      take(s, n, w);
    };
  }
}

}  // namespace

std::vector<SchemaKey<Scenario>> ScenarioKeys(const Registries& registries) {
  std::vector<SchemaKey<Scenario>> keys = ScenarioKeys();
  Offer("planner", registries.planners, &keys);
  Offer("pad.motion", registries.pad_motions, &keys);
  Offer("controller", registries.controllers, &keys);
  Offer("pad.prediction", registries.predictors, &keys);
  for (const Parameter& parameter : ParametersOf(registries)) {
    keys.push_back(
        {parameter.key, "number", parameter.range.unit, parameter.range.ToString(), parameter.doc,
         [parameter](Scenario& s, const YAML::Node& n, const Where& w) {
           s.parameters[parameter.key] = ReadNumber(n, w, parameter.key, parameter.range);
         },
         [parameter](const Scenario& s) {
           const auto given = s.parameters.find(parameter.key);
           const bool is_given = given != s.parameters.end();
           return WriteNumber(is_given ? given->second : parameter.value);
         }});
  }
  return keys;
}

namespace {

/// `name` behind `prefix`, split at its dots.
std::vector<std::string> Behind(const std::string& prefix, const std::string& name) {
  if (name.rfind(prefix, 0) != 0) return {};
  return Split(name.substr(prefix.size()), '.');
}

// Their ranges are the registries': scenario_check asks them.
const ValueRange kAnyNumber = {-1e300, 1e300, false, ""};

std::optional<SchemaKey<Scenario>> FindOpenKey(const std::string& name) {
  SchemaKey<Scenario> key;
  key.name = name;
  if (const auto words = Behind("solver.options.", name); words.size() == 1) {
    key.set = [=](Scenario& s, const YAML::Node& n, const Where& w) {
      s.solver.options[words[0]] = ReadNumber(n, w, name, kAnyNumber);
    };
    return key;
  }
  const auto words = Behind("terms.", name);
  if (words.size() != 2) return std::nullopt;
  key.set = [=](Scenario& s, const YAML::Node& n, const Where& w) {
    s.terms[words[0]][words[1]] =
        words[1] == "hard" ? ReadBool(n, w, name) : ReadNumber(n, w, name, kAnyNumber);
  };
  return key;
}

}  // namespace

std::optional<SchemaKey<Scenario>> FindScenarioKey(const std::string& name,
                                                   const std::vector<SchemaKey<Scenario>>& keys) {
  for (const SchemaKey<Scenario>& key : keys) {
    if (key.name == name) return key;
  }
  return FindOpenKey(name);
}

bool IsOpenGroup(const std::string& name) {
  return name == "solver.options" || name == "terms" || Behind("terms.", name).size() == 1;
}

std::string DumpOpenKeys(const Scenario& scenario) {
  std::string text;
  for (const auto& [key, value] : scenario.parameters) {
    text += key + ": " + WriteNumber(value) + "\n";
  }
  for (const auto& [name, value] : scenario.solver.options) {
    text += "solver.options." + name + ": " + WriteNumber(value) + "\n";
  }
  for (const auto& [term, keys] : scenario.terms) {
    for (const auto& [key, value] : keys) {
      const std::string written =
          key != "hard" ? WriteNumber(value) : (value != 0.0 ? "true" : "false");
      text += "terms." + term + "." + key + ": " + written + "\n";
    }
  }
  return text;
}

std::string ScenarioKeysMarkdown(const Registries& registries) {
  const Scenario defaults;
  std::string text =
      "| key | type | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const SchemaKey<Scenario>& key : ScenarioKeys(registries)) {
    text += fmt::format("| `{}` | {} | {} | {} | `{}` | {} |\n", key.name, key.type, key.unit,
                        key.range, key.get(defaults), key.doc);
  }
  text +=
      "| `solver.options.<name>` | number |  | as `touchdown list backends` says | the backend's | "
      "an option of the backend |\n"
      "| `terms.<term>.weight` | number |  | [0, 1e9] | as `touchdown list terms` says | 0 "
      "switches "
      "the term off, a positive weight on |\n"
      "| `terms.<term>.hard` | true or false |  | true or false | by solver.limits | the term as "
      "constraints instead of a cost |\n"
      "| `terms.<term>.<parameter>` | number |  | as `touchdown list terms --json` says | the "
      "term's | a parameter of the term |\n";
  const Scenario none;
  ForEachObstacleList(none, [&text](const std::string& list, const auto& elements,
                                    const auto& keys) {
    const typename std::decay_t<decltype(elements)>::value_type element;
    for (const auto& key : keys) {
      const std::string value = key.optional ? fmt::format("`{}`", key.get(element)) : "required";
      text += fmt::format("| `{}[].{}` | {} | {} | {} | {} | {} |\n", list, key.name, key.type,
                          key.unit, key.range, value, key.doc);
    }
  });
  return text;
}

}  // namespace touchdown::evaluation
