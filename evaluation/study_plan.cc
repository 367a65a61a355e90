// SPDX-License-Identifier: BSD-3-Clause
// From a study file to its trials: the product of cells and methods, each part's scenario loaded once.
#include "touchdown/evaluation/study_plan.h"

#include <algorithm>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/rendering_check.h"

namespace touchdown::evaluation {
namespace {

// As a shell reads it back.
std::string ShellWord(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=+-") ==
                     std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char letter : word) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + "'";
}

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

bool Flies(const StudyCell& cell, const StudyMethod& method) {
  return cell.methods.empty() ||
         std::find(cell.methods.begin(), cell.methods.end(), method.name) != cell.methods.end();
}

StudyPart PlanPart(const StudyFile& file, int cell_index, int method_index,
                   const Registries& registries) {
  StudyPart part;
  part.cell = cell_index;
  part.method = method_index;
  const StudyCell& cell = file.cells[static_cast<std::size_t>(cell_index)];
  const StudyMethod& method = file.methods[static_cast<std::size_t>(method_index)];
  const auto overrides = Overrides({&file.set, &cell.set, &method.set});
  part.command = "touchdown land " + ShellWord(cell.scenario);
  for (const std::string& text : overrides) part.command += " --set " + ShellWord(text);
  try {
    part.scenario = LoadScenario(FindScenario(cell.scenario), overrides, registries);
  } catch (const BadInput& refusal) {
    if (!method.may_refuse) {
      throw BadInput(
          fmt::format("study {}, {} in {}: {}", file.name, method.name, cell.name, refusal.what()));
    }
    part.refusal = refusal.what();
  }
  return part;
}

void AddTrials(const StudyCell& cell, const StudyMethod& method, const StudyPart& part,
               StudyPlan* plan) {
  for (int i = 0; i < part.trials; ++i) {
    SweepTrial trial;
    trial.index = static_cast<int>(plan->trials.size());
    trial.seed = TrialSeed(plan->seed, i);
    trial.varied = {{"cell", cell.name}, {"method", method.name}};
    trial.varied.insert(trial.varied.end(), cell.labels.begin(), cell.labels.end());
    trial.scenario = part.scenario;
    plan->trials.push_back(std::move(trial));
  }
}

}  // namespace

StudyPlan PlanStudy(const StudyFile& file, bool quick, std::uint64_t seed,
                    const Registries& registries) {
  StudyPlan plan;
  plan.file = file;
  plan.quick = quick;
  plan.seed = seed;
  for (std::size_t c = 0; c < file.cells.size(); ++c) {
    const StudyCell& cell = file.cells[c];
    if (quick && !cell.quick) continue;
    for (std::size_t m = 0; m < file.methods.size(); ++m) {
      const StudyMethod& method = file.methods[m];
      if (!Flies(cell, method)) continue;
      StudyPart part = PlanPart(file, static_cast<int>(c), static_cast<int>(m), registries);
      if (part.refusal.empty()) part.trials = quick ? method.quick : method.trials;
      AddTrials(cell, method, part, &plan);
      plan.parts.push_back(std::move(part));
    }
  }
  const bool rendered = std::any_of(
      plan.parts.begin(), plan.parts.end(),
      [](const StudyPart& part) { return part.scenario.sensing == SensingKind::kRendered; });
  if (rendered) RequireRendering("sensing: rendered");
  return plan;
}

nlohmann::ordered_json StudyJson(const StudyPlan& plan) {
  using Json = nlohmann::ordered_json;
  const auto text_map = [](const StudyPairs& pairs) {
    Json map = Json::object();
    for (const auto& [key, value] : pairs) map[key] = value;
    return map;
  };
  Json document = {{"study", plan.file.name},      {"title", plan.file.title},
                   {"report", plan.file.report},   {"reference", plan.file.reference},
                   {"quick", plan.quick},          {"seed", plan.seed},
                   {"trials", plan.trials.size()}, {"set", text_map(plan.file.set)},
                   {"cells", Json::array()},       {"methods", Json::array()},
                   {"parts", Json::array()}};
  for (const StudyCell& cell : plan.file.cells) {
    document["cells"].push_back({{"name", cell.name},
                                 {"title", cell.title},
                                 {"scenario", cell.scenario},
                                 {"labels", text_map(cell.labels)},
                                 {"set", text_map(cell.set)}});
  }
  for (const StudyMethod& method : plan.file.methods) {
    document["methods"].push_back({{"name", method.name},
                                   {"title", method.title},
                                   {"set", text_map(method.set)},
                                   {"record", method.record}});
  }
  for (const StudyPart& part : plan.parts) {
    Json entry = {{"cell", plan.file.cells[static_cast<std::size_t>(part.cell)].name},
                  {"method", plan.file.methods[static_cast<std::size_t>(part.method)].name},
                  {"trials", part.trials},
                  {"timeout_s", part.scenario.timeout},
                  {"command", part.command}};
    if (!part.refusal.empty()) entry["refusal"] = part.refusal;
    document["parts"].push_back(std::move(entry));
  }
  return document;
}

}  // namespace touchdown::evaluation
