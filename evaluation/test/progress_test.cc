// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/progress.h"

#include <cstdlib>
#include <memory>
#include <optional>
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

/// Stderr is a terminal of so many columns for as long as this lives.
class Terminal {
 public:
  explicit Terminal(unsigned short columns) {
    if (const char* const term = std::getenv("TERM")) term_ = term;
    setenv("TERM", "xterm", 1);
    winsize size{};
    size.ws_col = columns;
    int end = -1;
    if (openpty(&read_, &end, nullptr, nullptr, &size) != 0) ADD_FAILURE() << "no terminal";
    was_ = dup(STDERR_FILENO);
    dup2(end, STDERR_FILENO);
    close(end);
  }
  ~Terminal() {
    if (was_ >= 0) Read();
    if (term_) {
      setenv("TERM", term_->c_str(), 1);
    } else {
      unsetenv("TERM");
    }
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// The written text; it is no terminal any more.
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
  std::optional<std::string> term_;  // as it was
  int read_ = -1;
  int was_ = -1;
};

// What a line looks like that is written over.
std::string ShownOn(unsigned short columns, const std::string& text) {
  LogToStderr();
  Terminal terminal(columns);
  ShowStatus(text);
  EndStatus();
  return terminal.Read();
}

TEST(StderrLog, ALineFitsTheTerminal) {
  const std::string clear = "\r\x1b[K", end = "\r\n";
  EXPECT_EQ(ShownOn(30, "7 of 9 flights"), clear + "touchdown: 7 of 9 flights" + end);
  // The figure first, where there is no room for both.
  EXPECT_EQ(ShownOn(20, "7 of 9 flights"), clear + "7 of 9 flights" + end);
  EXPECT_EQ(ShownOn(6, "7 of 9 flights"), clear + "7 of " + end);
  // Letters are counted, and none is cut in two.
  EXPECT_EQ(ShownOn(17, "\u00e4\u00f6\u00fc\u00df\u00e4"),
            clear + "touchdown: \u00e4\u00f6\u00fc\u00df\u00e4" + end);
  EXPECT_EQ(ShownOn(4, "\u00e4\u00f6\u00fc\u00df\u00e4"), clear + "\u00e4\u00f6\u00fc" + end);
  // A terminal that does not know its width.
  EXPECT_EQ(ShownOn(0, std::string(200, 'x')), clear + std::string(79, 'x') + end);
}

// Tells how many seconds have passed; the test lets them pass.
struct Seconds {
  std::shared_ptr<double> now = std::make_shared<double>(0.0);
  double operator()() const { return *now; }
};

TEST(Progress, OnATerminalALineOfTheLogStandsAboveTheOneThatIsWrittenOver) {
  LogToStderr();
  Terminal terminal(60);
  {
    const Seconds clock;
    Progress progress({.things = "flights", .of = "kind C"}, clock);
    *clock.now = 1.0;
    progress(1, 4);
    spdlog::warn("look");
    *clock.now = 1.05;
    progress(2, 4);  // too soon
    *clock.now = 1.5;
    progress(3, 4);
    progress(4, 4);  // the last one is told whenever it comes
  }
  spdlog::info("done");
  // The terminal writes a carriage return before every end of a line.
  EXPECT_EQ(terminal.Read(),
            "\r\x1b[Ktouchdown: kind C: 1 of 4 flights, 3 s left"
            "\r\x1b[Ktouchdown: look\r\ntouchdown: kind C: 1 of 4 flights, 3 s left"
            "\r\x1b[Ktouchdown: kind C: 3 of 4 flights, 0 s left"
            "\r\x1b[Ktouchdown: kind C: 4 of 4 flights, 0 s left\r\n"
            "touchdown: done\r\n");
}

TEST(Progress, ARunThatEndsEarlyLeavesItsLine) {
  LogToStderr();
  Terminal terminal(60);
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
  Progress progress({.things = "flights"}, Seconds());
  for (int done = 1; done <= 500; ++done) progress(done, 500);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "touchdown: 500 of 500 flights, 0 s left\n");
}

}  // namespace
}  // namespace touchdown::evaluation
