// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/compare/reference_compare.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
      EXPECT_EQ(cell.Count(Verdict::kRight), 1) << cell.problem;
      EXPECT_EQ(cell.solves.size(), 1u);
    } else {
      EXPECT_EQ(cell.refusal, "backend lbfgs takes no bounds on variables: make them costs");
      EXPECT_TRUE(cell.solves.empty());
    }
  }
  const std::string text = ReferenceText(options, result);
  EXPECT_NE(text.find("10 of 10"), std::string::npos) << text;
  EXPECT_NE(text.find("mass_chain_100"), std::string::npos) << text;
  EXPECT_NE(text.find("refused, 10 problems: backend lbfgs takes no bounds"), std::string::npos)
      << text;
  EXPECT_NE(text.find("at the best: right, and "), std::string::npos) << text;
  EXPECT_NE(text.find("; elsewhere: converged, and "), std::string::npos) << text;
}

TEST(ReferenceCompare, StartsRepeatAndEveryOneIsCounted) {
  ReferenceOptions options{.set = "shooting", .backends = {"banded"}, .starts = 3};
  const ReferenceResult first = RunAll(options), second = RunAll(options);
  ASSERT_EQ(first.cells.size(), first.problems.size());
  for (std::size_t i = 0; i < first.cells.size(); ++i) {
    const ReferenceCell& cell = first.cells[i];
    ASSERT_EQ(cell.solves.size(), 3u) << cell.problem;
    for (int start = 0; start < 3; ++start) {
      const ReferenceSolve &one = cell.solves[start], &again = second.cells[i].solves[start];
      EXPECT_EQ(one.summary.cost, again.summary.cost) << cell.problem;
      EXPECT_EQ(one.verdict, again.verdict) << cell.problem;
      if (one.verdict == Verdict::kRight) {
        EXPECT_NEAR(one.summary.cost, first.optima[i], 1e-6 * std::max(1.0, first.optima[i]));
      }
    }
  }
  const auto json = ReferenceJson(options, first);
  EXPECT_EQ(json["cells"].size(), first.cells.size());
  EXPECT_TRUE(json["cells"][0]["median_ms"].is_number());
}

}  // namespace
}  // namespace touchdown::evaluation
