// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/step_sensitivity.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/studies/replan/scene_sets.h"
#include "touchdown/planning/problem/term_registry.h"

namespace touchdown::evaluation {
namespace {

TEST(StepSensitivity, TellsTheConstantsThatDecideFromThoseThatDoNot) {
  ReplanStudyOptions options;
  options.count = 6;
  options.scenes.set = "clutter";
  options.scenes.kind = SceneKindNamed("A");
  options.replanner.problem.terms = planning::StandardTerms();
  int told = 0;
  const std::vector<SensitivityRow> rows = MeasureSensitivity(
      {options}, solvers::StandardBackends(), [&](int done, int all) { told = all - done; });
  EXPECT_EQ(told, 0);
  const auto table = planning::StepConstantTable();
  ASSERT_EQ(rows.size(), 2 * table.size());
  int decides = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].constant, &table[i / 2]);
    EXPECT_GT(rows[i].steps, 2 * options.count);  // later steps, too
    EXPECT_GT(rows[i].mean_work, 0.0);
    decides += rows[i].changed > 0;
    // None of these steps is near a landing or near unknown space.
    if (std::string(rows[i].constant->name) == "unseen_least") {
      EXPECT_EQ(rows[i].changed, 0);
      EXPECT_EQ(rows[i].mean_cost, 1.0);
    }
  }
  EXPECT_GT(decides, 4);
  const auto changed = [&](const std::string& name) {
    int sum = 0;
    for (const SensitivityRow& row : rows) {
      if (row.constant->name == name) sum += row.changed;
    }
    return sum;
  };
  EXPECT_GT(changed("bound_beside") + changed("stand_off"), 0);
  EXPECT_EQ(SensitivityJson(rows).size(), rows.size());
  EXPECT_NE(SensitivityText(rows).find("pair_growth"), std::string::npos);
}

}  // namespace
}  // namespace touchdown::evaluation
