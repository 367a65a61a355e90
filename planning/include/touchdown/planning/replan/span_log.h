// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace touchdown::planning {

/// One timed stretch of one thread. Stretches of one log are in the order in which they began.
struct LoggedSpan {
  const char* stage = "";
  double begin = 0.0;  ///< since the log's start, wall clock [s]
  double wall = 0.0;   ///< [s]
  double cpu = 0.0;    ///< of the thread [s]
  int depth = 0;       ///< number of spans around it
};

/// Collects every span that StageTimer measures on the thread that the log listens to. Allocates in
/// Reserve only: what does not fit is counted and left out.
class SpanLog {
 public:
  using Clock = std::chrono::steady_clock;

  /// Room for this many spans in all.
  void Reserve(std::size_t spans) { spans_.reserve(spans); }

  const std::vector<LoggedSpan>& spans() const { return spans_; }
  std::size_t dropped() const { return dropped_; }

  /// While it lives, its log listens to the calling thread. Not to be nested.
  class Listening {
   public:
    explicit Listening(SpanLog* log) { active_ = log; }
    ~Listening() { active_ = nullptr; }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;
  };

  /// The log that listens to this thread, or nullptr.
  static SpanLog* Active() { return active_; }

  /// Opens a span; the number is for Close.
  std::size_t Open(const char* stage, Clock::time_point begin);
  void Close(std::size_t span, double wall, double cpu);

 private:
  static constinit inline thread_local SpanLog* active_ = nullptr;

  std::vector<LoggedSpan> spans_;
  std::size_t dropped_ = 0;
  int depth_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace touchdown::planning
