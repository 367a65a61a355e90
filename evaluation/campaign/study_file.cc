// SPDX-License-Identifier: BSD-3-Clause
// Reading a study file: a YAML map of four short lists. Keys of scenarios are only carried here; the
// scenario schema reads them when the trials are planned (study_plan.cc).
#include "evaluation/campaign/study_file.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/scenario/scenario_value.h"
#include "evaluation/scenario/yaml_text.h"

namespace touchdown::evaluation {
namespace {

constexpr int kMostTrials = 1000000;

/// One map of the file. Every key has a reader; a key without one is refused.
class MapReader {
 public:
  MapReader(std::string file, std::string label)
      : file_(std::move(file)), label_(std::move(label)) {}

  using Take = std::function<void(const YAML::Node&, const Where&, const std::string& key)>;
  MapReader& Key(const std::string& name, bool required, Take take) {
    keys_.push_back({name, required, std::move(take)});
    return *this;
  }
  MapReader& Text(const std::string& name, bool required, std::string* text) {
    return Key(name, required, [text](const auto& node, const auto& where, const auto& key) {
      *text = ReadText(node, where, key);
    });
  }
  MapReader& Flag(const std::string& name, bool* flag) {
    return Key(name, false, [flag](const auto& node, const auto& where, const auto& key) {
      *flag = ReadBool(node, where, key);
    });
  }
  MapReader& Count(const std::string& name, int* count) {
    return Key(name, false, [count](const auto& node, const auto& where, const auto& key) {
      *count = ReadWhole(node, where, key, 1, kMostTrials);
    });
  }
  MapReader& Pairs(const std::string& name, StudyPairs* pairs) {
    return Key(name, false, [this, pairs](const auto& node, const auto& where, const auto& key) {
      if (!node.IsMap()) RefuseValue(where, key, "a map of keys", node);
      for (const auto& entry : node) {
        const std::string inner = ReadText(entry.first, WhereIs(entry.first), key);
        pairs->emplace_back(inner, FlowText(entry.second));
      }
    });
  }
  MapReader& Words(const std::string& name, std::vector<std::string>* words) {
    return Key(name, false, [words](const auto& node, const auto& where, const auto& key) {
      if (!node.IsSequence()) RefuseValue(where, key, "a list", node);
      for (const auto& entry : node) words->push_back(ReadText(entry, where, key));
    });
  }

  void Read(const YAML::Node& node) const {
    if (!node.IsMap()) {
      throw BadInput(
          fmt::format("{}: {} must be a map of keys.", WhereIs(node).ToString(), label_));
    }
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const Where where = WhereIs(entry.first);
      const std::string name = ReadText(entry.first, where, "a key");
      const auto key = std::find_if(keys_.begin(), keys_.end(),
                                    [&name](const Known& known) { return known.name == name; });
      if (key == keys_.end()) {
        throw BadInput(fmt::format("{}: unknown key {} of {}{}.", where.ToString(), name, label_,
                                   Instead(name, Names(), "allowed here:")));
      }
      if (!seen.insert(name).second) {
        throw BadInput(fmt::format("{}: {} is given twice.", where.ToString(), name));
      }
      key->take(entry.second, where, name);
    }
    for (const Known& key : keys_) {
      if (key.required && seen.count(key.name) == 0) {
        throw BadInput(
            fmt::format("{}: {} lacks the key {}.", WhereIs(node).ToString(), label_, key.name));
      }
    }
  }

  Where WhereIs(const YAML::Node& node) const {
    return {file_, node.Mark().line >= 0 ? node.Mark().line + 1 : 0};
  }

 private:
  struct Known {
    std::string name;
    bool required;
    Take take;
  };

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const Known& key : keys_) names.push_back(key.name);
    return names;
  }

  // The value as `--set` takes it.
  static std::string FlowText(const YAML::Node& value) {
    if (value.IsScalar()) return value.Scalar();
    YAML::Emitter emitter;
    emitter << YAML::Flow << value;
    return emitter.c_str();
  }

  std::string file_;
  std::string label_;
  std::vector<Known> keys_;
};

/// Elements of a list, each read by `read`; names must differ.
template <typename Element>
void ReadElements(const YAML::Node& list, const Where& where, const std::string& key,
                  const std::string& file, std::vector<Element>* elements,
                  const std::function<void(MapReader&, Element*)>& describe) {
  if (!list.IsSequence()) RefuseValue(where, key, "a list", list);
  for (std::size_t i = 0; i < list.size(); ++i) {
    Element element;
    MapReader reader(file, fmt::format("{}[{}]", key, i));
    reader.Text("name", true, &element.name).Text("title", false, &element.title);
    describe(reader, &element);
    reader.Read(list[i]);
    const bool plain = element.name.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") ==
                       std::string::npos;
    const bool known =
        std::any_of(elements->begin(), elements->end(),
                    [&element](const Element& other) { return other.name == element.name; });
    if (!plain || known || element.name.empty()) {
      throw BadInput(fmt::format(
          "{}: {}[{}].name must be {}, not {}.", reader.WhereIs(list[i]).ToString(), key, i,
          known ? "unique" : "made of letters, digits, '_', '-' and '.'", element.name));
    }
    if (element.title.empty()) element.title = element.name;
    elements->push_back(std::move(element));
  }
}

