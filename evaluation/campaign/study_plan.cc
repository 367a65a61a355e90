// SPDX-License-Identifier: BSD-3-Clause
// From a study file to a campaign: the product of cells and methods, every part with the same seeds.
#include "evaluation/campaign/study_plan.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/scenario/scenario_value.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// Later pairs replace earlier ones of the same key: a method's key counts, not the cell's.
std::vector<std::string> Overrides(const std::vector<const StudyPairs*>& layers) {
  StudyPairs merged;
  for (const StudyPairs* layer : layers) {
    for (const auto& pair : *layer) {
      const auto same = [&pair](const auto& other) { return other.first == pair.first; };
      const auto old = std::find_if(merged.begin(), merged.end(), same);
      if (old == merged.end()) {
        merged.push_back(pair);
      } else {
        old->second = pair.second;
      }
    }
  }
  std::vector<std::string> overrides;
  for (const auto& [key, value] : merged) overrides.push_back(key + "=" + value);
  return overrides;
}

// A file beside the study's, or as everywhere: a path, or a shipped scenario.
std::string FindScenarioOf(const StudyFile& file, const StudyCell& cell) {
  const std::filesystem::path beside = std::filesystem::path(file.folder) / cell.scenario;
  std::error_code ignored;
  return std::filesystem::is_regular_file(beside, ignored) ? beside.string()
                                                           : FindScenario(cell.scenario);
}

// An empty list holds everything.
bool Holds(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

template <class Entry>
void CheckNames(const char* option, const std::vector<std::string>& names,
                const std::vector<Entry>& entries, const std::string& study) {
  std::vector<std::string> known;
  for (const Entry& entry : entries) known.push_back(entry.name);
  for (const std::string& name : names) {
    if (Holds(known, name)) continue;
    throw BadInput(fmt::format("{} {}: there is none{}.", option, name,
                               Instead(name, known, fmt::format("study {} has", study))));
  }
}

void AddPart(const StudyPart& part, const Registries& registries, StudyPlan* plan) {
  const StudyCell& cell = plan->CellOf(part);
  const StudyMethod& method = plan->MethodOf(part);
  const std::string scenario = FindScenarioOf(plan->file, cell);
  const auto overrides = Overrides({&plan->file.set, &cell.set, &method.set});
  std::vector<std::pair<std::string, std::string>> labels = {{"cell", cell.name},
                                                             {"method", method.name}};
  labels.insert(labels.end(), cell.labels.begin(), cell.labels.end());
  // All of a part share the scenario: it is read and checked once.
  SweepTrial trial = MakeTrial(scenario, overrides, registries);
  trial.varied = labels;
  for (int i = 0; i < part.trials; ++i) {
    trial.index = part.first + i;
    trial.seed = TrialSeed(plan->campaign.seed, i);
    plan->campaign.trials.push_back(trial);
  }
}

// Adds the trials, or why there are none.
void PlanPart(StudyPart part, const Registries& registries, StudyPlan* plan) {
  const StudyMethod& method = plan->MethodOf(part);
  const StudySelection& selection = plan->selection;
  part.trials = selection.trials.value_or(selection.quick ? method.quick : method.trials);
  part.first = static_cast<int>(plan->campaign.trials.size());
  try {
    AddPart(part, registries, plan);
  } catch (const BadInput& refusal) {
    if (!method.may_refuse) {
      throw BadInput(fmt::format("study {}, {} in {}: {}", plan->file.name, method.name,
                                 plan->CellOf(part).name, refusal.what()));
    }
    part.trials = 0;
    part.refusal = refusal.what();
  }
  plan->parts.push_back(std::move(part));
}

}  // namespace

const StudyCell& StudyPlan::CellOf(const StudyPart& part) const {
  return file.cells.at(static_cast<std::size_t>(part.cell));
}

const StudyMethod& StudyPlan::MethodOf(const StudyPart& part) const {
  return file.methods.at(static_cast<std::size_t>(part.method));
}

