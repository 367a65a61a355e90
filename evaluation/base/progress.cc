// SPDX-License-Identifier: BSD-3-Clause
// How far a long run is, on the log. The time left takes every piece of work for as long as those
// before it were in the mean.
#include "evaluation/base/progress.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchdown::evaluation {

std::string ProgressLine(const ProgressText& text, int done, int all, double elapsed_s) {
  const std::string begin = text.of.empty() ? "" : text.of + ": ";
  if (all == 0) return fmt::format("{}{} {}", begin, done, text.things);
  return fmt::format("{}{} of {} {}, {:.0f} s left", begin, done, all, text.things,
                     elapsed_s / done * (all - done));
}

void Progress::operator()(int done, int all) {
  const auto now = Clock::now();
  if (now - last_ < std::chrono::seconds(2) && (done < all || all == 0)) return;
  last_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  spdlog::info("{}", ProgressLine(text_, done, all, elapsed_s));
}

}  // namespace touchdown::evaluation
