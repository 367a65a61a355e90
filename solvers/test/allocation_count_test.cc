// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/allocation_count.h"

#include <cstdlib>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace touchdown::solvers {
namespace {

#ifndef TOUCHDOWN_SANITIZED
void* volatile sink;

// The compiler may remove an allocation that is not observed.
void* Seen(void* block) {
  sink = block;
  return block;
}
#endif

// Tests that compare counts show something only if allocations are counted.
TEST(AllocationCount, CountsWhateverAllocatesInThisThread) {
#ifdef TOUCHDOWN_SANITIZED
  EXPECT_EQ(AllocationCount(), -1);
#else
  const auto counted = [](const auto& allocate) {
    const long before = AllocationCount();
    allocate();
    return AllocationCount() - before;
  };
  EXPECT_EQ(counted([] { std::free(Seen(std::malloc(100))); }), 1);
  EXPECT_EQ(counted([] { std::free(Seen(std::realloc(Seen(std::calloc(2, 50)), 5000))); }), 2);
  EXPECT_EQ(counted([] { Seen(std::make_unique<int>(3).get()); }), 1);
  EXPECT_EQ(counted([] { Seen(Eigen::VectorXd(9).data()); }), 1);
  EXPECT_EQ(counted([] {}), 0);
  long in_thread = -1;
  std::thread other([&] { in_thread = counted([] { std::free(Seen(std::malloc(100))); }); });
  other.join();
  EXPECT_EQ(in_thread, 1);
#endif
}

}  // namespace
}  // namespace touchdown::solvers
