// SPDX-License-Identifier: BSD-3-Clause
// The one table of scenario keys, put together from its sections. Files, --set, dumps and the documentation
// all go through it; the defaults are those of a default-constructed Scenario and stand nowhere else.
#include "evaluation/scenario/scenario_schema.h"

#include <algorithm>
#include <cstring>
#include <utility>

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
    keys.push_back({parameter.key, parameter.range.unit, parameter.range.ToString(), parameter.doc,
                    [parameter](Scenario& s, const YAML::Node& n, const Where& w) {
                      s.parameters[parameter.key] =
                          ReadNumber(n, w, parameter.key, parameter.range);
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

bool IsList(const std::string& name) {
  bool found = false;
  const Scenario none;
  ForEachList(none,
              [&](const std::string& list, const auto&, const auto&) { found |= list == name; });
  return found;
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

namespace {

/// The page's sections: a heading and a table for each group of keys, in the order in which the groups first come.
class KeyTables {
 public:
  template <class Owner>
  void Add(const SchemaKey<Owner>& key, const std::string& name, const std::string& value) {
    const std::string group = GroupOf(name);
    std::string doc = key.doc;
    for (const char* begin : {"imported vehicles: ", "planner ego: ", "planner pid: "}) {
      if (NoteOf(group) != nullptr && doc.rfind(begin, 0) == 0) doc.erase(0, std::strlen(begin));
    }
    AddRow(group, name, value, key.range, doc);
  }
  void AddOpen(const std::string& name, const std::string& value, const std::string& range,
               const std::string& doc) {
    AddRow(GroupOf(name), name, value, range, doc);
  }

  std::string Text() const {
    std::string text;
    for (const auto& [group, rows] : groups_) {
      const char* note = NoteOf(group);
      text +=
          fmt::format("{}## {}\n\n{}| key | default | allowed | meaning |\n|---|---|---|---|\n{}",
                      text.empty() ? "" : "\n", group,
                      note == nullptr ? "" : fmt::format("{}\n\n", note), rows);
    }
    return text;
  }

 private:
  static std::string GroupOf(const std::string& name) {
    const std::size_t dot = name.find('.');
    return dot == std::string::npos ? "flight" : name.substr(0, dot);
  }

  static const char* NoteOf(const std::string& group) {
    if (group == "airframe") return "Imported vehicles only.";
    if (group == "ego") return "Only with `planner: ego` or `planner: ego-velocity`.";
    if (group == "pid") return "Only with `planner: pid`.";
    return nullptr;
  }

  void AddRow(const std::string& group, const std::string& name, const std::string& value,
              const std::string& range, const std::string& doc) {
    auto at = std::find_if(groups_.begin(), groups_.end(),
                           [&group](const auto& named) { return named.first == group; });
    if (at == groups_.end()) at = groups_.insert(at, {group, ""});
    at->second += fmt::format("| `{}` | {} | {} | {} |\n", name, value, range, doc);
  }

  std::vector<std::pair<std::string, std::string>> groups_;  // heading, rows
};

}  // namespace

std::string ScenarioKeysMarkdown(const Registries& registries) {
  const Scenario defaults;
  KeyTables tables;
  for (const SchemaKey<Scenario>& key : ScenarioKeys(registries)) {
    tables.Add(key, key.name, fmt::format("`{}`", key.get(defaults)));
  }
  tables.AddOpen("solver.options.<name>", "the backend's", "as `touchdown list backends` says",
                 "an option of the backend");
  tables.AddOpen("terms.<term>.weight", "as `touchdown list terms` says", "[0, 1e9]",
                 "0 switches the term off, a positive weight on");
  tables.AddOpen("terms.<term>.hard", "by solver.limits", "true or false",
                 "the term as constraints instead of a cost");
  tables.AddOpen("terms.<term>.<parameter>", "the term's", "as `touchdown list terms --json` says",
                 "a parameter of the term");
  const Scenario none;
  ForEachList(none, [&tables](const std::string& list, const auto& elements, const auto& keys) {
    const typename std::decay_t<decltype(elements)>::value_type element;
    for (const auto& key : keys) {
      tables.Add(key, fmt::format("{}[].{}", list, key.name),
                 key.optional ? fmt::format("`{}`", key.get(element)) : "required");
    }
  });
  return tables.Text();
}

}  // namespace touchdown::evaluation
