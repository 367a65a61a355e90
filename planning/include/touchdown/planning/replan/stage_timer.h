// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <limits>

#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/planning/replan/span_log.h"
#include "touchdown/solvers/allocation_count.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::planning {

/// Adds the wall and thread CPU time of its own lifetime, and the allocations in it, to a span.
/// Shows it to the log that listens to the thread, if there is one. Does not allocate.
///
/// Reading the thread's clock is a system call. For the stages within a step it made up 6 % of the
/// slowest steps. So they ask for kWhileLogged: their CPU time is NaN unless a log listens.
class StageTimer {
 public:
  enum Cpu { kAlways, kWhileLogged };

  explicit StageTimer(StageTimes::Span* span, Cpu cpu = kAlways)
      : span_(span),
        log_(SpanLog::Active()),
        measures_cpu_(cpu == kAlways || log_ != nullptr),
        allocations_(solvers::AllocationCount()),
        wall_(SpanLog::Clock::now()),
        cpu_(CpuSeconds()) {
    if (log_) logged_ = log_->Open(span->stage, wall_);
  }
  ~StageTimer() {
    const double cpu = CpuSeconds() - cpu_;
    const double wall = std::chrono::duration<double>(SpanLog::Clock::now() - wall_).count();
    span_->wall += wall;
    span_->cpu += cpu;
    span_->allocations += solvers::AllocationCount() - allocations_;
    if (log_) log_->Close(logged_, wall, cpu);
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double CpuSeconds() const {
    return measures_cpu_ ? solvers::ThreadCpuSeconds() : std::numeric_limits<double>::quiet_NaN();
  }

  StageTimes::Span* span_;
  SpanLog* log_;
  bool measures_cpu_;
  std::size_t logged_ = 0;
  long allocations_;
  SpanLog::Clock::time_point wall_;
  double cpu_;
};

}  // namespace touchdown::planning
