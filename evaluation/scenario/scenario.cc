// SPDX-License-Identifier: BSD-3-Clause
// Reading and writing scenario files. The YAML tree is walked once, and every leaf is looked up in
// the schema by its dotted name. A name that the schema does not know is refused with its file and
// line.
#include "touchdown/evaluation/scenario/scenario.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/base/words.h"
#include "evaluation/scenario/obstacle_keys.h"
#include "evaluation/scenario/scenario_check.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/scenario/yaml_text.h"

namespace touchdown::evaluation {
namespace {

using Keys = std::vector<SchemaKey<Scenario>>;

constexpr char kObstacles[] = "obstacles";
constexpr char kNoText[] = "\"\"";

class Reader {
 public:
  /// `file` stands in every sentence; `lines`: with the line.
  Reader(ScenarioSource* source, std::string file, bool lines, const Keys& keys)
      : source_(source), file_(std::move(file)), lines_(lines), keys_(keys) {}

  void Read(const YAML::Node& root) { ReadMap(root, "", WhereIs(root)); }

  void ReadMap(const YAML::Node& node, const std::string& prefix, const Where& place) {
    if (!node.IsMap()) {
      throw BadInput(fmt::format("{}: {} must be a map of keys.", place.ToString(),
                                 prefix.empty() ? "a scenario" : prefix));
    }
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const Where where = WhereIs(entry.first);
      const std::string key = KeyText(entry.first);
      const std::string name = prefix.empty() ? key : prefix + "." + key;
      if (!seen.insert(name).second) {
        throw BadInput(fmt::format("{}: {} is given twice.", where.ToString(), name));
      }
      ReadEntry(name, entry.second, where);
    }
  }

  void ReadEntry(const std::string& name, const YAML::Node& value, const Where& where) {
    if (lines_ && source_->where.count(name) != 0) {
      throw BadInput(fmt::format("{}: {} is given twice.", where.ToString(), name));
    }
    if (const auto key = FindScenarioKey(name, keys_)) {
      key->set(source_->scenario, value, where);
      source_->where[name] = where;
    } else if (ReadLists(name, value, where)) {
      return;
    } else if (IsGroup(name)) {
      ReadMap(value, name, where);
    } else {
      throw BadInput(fmt::format("{}: unknown key {}{}.", where.ToString(), name, Suggest(name)));
    }
  }

 private:
  bool ReadLists(const std::string& name, const YAML::Node& value, const Where& where) {
    bool found = false;
    ForEachList(source_->scenario, [&](const std::string& list, auto& elements, const auto& keys) {
      if (list != name) return;
      ReadList(name, value, where, keys, &elements);
      found = true;
    });
    return found;
  }

  Where WhereIs(const YAML::Node& node) const {
    return {file_, lines_ && node.Mark().line >= 0 ? node.Mark().line + 1 : 0};
  }

  // YAML allows lists and maps as keys.
  std::string KeyText(const YAML::Node& key) const {
    if (!key.IsScalar()) RefuseValue(WhereIs(key), "a key", "a text", key);
    return key.Scalar();
  }

  bool IsGroup(const std::string& name) const {
    if (name == kObstacles || IsOpenGroup(name)) return true;
    return std::any_of(keys_.begin(), keys_.end(),
                       [&](const auto& key) { return key.name.rfind(name + ".", 0) == 0; });
  }

  // The keys of the same group, or the groups: the alternatives at this place. A near name may be in another group.
  std::string Suggest(const std::string& name) const {
    const std::size_t dot = name.rfind('.');
    const std::string group = dot == std::string::npos ? "" : name.substr(0, dot + 1);
    std::vector<std::string> words;
    for (const auto& key : keys_) {
      if (key.name.rfind(group, 0) != 0) continue;
      const std::string word = key.name.substr(0, key.name.find('.', group.size()));
      if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
    }
    if (group.empty()) words.insert(words.end(), {"terms", kObstacles});
    if (group == std::string(kObstacles) + ".") {
      ForEachObstacleList(source_->scenario, [&](const std::string& list, const auto&,
                                                 const auto&) { words.push_back(list); });
    }
    if (DidYouMean(name, words).empty()) {
      std::vector<std::string> all;
      for (const auto& key : keys_) all.push_back(key.name);
      const std::string meant = DidYouMean(name, all);
      if (!meant.empty()) return meant;
    }
    if (words.empty()) return "; `docs/reference/scenario_keys.md` lists the keys";
    return Instead(name, words, "allowed here:");
  }

