// SPDX-License-Identifier: BSD-3-Clause
// touchdown list: what can be named elsewhere on the command line.
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/campaign/study_file.h"
#include "evaluation/program/commands.h"
#include "evaluation/scenario/scenario_schema.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/planning/problem/landing_problem.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSegments = 12;  // of the problem that every backend is asked about

/// A problem of every formulation.
struct Formulation {
  const char* endpoint;
  const char* arrival;
  const char* limits;
  std::unique_ptr<planning::LandingProblem> problem;
};

std::vector<Formulation> Formulations(const planning::TermRegistry& terms) {
  using planning::ArrivalMode, planning::EndpointMode, planning::LimitsMode;
  std::vector<Formulation> all;
  for (const EndpointMode endpoint : {EndpointMode::kEliminated, EndpointMode::kExplicit}) {
    for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
      for (const LimitsMode limits : {LimitsMode::kSoft, LimitsMode::kHard}) {
        planning::LandingProblemOptions options;
        options.endpoint = endpoint;
        options.arrival = arrival;
        options.limits_mode = limits;
        options.terms = terms;
        all.push_back({endpoint == EndpointMode::kExplicit ? "explicit" : "eliminated",
                       arrival == ArrivalMode::kFree ? "free" : "fixed",
                       limits == LimitsMode::kHard ? "hard" : "soft",
                       std::make_unique<planning::LandingProblem>(kSegments, options)});
      }
    }
  }
  return all;
}

Json ListBackends(const Registries& registries) {
  const std::vector<Formulation> formulations = Formulations(registries.terms);
  Json list = Json::array();
  for (const solvers::BackendEntry& entry : registries.backends) {
    const std::unique_ptr<solvers::SolverBackend> backend = entry.make();
    Json asked = Json::array();
    for (const Formulation& f : formulations) {
      const std::string refusal = backend->Refusal(f.problem->view());
      asked.push_back({{"endpoint", f.endpoint},
                       {"arrival", f.arrival},
                       {"limits", f.limits},
                       {"solves", refusal.empty()},
                       {"reason", refusal}});
    }
    Json options = Json::array();
    for (const solvers::OptionSpec& spec : backend->options().specs()) {
      options.push_back({{"name", spec.name},
                         {"default", spec.value},
                         {"lo", spec.lo},
                         {"hi", spec.hi},
                         {"help", spec.help}});
    }
    list.push_back({{"name", entry.name},
                    {"description", entry.description},
                    {"compiled", backend->capabilities().compiled},
                    {"formulations", asked},
                    {"options", options}});
  }
  return list;
}

void PrintBackends(const Json& list) {
  for (const Json& entry : list) {
    std::cout << fmt::format("{}  {}{}\n", entry["name"].get<std::string>(),
                             entry["description"].get<std::string>(),
                             entry["compiled"].get<bool>() ? "" : " (not compiled in)");
    for (const Json& f : entry["formulations"]) {
      std::cout << fmt::format("  endpoint {:<10}  arrival {:<5}  limits {:<4}  {}\n",
                               f["endpoint"].get<std::string>(), f["arrival"].get<std::string>(),
                               f["limits"].get<std::string>(),
                               f["solves"].get<bool>() ? "ok" : f["reason"].get<std::string>());
    }
    for (const Json& option : entry["options"]) {
      std::cout << fmt::format("  solver.options.{} = {:g} in [{:g}, {:g}]  {}\n",
                               option["name"].get<std::string>(), option["default"].get<double>(),
                               option["lo"].get<double>(), option["hi"].get<double>(),
                               option["help"].get<std::string>());
    }
  }
}

template <class Entry>
Json ListParts(const std::vector<Entry>& registry) {
  Json list = Json::array();
  for (const Part& part : registry) {
    Json parameters = Json::array();
    for (const Parameter& parameter : part.parameters) {
      parameters.push_back({{"key", parameter.key},
                            {"default", parameter.value},
                            {"allowed", parameter.range.ToString()},
                            {"help", parameter.doc}});
    }
    list.push_back(
        {{"name", part.name}, {"description", part.summary}, {"parameters", parameters}});
  }
  return list;
}

/// The words below a list.
constexpr char kBackendsLegend[] =
    "Below each backend: the formulations that it can solve (solver.endpoint, solver.arrival, "
    "solver.limits), and its options.\n";
constexpr char kPartsLegend[] = "Below each name: its keys in a scenario, with their defaults.\n";
constexpr char kTermsLegend[] =
    "Each term: [unit], default weight (terms.NAME.weight), constraint or not (terms.NAME.hard), "
    "source, formula,\nand its parameters (terms.NAME.PARAMETER) with their defaults.\n";

void PrintParts(const Json& list) {
  for (const Json& entry : list) {
    std::cout << fmt::format("{}  {}\n", entry["name"].get<std::string>(),
                             entry["description"].get<std::string>());
    for (const Json& parameter : entry["parameters"]) {
      std::cout << fmt::format("  {} = {:g} in {}  {}\n", parameter["key"].get<std::string>(),
                               parameter["default"].get<double>(),
                               parameter["allowed"].get<std::string>(),
                               parameter["help"].get<std::string>());
    }
  }
}