bool StudyPlan::Records(const StudyPart& part) const {
  const StudyMethod& method = MethodOf(part);
  const auto& cells = method.record_in;
  return method.record || std::find(cells.begin(), cells.end(), CellOf(part).name) != cells.end();
}

StudyPlan PlanStudy(const StudyFile& file, const StudySelection& selection, std::uint64_t seed,
                    const Registries& registries) {
  CheckNames("--cells", selection.cells, file.cells, file.name);
  CheckNames("--methods", selection.methods, file.methods, file.name);
  StudyPlan plan;
  plan.file = file;
  plan.selection = selection;
  plan.campaign.name = "study " + file.name;
  plan.campaign.seed = seed;
  plan.campaign.keys = {{"cell"}, {"method"}};
  for (const auto& [label, value] : file.cells.front().labels)
    plan.campaign.keys.push_back({label});
  for (std::size_t c = 0; c < file.cells.size(); ++c) {
    const StudyCell& cell = file.cells[c];
    if (!Holds(selection.cells, cell.name) || (selection.quick && !cell.quick)) continue;
    for (std::size_t m = 0; m < file.methods.size(); ++m) {
      const std::string& method = file.methods[m].name;
      if (!Holds(selection.methods, method) || !Holds(cell.methods, method)) continue;
      StudyPart part;
      part.cell = static_cast<int>(c);
      part.method = static_cast<int>(m);
      PlanPart(std::move(part), registries, &plan);
    }
  }
  if (plan.parts.empty()) {
    throw BadInput(fmt::format("study {}: none of these methods flies in these cells{}.", file.name,
                               selection.quick ? " in the short form" : ""));
  }
  CheckTrials(plan.campaign);
  return plan;
}

namespace {

// For a part of a study: the selection.
nlohmann::ordered_json SelectionJson(const StudySelection& selection) {
  if (!selection.Part()) return nullptr;
  return {{"cells", selection.cells},
          {"methods", selection.methods},
          {"trials", selection.trials ? Json(*selection.trials) : Json()}};
}

}  // namespace

nlohmann::ordered_json StudyJson(const StudyPlan& plan) {
  const auto text_map = [](const StudyPairs& pairs) {
    Json map = Json::object();
    for (const auto& [key, value] : pairs) map[key] = value;
    return map;
  };
  Json document = {{"study", plan.file.name},        {"title", plan.file.title},
                   {"report", plan.file.report},     {"reference", plan.file.reference},
                   {"quick", plan.selection.quick},  {"selection", SelectionJson(plan.selection)},
                   {"seed", plan.campaign.seed},     {"trials", plan.campaign.trials.size()},
                   {"set", text_map(plan.file.set)}, {"cells", Json::array()},
                   {"methods", Json::array()},       {"parts", Json::array()}};
  for (const StudyCell& cell : plan.file.cells) {
    document["cells"].push_back({{"name", cell.name},
                                 {"title", cell.title},
                                 {"scenario", cell.scenario},
                                 {"labels", text_map(cell.labels)},
                                 {"set", text_map(cell.set)}});
  }
  for (const StudyMethod& method : plan.file.methods) {
    document["methods"].push_back(
        {{"name", method.name}, {"title", method.title}, {"set", text_map(method.set)}});
  }
  for (const StudyPart& part : plan.parts) {
    Json entry = {{"cell", plan.CellOf(part).name},
                  {"method", plan.MethodOf(part).name},
                  {"trials", part.trials},
                  {"recorded", plan.Records(part)}};
    if (part.refusal.empty()) {
      const Scenario& scenario =
          plan.campaign.trials.at(static_cast<std::size_t>(part.first)).scenario;
      entry["timeout_s"] = scenario.timeout;
      entry["descent"] = ToString(scenario.descent);
    } else {
      entry["refusal"] = part.refusal;
    }
    document["parts"].push_back(std::move(entry));
  }
  return document;
}

}  // namespace touchdown::evaluation