  template <typename Element>
  void ReadList(const std::string& name, const YAML::Node& list, const Where& where,
                const std::vector<SchemaKey<Element>>& keys, std::vector<Element>* elements) {
    if (!list.IsSequence()) RefuseValue(where, name, "a list", list);
    elements->clear();
    for (std::size_t i = 0; i < list.size(); ++i) {
      const YAML::Node& node = list[i];
      const std::string label = fmt::format("{}[{}]", name, i);
      const Where here = WhereIs(node);
      if (!node.IsMap()) RefuseValue(here, label, "a map of keys", node);
      Element element;
      std::set<std::string> seen;
      for (const auto& entry : node) {
        const std::string key = KeyText(entry.first);
        ReadElementKey(keys, key, entry.second, WhereIs(entry.first), label, &element);
        seen.insert(key);
      }
      for (const auto& key : keys) {
        if (!key.optional && seen.count(key.name) == 0) {
          throw BadInput(fmt::format("{}: {} lacks the key {}.", here.ToString(), label, key.name));
        }
      }
      elements->push_back(element);
      source_->where[label] = here;
    }
  }

  template <typename Element>
  static void ReadElementKey(const std::vector<SchemaKey<Element>>& keys, const std::string& name,
                             const YAML::Node& value, const Where& where, const std::string& label,
                             Element* element) {
    std::vector<std::string> words;
    for (const auto& key : keys) {
      if (key.name == name) return key.set(*element, value, where);
      words.push_back(key.name);
    }
    throw BadInput(fmt::format("{}: unknown key {}.{}{}.", where.ToString(), label, name,
                               Instead(name, words, "allowed here:")));
  }

  ScenarioSource* source_;
  std::string file_;
  bool lines_;
  const Keys& keys_;
};

void ApplyOverride(const std::string& text, const Keys& keys, ScenarioSource* source) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw BadInput(fmt::format("--set {}: write KEY=VALUE, without a space.", text));
  }
  const std::string name = text.substr(0, equals);
  const std::size_t bracket = name.find('[');
  if (bracket != std::string::npos && bracket > 0) {
    throw BadInput(fmt::format("--set {}: a list is set as a whole: {}=[...].", text,
                               name.substr(0, bracket)));
  }
  const std::string file = "--set " + text;
  const YAML::Node value = ParseYaml(text.substr(equals + 1), file, false);
  Where where;
  where.file = file;
  Reader(source, file, false, keys).ReadEntry(name, value, where);
}

// Reads the airframe file beside a vehicle's file, for keys that the scenario does not set: FILE.airframe.yaml beside
// FILE.xml, with the keys of `airframe`.
void ReadAirframe(const Keys& keys, ScenarioSource* source) {
  const std::string path = AirframeFile(source->scenario.vehicle);
  if (path.empty()) return;
  const YAML::Node root = ReadYamlFile(path, "airframe");
  ScenarioSource beside;
  beside.scenario = source->scenario;
  Reader(&beside, path, true, keys).ReadMap(root, "airframe", Where{path, 0});
  for (const auto& key : keys) {
    const auto said = beside.where.find(key.name);
    if (said == beside.where.end() || source->where.count(key.name) != 0) continue;
    key.set(source->scenario, ParseYaml(key.get(beside.scenario), path), said->second);
    source->where.insert(*said);
  }
}

// Sets defaults that depend on other keys. A planner whose plans do not lead to contact gets the vertical descent.
// Plans to contact get a free arrival, others a fixed one. If the wind's direction is given, it is not drawn.
void SuitDefaults(const Registries& registries, ScenarioSource* source) {
  Scenario& s = source->scenario;
  const auto given = [source](const char* key) { return source->where.count(key) != 0; };
  const PlannerEntry* planner = FindPart(registries.planners, s.planner);
  s.own_solver = planner ? planner->solver : "";
  if (!given("descent") && planner && !planner->lands) s.descent = DescentKind::kVertical;
  if (!given("solver.arrival")) {
    s.solver.arrival = PlansContact(s) ? ArrivalKind::kFree : ArrivalKind::kFixed;
  }
  const auto fill = [&s](const auto& registry, const std::string& name) {
    const Part* part = FindPart(registry, name);
    if (part == nullptr) return;
    for (const Parameter& parameter : part->parameters) {
      s.parameters.emplace(parameter.key, parameter.value);
    }
  };
  fill(registries.planners, s.planner);
  fill(registries.pad_motions, s.pad.motion);
  fill(registries.controllers, s.controller);
  fill(registries.predictors, s.pad.prediction);
  if (given("wind.direction_deg") && !given("wind.direction_random")) {
    s.wind.direction_random = false;
  }
}

