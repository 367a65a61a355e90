// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <utility>

namespace touchdown::evaluation {

/// What is counted, in the words of the line that says how far it is.
struct ProgressText {
  std::string things;   ///< "flights"
  std::string of = {};  ///< what they belong to ("kind C"); it then begins the line
};

/// "kind C: 3 of 20 flights, 12 s left": the time left at the rate so far.
/// @param done at least 1. @param elapsed_s since the first one was begun [s].
/// `all` 0: nobody knows.
std::string ProgressLine(const ProgressText& text, int done, int all, double elapsed_s);

/// Tells the log about every two seconds, and at the end, how far a long run is. Time counts from
/// construction. Not to be called from two threads at a time.
class Progress {
 public:
  explicit Progress(ProgressText text) : text_(std::move(text)) {}
  void operator()(int done, int all);

 private:
  using Clock = std::chrono::steady_clock;
  ProgressText text_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace touchdown::evaluation
