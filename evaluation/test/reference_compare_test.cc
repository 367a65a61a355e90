// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/reference_compare.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

ReferenceResult RunAll(const ReferenceOptions& options) {
  return RunReferences(options, solvers::StandardBackends(), [](int, int) {});
}

TEST(ReferenceCompare, BandedIsRightOnEveryShootingProblem) {
  ReferenceOptions options{.set = "shooting", .backends = {"banded", "lbfgs"}, .starts = 1};
  const ReferenceResult result = RunAll(options);
  EXPECT_FALSE(result.published);
  EXPECT_EQ(result.problems.size(), 10u);
  EXPECT_EQ(result.backends, (std::vector<std::string>{"banded", "lbfgs"}));
  ASSERT_EQ(result.cells.size(), 20u);
  for (const ReferenceCell& cell : result.cells) {
    if (cell.backend == "banded") {
      EXPECT_EQ(cell.right, 1) << cell.problem;
      EXPECT_EQ(cell.cpu_ms.size(), 1u);
    } else {
      EXPECT_EQ(cell.refusal, "backend lbfgs takes no bounds on variables: make them costs");
      EXPECT_EQ(cell.right + cell.elsewhere + cell.unclaimed, 0);
    }
  }
  const std::string text = ReferenceText(options, result);
  EXPECT_NE(text.find("10 of 10"), std::string::npos) << text;
  EXPECT_NE(text.find("mass_chain_100"), std::string::npos) << text;
}

TEST(ReferenceCompare, StartsRepeatAndEveryOneIsCounted) {
  ReferenceOptions options{.set = "shooting", .backends = {"banded"}, .starts = 3};
  const ReferenceResult first = RunAll(options), second = RunAll(options);
  ASSERT_EQ(first.cells.size(), first.problems.size());
  for (std::size_t i = 0; i < first.cells.size(); ++i) {
    const ReferenceCell& cell = first.cells[i];
    EXPECT_EQ(cell.right + cell.elsewhere + cell.unclaimed, 3) << cell.problem;
    EXPECT_EQ(cell.right, second.cells[i].right) << cell.problem;
    EXPECT_EQ(cell.elsewhere, second.cells[i].elsewhere) << cell.problem;
  }
  const auto json = ReferenceJson(options, first);
  EXPECT_EQ(json["cells"].size(), first.cells.size());
  EXPECT_TRUE(json["cells"][0]["median_ms"].is_number());
}

}  // namespace
}  // namespace touchdown::evaluation
