// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/on_threads.h"

#include <atomic>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(RunOnThreads, EveryIndexOnceAndProgressInOrder) {
  for (const int jobs : {1, 3, 8}) {
    std::vector<int> runs(50, 0);
    std::vector<int> told;
    RunOnThreads(
        50, jobs, [&](int i) { ++runs[static_cast<std::size_t>(i)]; },
        [&](int done, int all) {
          told.push_back(done);
          EXPECT_EQ(all, 50);
        });
    EXPECT_EQ(runs, std::vector<int>(50, 1)) << jobs;
    ASSERT_EQ(told.size(), 50U);
    for (int k = 0; k < 50; ++k) EXPECT_EQ(told[static_cast<std::size_t>(k)], k + 1);
  }
  RunOnThreads(
      0, 2, [](int) { FAIL(); }, [](int, int) { FAIL(); });
}

TEST(RunOnThreads, WhatIsThrownComesOutAndEndsTheRun) {
  std::atomic<int> runs{0};
  const auto run = [&](int i) {
    ++runs;
    if (i == 3) throw std::invalid_argument("three");
  };
  EXPECT_THROW(RunOnThreads(1000, 2, run, [](int, int) {}), std::invalid_argument);
  EXPECT_LT(runs, 1000);
}

TEST(RunOnThreads, WhatProgressThrowsOnAnotherThreadComesOutToo) {
  const auto caller = std::this_thread::get_id();
  std::latch told(1);
  const auto run = [&](int) {
    if (std::this_thread::get_id() == caller) told.wait();
  };
  const auto progress = [&](int, int) {
    if (std::this_thread::get_id() == caller) return;
    told.count_down();
    throw std::invalid_argument("progress");
  };
  EXPECT_THROW(RunOnThreads(1000, 2, run, progress), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
