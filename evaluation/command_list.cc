// SPDX-License-Identifier: BSD-3-Clause
// touchdown list: what can be named elsewhere on the command line.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "touchdown/evaluation/commands.h"
#include "touchdown/evaluation/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json ListBackends(const Registries& registries) {
  Json list = Json::array();
  for (const solvers::BackendEntry& entry : registries.backends) {
    list.push_back({{"name", entry.name}, {"description", entry.description}});
  }
  return list;
}

Json ListPlanners() {
  const Scenario defaults;
  return Json::array({{{"name", FindScenarioKey("planner")->get(defaults)},
                       {"description", "moving-endpoint B-spline landing planner"}}});
}

Json ListTerms(const Registries& registries) {
  Json list = Json::array();
  for (const planning::TermEntry& entry : registries.terms) {
    const solvers::TermInfo& info = entry.info;
    list.push_back({{"name", info.name},
                    {"formula", info.formula},
                    {"unit", info.unit},
                    {"source", info.source},
                    {"convex", info.convex},
                    {"default_weight", entry.default_weight}});
  }
  return list;
}

Json ListShippedScenarios() {
  Json list = Json::array();
  for (const std::string& name : ListScenarios()) {
    list.push_back({{"name", name}, {"path", FindScenario(name)}});
  }
  return list;
}

void PrintText(const Json& list) {
  std::size_t width = 0;
  for (const Json& entry : list) {
    width = std::max(width, entry["name"].get_ref<const std::string&>().size());
  }
  for (const Json& entry : list) {
    std::string line = fmt::format("{:<{}}", entry["name"].get<std::string>(), width);
    for (const auto& [key, value] : entry.items()) {
      if (key == "name") continue;
      if (value.is_string() && !value.get<std::string>().empty()) {
        line += "  " + value.get<std::string>();
      } else if (value.is_boolean() && value.get<bool>()) {
        line += "  " + key;
      }
    }
    std::cout << line << "\n";
  }
}

}  // namespace

void AddListCommand(CLI::App& app, const Registries& registries, CommandRun* run) {
  CLI::App* command = app.add_subcommand("list", "List backends, planners, terms or scenarios");
  struct Arguments {
    std::string what;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("WHAT", arguments->what, "What to list")
      ->required()
      ->check(CLI::IsMember({"backends", "planners", "terms", "scenarios"}));
  command->add_flag("--json", arguments->json, "Print one JSON document on stdout");
  command->callback([arguments, &registries, run] {
    *run = [arguments, &registries] {
      Json list;
      if (arguments->what == "backends") list = ListBackends(registries);
      if (arguments->what == "planners") list = ListPlanners();
      if (arguments->what == "terms") list = ListTerms(registries);
      if (arguments->what == "scenarios") list = ListShippedScenarios();
      if (arguments->json) {
        std::cout << list.dump(2) << "\n";
      } else {
        PrintText(list);
      }
      return kDone;
    };
  });
}

}  // namespace touchdown::evaluation