Scenario Complete(const YAML::Node& root, const std::string& name, const std::string& file,
                  const std::vector<std::string>& overrides, const Registries& registries) {
  ScenarioSource source;
  source.scenario.name = name;
  source.file = file;
  const Keys keys = ScenarioKeys(registries);
  Reader(&source, file, true, keys).Read(root);
  for (const std::string& text : overrides) ApplyOverride(text, keys, &source);
  ReadAirframe(keys, &source);
  SuitDefaults(registries, &source);
  CheckScenario(source, registries);
  return source.scenario;
}

}  // namespace

std::string AirframeFile(const std::string& vehicle) {
  if (vehicle == "default") return "";
  const std::string path =
      std::filesystem::path(vehicle).replace_extension(".airframe.yaml").string();
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) ? path : "";
}

Scenario UncheckedVehicleScenario(const std::string& vehicle,
                                  const std::vector<std::string>& overrides,
                                  const Registries& registries) {
  ScenarioSource source;
  source.scenario.vehicle = vehicle;
  const Keys keys = ScenarioKeys(registries);
  for (const std::string& text : overrides) ApplyOverride(text, keys, &source);
  ReadAirframe(keys, &source);
  return source.scenario;
}

void ApplyOverride(const std::string& text, const Registries& registries, Scenario* scenario) {
  ScenarioSource source;
  source.scenario = *scenario;
  const Keys keys = ScenarioKeys(registries);
  ApplyOverride(text, keys, &source);
  if (source.where.count("vehicle") != 0) ReadAirframe(keys, &source);
  *scenario = std::move(source.scenario);
}

Scenario::Scenario() = default;

const char* ToString(TaskKind kind) {
  if (kind == TaskKind::kGoTo) return "go_to";
  return kind == TaskKind::kFollow ? "follow" : "land";
}

const char* ToString(DescentKind kind) {
  return kind == DescentKind::kVertical ? "vertical" : "planned";
}

Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides,
                      const Registries& registries) {
  if (IsSqliteFile(path)) {
    throw BadInput(
        fmt::format("{}: that is a result file and no scenario; a flight's record is shown by "
                    "`touchdown replay`.",
                    path));
  }
  return Complete(ReadYamlFile(path, "scenario"), std::filesystem::path(path).stem().string(), path,
                  overrides, registries);
}

Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& file,
                       const std::vector<std::string>& overrides, const Registries& registries) {
  return Complete(ParseYaml(text, file), name, file, overrides, registries);
}

namespace {

template <typename Element>
std::string ListText(const std::string& name, const std::string& indent,
                     const std::vector<Element>& elements, const ElementKeys<Element>& keys) {
  if (elements.empty()) return {};
  std::string text = indent + name + ":\n";
  const Element usual;
  for (const Element& element : elements) {
    std::string line;
    for (const SchemaKey<Element>& key : keys) {
      if (key.optional && key.get(element) == key.get(usual)) continue;
      line += (line.empty() ? "" : ", ") + key.name + ": " + key.get(element);
    }
    text += indent + "  - {" + line + "}\n";
  }
  return text;
}

}  // namespace

std::string DumpScenario(const Scenario& scenario) {
  std::string text;
  std::string open_group;
  for (const auto& key : ScenarioKeys()) {
    const std::string value = key.get(scenario);
    if (value == kNoText) continue;  // as a key that is left out
    const std::size_t dot = key.name.find('.');
    const std::string group = dot == std::string::npos ? "" : key.name.substr(0, dot);
    if (group != open_group && !group.empty()) text += group + ":\n";
    open_group = group;
    const std::string name = group.empty() ? key.name : "  " + key.name.substr(dot + 1);
    text += name + ": " + value + "\n";
  }
  text += DumpOpenKeys(scenario);
  text += ListText("depth.cameras", "", scenario.depth.cameras, DepthMountKeys());
  std::string lists;
  ForEachObstacleList(
      scenario, [&](const std::string& name, const auto& elements, const auto& keys) {
        lists += ListText(name.substr(std::string(kObstacles).size() + 1), "  ", elements, keys);
      });
  return lists.empty() ? text : text + kObstacles + ":\n" + lists;
}

}  // namespace touchdown::evaluation
