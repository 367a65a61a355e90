// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace touchdown::evaluation {

/// The counted things, in the words of the progress line.
struct ProgressText {
  std::string things;   ///< "flights"
  std::string of = {};  ///< what they belong to ("kind C"); it then begins the line
};

/// "kind C: 3 of 20 flights, 12 s left": the time left at the rate so far.
/// @param done at least 1. @param elapsed_s since the first one was begun [s].
/// `all` 0: it is not known.
std::string ProgressLine(const ProgressText& text, int done, int all, double elapsed_s);

/// When the next line is due. Times are since the beginning of the run [s].
class ProgressPace {
 public:
  /// `rewritten`: each line replaces the one before, ten times a second at most. Else all of them stay: the first is due
  /// after 2 s, and the waits double, up to a minute.
  explicit ProgressPace(bool rewritten) : rewritten_(rewritten), next_s_(rewritten ? 0.0 : 2.0) {}
  bool Due(double t_s);

 private:
  bool rewritten_;
  double next_s_;
  double wait_s_ = 2.0;
};

/// Any steady time [s].
using SecondsClock = std::function<double()>;
double SteadySeconds();

/// Logs how far a long run is: on a terminal in one line that is overwritten, else in the log. Copies share it. Not to
/// be used from two threads at a time.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(SecondsClock clock = SteadySeconds);
  /// The last line is told whenever it comes, and stays.
  void operator()(const std::string& line, bool last);
  double elapsed_s() const;  ///< since construction [s]

 private:
  struct Run;
  std::shared_ptr<Run> run_;
};

/// Tells how far a run of counted things is. Time counts from construction.
class Progress {
 public:
  explicit Progress(ProgressText text, SecondsClock clock = SteadySeconds)
      : text_(std::move(text)), tell_(std::move(clock)) {}
  void operator()(int done, int all);

 private:
  ProgressText text_;
  ProgressPrinter tell_;
};

}  // namespace touchdown::evaluation