Json ListTerms(const Registries& registries) {
  Json list = Json::array();
  for (const planning::TermEntry& entry : registries.terms) {
    Json parameters = Json::array();
    for (const planning::TermParameter& parameter : entry.parameters) {
      parameters.push_back({{"name", parameter.name},
                            {"default", parameter.value},
                            {"lo", parameter.lo},
                            {"hi", parameter.hi},
                            {"help", parameter.help}});
    }
    list.push_back({{"name", entry.info.name},
                    {"formula", entry.info.formula},
                    {"unit", entry.info.unit},
                    {"source", entry.info.source},
                    {"convex", entry.info.convex},
                    {"can_be_hard", entry.can_be_hard},
                    {"in_flights", entry.use != planning::TermUse::kMovingObstacles},
                    {"default_weight", entry.default_weight},
                    {"parameters", parameters}});
  }
  return list;
}

void PrintTerms(const Json& list) {
  for (const Json& entry : list) {
    const double weight = entry["default_weight"].get<double>();
    std::cout << fmt::format(
        "{}  [{}]  {}, {}, {}; {}\n  {}\n", entry["name"].get<std::string>(),
        entry["unit"].get<std::string>(), entry["convex"].get<bool>() ? "convex" : "not convex",
        !entry["in_flights"].get<bool>() ? "not in flights"
        : weight > 0.0                   ? fmt::format("weight {:g}", weight)
                                         : "off by default",
        entry["can_be_hard"].get<bool>() ? "cost or constraint" : "cost only",
        entry["source"].get<std::string>(), entry["formula"].get<std::string>());
    for (const Json& parameter : entry["parameters"]) {
      std::cout << fmt::format("  {} = {:g} in [{:g}, {:g}]  {}\n",
                               parameter["name"].get<std::string>(),
                               parameter["default"].get<double>(), parameter["lo"].get<double>(),
                               parameter["hi"].get<double>(), parameter["help"].get<std::string>());
    }
  }
}

Json ListShippedScenarios(const Registries& registries) {
  Json list = Json::array();
  for (const std::string& name : ListScenarios()) {
    const std::string path = FindScenario(name);
    list.push_back({{"name", name},
                    {"path", path},
                    {"description", LoadScenario(path, {}, registries).description}});
  }
  return list;
}

Json ListShippedStudies(const Registries& registries) {
  Json list = Json::array();
  for (const std::string& name : ListStudyFiles()) {
    const std::string path = FindStudyFile(name);
    list.push_back(
        {{"name", name}, {"path", path}, {"description", LoadStudyFile(path, registries).title}});
  }
  return list;
}

void PrintFiles(const Json& list) {
  std::size_t width = 0;
  for (const Json& entry : list) {
    width = std::max(width, entry["name"].get_ref<const std::string&>().size());
  }
  for (const Json& entry : list) {
    std::cout << fmt::format("{:<{}}  {}\n", entry["name"].get<std::string>(), width,
                             entry["description"].get<std::string>());
  }
  if (list.empty()) return;
  const std::filesystem::path first = list.front()["path"].get<std::string>();
  std::cout << fmt::format("The files: {}/NAME.yaml\n", first.parent_path().string());
}

void Print(const std::string& what, const Json& list) {
  if (what == "scenarios" || what == "studies") return PrintFiles(list);
  if (what == "backends") {
    PrintBackends(list);
    std::cout << kBackendsLegend;
  } else if (what == "terms") {
    PrintTerms(list);
    std::cout << kTermsLegend;
  } else {
    PrintParts(list);
    std::cout << kPartsLegend;
  }
}

}  // namespace

void AddListCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(
      "list", "List scenarios, backends, terms, planners and other parts", "scenario.md");
  struct Arguments {
    std::string what;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  command.Add("WHAT", arguments->what, "What to list")
      .Required()
      .Check(OneOf({"backends", "planners", "motions", "controllers", "predictors", "terms",
                    "scenarios", "studies"}));
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] {
      Json list;
      if (arguments->what == "backends") list = ListBackends(registries);
      if (arguments->what == "planners") list = ListParts(registries.planners);
      if (arguments->what == "motions") list = ListParts(registries.pad_motions);
      if (arguments->what == "controllers") list = ListParts(registries.controllers);
      if (arguments->what == "predictors") list = ListParts(registries.predictors);
      if (arguments->what == "terms") list = ListTerms(registries);
      if (arguments->what == "scenarios") list = ListShippedScenarios(registries);
      if (arguments->what == "studies") list = ListShippedStudies(registries);
      if (arguments->json) {
        std::cout << list.dump(2) << "\n";
      } else {
        Print(arguments->what, list);
      }
      return kDone;
    };
  });
}

}  // namespace touchdown::evaluation
