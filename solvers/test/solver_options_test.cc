// SPDX-License-Identifier: BSD-3-Clause
// Options name what is wrong with a value.

#include "touchdown/solvers/backend/solver_options.h"

#include <gtest/gtest.h>

namespace touchdown::solvers {
namespace {

TEST(SolverOptions, NamesOptionValueAndRange) {
  SolverOptions options(
      {{"tolerance", 1e-6, 0.0, 1.0, false, ""}, {"memory", 8, 1, 100, true, ""}});
  options.Set("tolerance", 0.5);
  EXPECT_EQ(options.Get("tolerance"), 0.5);
  for (const auto& [name, value] : {std::pair{"tolerance", 2.0}, std::pair{"memory", 2.5}}) {
    try {
      options.Set(name, value);
      FAIL() << name << " took " << value;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("["), std::string::npos);
    }
  }
  EXPECT_THROW(options.Get("none"), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::solvers
