// SPDX-License-Identifier: BSD-3-Clause
// The baseline in the scenes in which the released program was measured: a sample of them. The
// whole of it is in docs/results/ego/tables.md.
#include "evaluation/studies/fidelity/ego_fidelity.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"

namespace touchdown::evaluation {
namespace {

using planning::EgoStatus;

TEST(EgoFidelity, ASampleAgreesWithTheReleasedProgram) {
  for (const SceneKind& kind : SceneKinds()) {
    const std::vector<EgoSceneResult> results = RunEgoScenes(kind, 100, 1, {});
    ASSERT_EQ(results.size(), 100u);
    const auto rows = CompareWithUpstream(kind, results, EgoQuantilesPath());
    ASSERT_EQ(rows.size(), 10u);
    EXPECT_EQ(rows[0].quantity, "first_attempt_success");
    EXPECT_NEAR(rows[0].ours, rows[0].upstream, 0.1) << kind.name;
    for (const EgoFidelityRow& row : rows) {
      EXPECT_EQ(row.kind, kind.name);
      if (row.quantity == "length_m" || row.quantity == "dur_s" || row.quantity == "max_v") {
        EXPECT_NEAR(row.ours / row.upstream, 1.0, 0.03) << kind.name << " " << row.quantity;
      }
      EXPECT_LE(row.interval.lo, row.interval.hi);
    }
  }
}

TEST(EgoFidelity, RepeatsAndRefusesMisuse) {
  const SceneKind& kind = SceneKinds()[2];
  const auto once = RunEgoScenes(kind, 5, 7, {}), again = RunEgoScenes(kind, 5, 7, {});
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(once[i].status, again[i].status);
    EXPECT_EQ(once[i].evaluations, again[i].evaluations);
    if (once[i].status == EgoStatus::kPlanned) {
      EXPECT_EQ(once[i].jerk, again[i].jerk);
    }
  }
  EXPECT_THROW(RunEgoScenes(kind, 0, 1, {}), std::invalid_argument);
  EXPECT_THROW(CompareWithUpstream(kind, once, "/no/such/file.csv"), BadInput);
  const std::string path = ::testing::TempDir() + "touchdown_no_rows.csv";
  std::ofstream(path) << "set,quantity,n\n";
  EXPECT_THROW(CompareWithUpstream(kind, once, path), BadInput);
  std::ofstream(path) << "C_pillars,first_attempt_success,700,many\n";
  EXPECT_THROW(CompareWithUpstream(kind, once, path), BadInput);
}

TEST(EgoFidelity, JudgedRowsDecide) {
  EgoFidelityRow good, bad;
  good.kind = bad.kind = "B";
  good.quantity = "dur_s";
  good.upstream = good.ours = bad.upstream = 2.0;
  good.met = true;
  bad.quantity = "max_a";
  bad.judged = false;
  EXPECT_TRUE(Faithful({good, bad}));
  bad.judged = true;
  EXPECT_FALSE(Faithful({good, bad}));
  EXPECT_NE(EgoFidelityText({good, bad}).find("not met"), std::string::npos);
  const auto json = EgoFidelityJson({good, bad}, 4);
  EXPECT_FALSE(json["met"].get<bool>());
  EXPECT_EQ(json["rows"].size(), 2u);
  EXPECT_EQ(json["seed"], 4);
}

}  // namespace
}  // namespace touchdown::evaluation
