// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/progress.h"

#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "evaluation/base/stderr_log.h"
#include "evaluation/campaign/campaign_progress.h"

namespace touchdown::evaluation {
namespace {

using ::testing::ElementsAre;

TEST(Progress, LineTellsWhatIsLeftAtTheRateSoFar) {
  EXPECT_EQ(ProgressLine({.things = "flights"}, 5, 20, 4.0), "5 of 20 flights, 12 s left");
  EXPECT_EQ(ProgressLine({.things = "scenes", .of = "kind C"}, 20, 20, 4.0),
            "kind C: 20 of 20 scenes, 0 s left");
}

TEST(Progress, ALineOfACampaignCountsItsRateWithoutWhatWasFlownBefore) {
  CampaignState state;
  state.all = 20;
  state.resumed = state.flown = 6;
  state.succeeded = 5;
  EXPECT_EQ(CampaignLine(state, 0.0), "6 of 20 trials, 5 succeeded and 1 failed");
  state.flown = 10;
  state.succeeded = 8;
  EXPECT_EQ(CampaignLine(state, 8.0),
            "10 of 20 trials, 8 succeeded and 2 failed, 0.50 a second, 20 s left");
}

// Asked `every_ms` for `seconds`: the times at which a line was due [s].
std::vector<double> DueTimes(bool rewritten, int every_ms, int seconds) {
  ProgressPace pace(rewritten);
  std::vector<double> times;
  for (int ms = 0; ms <= 1000 * seconds; ms += every_ms) {
    if (pace.Due(1e-3 * ms)) times.push_back(1e-3 * ms);
  }
  return times;
}

TEST(Progress, LinesThatStayComeEverMoreRarely) {
  EXPECT_THAT(DueTimes(false, 500, 190), ElementsAre(2, 6, 14, 30, 62, 122, 182));
}

TEST(Progress, ALineThatIsWrittenOverComesTenTimesASecond) {
  const std::vector<double> times = DueTimes(true, 1, 2);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_GE(times.size(), 19U);
  EXPECT_LE(times.size(), 21U);
}

/// Stderr is a terminal of 30 columns for as long as this lives.
class Terminal {
 public:
  Terminal() {
    setenv("TERM", "xterm", 1);
    winsize size{};
    size.ws_col = 30;
    int end = -1;
    if (openpty(&read_, &end, nullptr, nullptr, &size) != 0) ADD_FAILURE() << "no terminal";
    was_ = dup(STDERR_FILENO);
    dup2(end, STDERR_FILENO);
    close(end);
  }
  ~Terminal() {
    if (was_ >= 0) Read();
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// What was written; it is no terminal any more.
  std::string Read() {
    dup2(was_, STDERR_FILENO);
    close(was_);
    was_ = -1;
    std::string text;
    char bytes[256];
    for (ssize_t n = 0; (n = read(read_, bytes, sizeof bytes)) > 0;) {
      text.append(bytes, static_cast<std::size_t>(n));
    }
    close(read_);
    return text;
  }

 private:
  int read_ = -1;
  int was_ = -1;
};

TEST(Progress, OnATerminalALineOfTheLogStandsAboveTheOneThatIsWrittenOver) {
  LogToStderr();
  Terminal terminal;
  {
    Progress progress({.things = "flights", .of = "kind C"});
    progress(1, 3);
    spdlog::warn("look");
    progress(2, 3);  // too soon
    progress(3, 3);
  }
  spdlog::info("done");
  // The terminal writes a carriage return before every end of a line.
  EXPECT_EQ(terminal.Read(),
            "\r\x1b[Ktouchdown: kind C: 1 of 3 fli"
            "\r\x1b[Ktouchdown: look\r\ntouchdown: kind C: 1 of 3 fli"
            "\r\x1b[Ktouchdown: kind C: 3 of 3 fli\r\n"
            "touchdown: done\r\n");
}

TEST(Progress, ARunThatEndsEarlyLeavesItsLine) {
  LogToStderr();
  Terminal terminal;
  {
    Progress progress({.things = "views"});
    progress(1, 0);
  }
  spdlog::error("interrupted");
  EXPECT_EQ(terminal.Read(), "\r\x1b[Ktouchdown: 1 views\r\ntouchdown: interrupted\r\n");
}

TEST(Progress, ALogThatKeepsItsLinesGetsTheLastOneOfAShortRun) {
  LogToStderr();
  testing::internal::CaptureStderr();
  Progress progress({.things = "flights"});
  for (int done = 1; done <= 500; ++done) progress(done, 500);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "touchdown: 500 of 500 flights, 0 s left\n");
}

}  // namespace
}  // namespace touchdown::evaluation
