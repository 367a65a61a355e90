// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/replan/span_log.h"

#include <limits>

namespace touchdown::planning {
namespace {
constexpr std::size_t kDropped = std::numeric_limits<std::size_t>::max();
}

std::size_t SpanLog::Open(const char* stage, Clock::time_point begin) {
  const int depth = depth_++;
  if (spans_.size() == spans_.capacity()) {
    ++dropped_;
    return kDropped;
  }
  const double since_start = std::chrono::duration<double>(begin - start_).count();
  spans_.push_back({stage, since_start, 0.0, 0.0, depth});
  return spans_.size() - 1;
}

void SpanLog::Close(std::size_t span, double wall, double cpu) {
  --depth_;
  if (span == kDropped) return;
  spans_[span].wall = wall;
  spans_[span].cpu = cpu;
}

}  // namespace touchdown::planning