void DescribeCell(MapReader& reader, StudyCell* cell) {
  reader.Text("scenario", true, &cell->scenario)
      .Pairs("labels", &cell->labels)
      .Pairs("set", &cell->set)
      .Words("methods", &cell->methods)
      .Flag("quick", &cell->quick);
}

void DescribeMethod(MapReader& reader, StudyMethod* method) {
  reader.Pairs("set", &method->set)
      .Count("trials", &method->trials)
      .Count("quick", &method->quick)
      .Key("record", false, [method](const auto& node, const auto& where, const auto& key) {
        if (node.IsSequence()) {
          for (const auto& cell : node) method->record_in.push_back(ReadText(cell, where, key));
        } else {
          method->record = ReadBool(node, where, key);
        }
      });
}

template <typename Element>
std::vector<std::string> ElementNames(const std::vector<Element>& elements) {
  std::vector<std::string> names;
  for (const Element& element : elements) names.push_back(element.name);
  return names;
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// What only the whole file can tell.
void CheckNames(const StudyFile& study, const std::string& path) {
  if (study.cells.empty() || study.methods.empty()) {
    throw BadInput(fmt::format("{}: a study needs a cell and a method.", path));
  }
  const std::vector<std::string> methods = ElementNames(study.methods);
  const std::vector<std::string> cells = ElementNames(study.cells);
  if (!Has(methods, study.reference)) {
    throw BadInput(fmt::format("{}: reference must be one of the methods, not {}{}.", path,
                               study.reference, DidYouMean(study.reference, methods)));
  }
  for (const StudyMethod& method : study.methods) {
    const auto same = [&method](const StudyMethod& other) { return other.name == method.name; };
    if (std::count_if(study.methods.begin(), study.methods.end(), same) > 1) {
      throw BadInput(fmt::format("{}: the method {} is also a backend's name.", path, method.name));
    }
    for (const std::string& name : method.record_in) {
      if (Has(cells, name)) continue;
      throw BadInput(
          fmt::format("{}: the method {} is to be recorded in the cell {}, which is not there{}.",
                      path, method.name, name, DidYouMean(name, cells)));
    }
  }
  const auto keys = [](const StudyCell& cell) {
    std::vector<std::string> names = {"cell", "method"};
    for (const auto& [key, value] : cell.labels) names.push_back(key);
    return names;
  };
  for (const StudyCell& cell : study.cells) {
    if (keys(cell) != keys(study.cells.front())) {
      throw BadInput(
          fmt::format("{}: the cell {} must have the labels of the first cell, in their order.",
                      path, cell.name));
    }
    for (const std::string& name : cell.methods) {
      if (Has(methods, name)) continue;
      throw BadInput(fmt::format("{}: the cell {} asks for the method {}, which is not there{}.",
                                 path, cell.name, name, DidYouMean(name, methods)));
    }
  }
}

}  // namespace

StudyFile LoadStudyFile(const std::string& path, const Registries& registries) {
  StudyFile study;
  study.name = std::filesystem::path(path).stem().string();
  study.folder = std::filesystem::path(path).parent_path().string();
  MapReader reader(path, "a study");
  reader.Text("title", true, &study.title)
      .Text("reference", true, &study.reference)
      .Key("report", false,
           [&study](const auto& node, const auto& where, const auto& key) {
             const std::vector<std::string> known = {"plain", "paper", "solvers", "ablation"};
             study.report = known[static_cast<std::size_t>(ReadChoice(node, where, key, known))];
           })
      .Key("seed", true,
           [&study](const auto& node, const auto& where, const auto& key) {
             study.seed = ReadSeed(node, where, key);
           })
      .Pairs("set", &study.set)
      .Key("cells", true,
           [&](const auto& node, const auto& where, const auto& key) {
             ReadElements<StudyCell>(node, where, key, path, &study.cells, DescribeCell);
           })
      .Key("methods", false,
           [&](const auto& node, const auto& where, const auto& key) {
             ReadElements<StudyMethod>(node, where, key, path, &study.methods, DescribeMethod);
           })
      .Key("backends", false, [&](const auto& node, const auto&, const auto& key) {
        StudyMethod each;
        each.may_refuse = true;
        MapReader inner(path, key);
        DescribeMethod(inner, &each);
        inner.Read(node);
        for (const solvers::BackendEntry& entry : registries.backends) {
          StudyMethod method = each;
          method.name = method.title = entry.name;
          method.set.emplace_back("solver.backend", entry.name);
          study.methods.push_back(std::move(method));
        }
      });
  reader.Read(ReadYamlFile(path, "study"));
  if (study.report.empty()) study.report = "plain";
  CheckNames(study, path);
  return study;
}

}  // namespace touchdown::evaluation
