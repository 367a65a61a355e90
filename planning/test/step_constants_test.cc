// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/problem/step_constants.h"

#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {
namespace {

// A constant that is left out of the table would not be measured.
TEST(StepConstants, AreAllInTheTableOnce) {
  const StepConstants usual;
  std::size_t size = 0;
  std::set<std::string> names;
  for (const StepConstant& constant : StepConstantTable()) {
    EXPECT_TRUE(names.insert(constant.name).second) << constant.name;
    EXPECT_GT(std::string(constant.meaning).size(), 8u) << constant.name;
    EXPECT_GT(ValueOf(usual, constant), 0.0) << constant.name;
    size +=
        std::holds_alternative<int StepConstants::*>(constant.value) ? sizeof(int) : sizeof(double);
  }
  EXPECT_LE(names.size(), 30u);
  EXPECT_LE(size, sizeof(StepConstants));
  EXPECT_GT(size + 4 * alignof(StepConstants), sizeof(StepConstants));  // except for padding
}

TEST(StepConstants, AreScaledOneAtATime) {
  const StepConstants usual;
  for (const StepConstant& changed : StepConstantTable()) {
    for (const double factor : {0.75, 1.25}) {
      const StepConstants scaled = Scaled(usual, changed, factor);
      for (const StepConstant& constant : StepConstantTable()) {
        const double before = ValueOf(usual, constant), after = ValueOf(scaled, constant);
        if (&constant != &changed) {
          EXPECT_EQ(after, before) << constant.name;
        } else if (factor > 1.0) {
          EXPECT_GT(after, before) << constant.name;
          EXPECT_GT(before, constant.least) << constant.name;
        } else {
          EXPECT_LE(after, before) << constant.name;
          EXPECT_GT(after, constant.least) << constant.name;
        }
      }
    }
  }
  StepConstants two;
  two.limit_rounds = 2;
  for (const StepConstant& constant : StepConstantTable()) {
    if (std::string(constant.name) != "limit_rounds") continue;
    EXPECT_EQ(Scaled(two, constant, 1.25).limit_rounds, 3);
    EXPECT_EQ(Scaled(two, constant, 0.75).limit_rounds, 1);
    EXPECT_THROW(Scaled(two, constant, 0.0), std::invalid_argument);
    EXPECT_THROW(Scaled(two, constant, std::numeric_limits<double>::quiet_NaN()),
                 std::invalid_argument);
  }
}

TEST(StepConstants, OutOfTheirRangeAreRefusedByName) {
  const auto refused = [](const ReplannerOptions& options, const char* name) {
    try {
      const Replanner replanner(options, solvers::StandardBackends());
      return false;
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find(name) != std::string::npos;
    }
  };
  for (const StepConstant& constant : StepConstantTable()) {
    ReplannerOptions options;
    if (const auto* real = std::get_if<double StepConstants::*>(&constant.value)) {
      options.constants.*(*real) = constant.least - 0.01;
    } else {
      options.constants.*std::get<int StepConstants::*>(constant.value) = -1;
    }
    EXPECT_TRUE(refused(options, constant.name)) << constant.name;
  }
  // A step of no length would look for a free end for ever.
  ReplannerOptions options;
  options.constants.end_step = 1.0;
  EXPECT_TRUE(refused(options, "end_step"));
}

}  // namespace
}  // namespace touchdown::planning
