// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "touchdown/planning/replan_result.h"
#include "touchdown/solvers/thread_clock.h"

namespace touchdown::planning {

/// Adds the wall and thread CPU time of its own lifetime to a span.
class StageTimer {
 public:
  explicit StageTimer(StageTimes::Span* span)
      : span_(span), wall_(std::chrono::steady_clock::now()), cpu_(solvers::ThreadCpuSeconds()) {}
  ~StageTimer() {
    const auto elapsed = std::chrono::steady_clock::now() - wall_;
    span_->wall += std::chrono::duration<double>(elapsed).count();
    span_->cpu += solvers::ThreadCpuSeconds() - cpu_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes::Span* span_;
  std::chrono::steady_clock::time_point wall_;
  double cpu_;
};

}  // namespace touchdown::planning
