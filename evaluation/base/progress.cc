// SPDX-License-Identifier: BSD-3-Clause
// How far a long run is. The time left assumes that every piece of work takes the mean time of those before it.
#include "evaluation/base/progress.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "evaluation/base/stderr_log.h"

namespace touchdown::evaluation {

std::string ProgressLine(const ProgressText& text, int done, int all, double elapsed_s) {
  const std::string begin = text.of.empty() ? "" : text.of + ": ";
  if (all == 0) return fmt::format("{}{} {}", begin, done, text.things);
  return fmt::format("{}{} of {} {}, {:.0f} s left", begin, done, all, text.things,
                     elapsed_s / done * (all - done));
}

bool ProgressPace::Due(double t_s) {
  constexpr double kRewriteWait = 0.1, kLongestWait = 60.0;  // [s]
  if (t_s < next_s_) return false;
  wait_s_ = rewritten_ ? kRewriteWait : std::min(2.0 * wait_s_, kLongestWait);
  next_s_ = t_s + wait_s_;
  return true;
}

double SteadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct ProgressPrinter::Run {
  explicit Run(SecondsClock with) : clock(std::move(with)) {}
  const SecondsClock clock;
  const bool rewritten = StderrIsTerminal();
  ProgressPace pace{rewritten};
  const double begin = clock();
  bool shown = false;

  // Of a run that ends early, too, the line stays.
  ~Run() { End(); }
  void End() {
    if (std::exchange(shown, false)) EndStatus();
  }
};

ProgressPrinter::ProgressPrinter(SecondsClock clock)
    : run_(std::make_shared<Run>(std::move(clock))) {}

double ProgressPrinter::elapsed_s() const { return run_->clock() - run_->begin; }

void ProgressPrinter::operator()(const std::string& line, bool last) {
  if (!run_->pace.Due(elapsed_s()) && !last) return;
  if (!run_->rewritten) return spdlog::info("{}", line);
  ShowStatus(line);
  run_->shown = true;
  if (last) run_->End();
}

void Progress::operator()(int done, int all) {
  tell_(ProgressLine(text_, done, all, tell_.elapsed_s()), done == all);
}

}  // namespace touchdown::evaluation
