// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/step_sensitivity.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/build_info.h"

namespace touchdown::evaluation {
namespace {

constexpr double kFactors[] = {0.75, 1.25};
constexpr double kSamePlan = 1e-9;  // relative difference of two costs

/// Sums over the steps of all parts.
struct Tally {
  SensitivityRow row;
  double work = 0.0, work_before = 0.0;
  double cost = 0.0, cost_before = 0.0;

  void Add(const ReplanRow& before, const ReplanRow& after) {
    ++row.steps;
    row.gained += after.planned() && !before.planned();
    row.lost += before.planned() && !after.planned();
    work += after.work;
    work_before += before.work;
    if (!after.planned() || !before.planned()) {
      row.changed += after.planned() != before.planned();
      return;
    }
    row.changed += std::abs(*after.cost - *before.cost) > kSamePlan * *before.cost;
    cost += *after.cost;
    cost_before += *before.cost;
  }

  SensitivityRow Finish() {
    if (work_before > 0.0) row.mean_work = work / work_before;
    if (cost_before > 0.0) row.mean_cost = cost / cost_before;
    return row;
  }
};

std::vector<ReplanRow> Run(ReplanStudyOptions options, const planning::StepConstants& constants,
                           const std::vector<ReplanScene>& scenes,
                           const solvers::BackendRegistry& backends) {
  options.later = true;
  options.check = false;
  options.repeats = 1;
  options.replanner.constants = constants;
  return RunReplanStudy(options, scenes, backends);
}

/// Later steps follow a first one that planned. Only steps that both runs have are compared.
void Compare(const std::vector<ReplanRow>& before, const std::vector<ReplanRow>& after,
             Tally* tally) {
  const auto key = [](const ReplanRow& row) { return std::pair(row.index, row.step); };
  auto other = after.begin();
  for (const ReplanRow& row : before) {
    while (other != after.end() && key(*other) < key(row)) ++other;
    if (other != after.end() && key(*other) == key(row)) tally->Add(row, *other);
  }
}

}  // namespace

std::vector<SensitivityRow> MeasureSensitivity(
    const std::vector<ReplanStudyOptions>& parts, const solvers::BackendRegistry& backends,
    const std::function<void(int done, int all)>& report) {
  const auto table = planning::StepConstantTable();
  std::vector<std::array<Tally, std::size(kFactors)>> tallies(table.size());
  const int all = static_cast<int>(table.size() * parts.size());
  int done = 0;
  for (const ReplanStudyOptions& part : parts) {
    std::vector<ReplanScene> scenes;
    for (int i = 0; i < part.count; ++i) scenes.push_back(DrawReplanScene(part.scenes, i));
    const planning::StepConstants& usual = part.replanner.constants;
    const std::vector<ReplanRow> before = Run(part, usual, scenes, backends);
    for (std::size_t k = 0; k < table.size(); ++k) {
      for (std::size_t i = 0; i < std::size(kFactors); ++i) {
        const planning::StepConstants changed = Scaled(usual, table[k], kFactors[i]);
        tallies[k][i].row.constant = &table[k];
        tallies[k][i].row.value = ValueOf(changed, table[k]);
        Compare(before, Run(part, changed, scenes, backends), &tallies[k][i]);
      }
      report(++done, all);
    }
  }
  std::vector<SensitivityRow> rows;
  for (auto& of_constant : tallies) {
    for (Tally& tally : of_constant) rows.push_back(tally.Finish());
  }
  return rows;
}

std::string SensitivityText(const std::vector<SensitivityRow>& rows) {
  std::string text = BuildLine() + "\n";
  if (!rows.empty()) text += fmt::format("{} steps\n", rows.front().steps);
  text += fmt::format("{:<16}{:>8}{:>9} {:<15}{:>7}{:>6}{:>6}{:>10}{:>10}  {}\n", "constant", "is",
                      "changed", "unit", "gained", "lost", "other", "mean work", "mean cost",
                      "meaning");
  const planning::StepConstants usual;
  for (const SensitivityRow& row : rows) {
    text += fmt::format("{:<16}{:>8.4g}{:>9.4g} {:<15}{:>7}{:>6}{:>6}{:>10.3f}{:>10.4f}  {}\n",
                        row.constant->name, ValueOf(usual, *row.constant), row.value,
                        row.constant->unit, row.gained, row.lost, row.changed, row.mean_work,
                        row.mean_cost, row.constant->meaning);
  }
  return text;
}

nlohmann::ordered_json SensitivityJson(const std::vector<SensitivityRow>& rows) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const planning::StepConstants usual;
  for (const SensitivityRow& row : rows) {
    json.push_back({{"constant", row.constant->name},
                    {"meaning", row.constant->meaning},
                    {"unit", row.constant->unit},
                    {"is", ValueOf(usual, *row.constant)},
                    {"changed", row.value},
                    {"steps", row.steps},
                    {"gained", row.gained},
                    {"lost", row.lost},
                    {"other_plans", row.changed},
                    {"mean_work_ratio", row.mean_work},
                    {"mean_cost_ratio", row.mean_cost}});
  }
  return json;
}

}  // namespace touchdown::evaluation
