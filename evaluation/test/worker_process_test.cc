// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/worker_process.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "evaluation/base/work_sharing.h"

namespace touchdown::evaluation {
namespace {

using End = WorkerReply::End;

WorkerReply Ask(const WorkerProcess::Work& work, double limit_s = 60.0) {
  WorkerProcess worker(work, limit_s);
  worker.Start(7);
  EXPECT_TRUE(worker.busy());
  WorkerReply reply = worker.Receive();
  EXPECT_FALSE(worker.busy());
  return reply;
}

TEST(WorkerProcess, AnswersWithBytesOfAnyKindAndLength) {
  const std::string long_text(3'000'000, 'x');
  const auto reply = Ask([&](int i) { return long_text + '\0' + std::to_string(i); });
  EXPECT_EQ(reply.end, End::kDone);
  EXPECT_EQ(reply.item, 7);
  EXPECT_EQ(reply.text, long_text + '\0' + "7");
}

TEST(WorkerProcess, AnEmptyAnswerIsAnAnswer) {
  const auto reply = Ask([](int) { return std::string(); });
  EXPECT_EQ(reply.end, End::kDone);
  EXPECT_EQ(reply.text, "");
}

TEST(WorkerProcess, WorkCannotChangeItsMaker) {
  int count = 0;
  const auto reply = Ask([&](int) { return std::to_string(++count); });
  EXPECT_EQ(reply.text, "1");
  EXPECT_EQ(count, 0);
}

TEST(WorkerProcess, SaysWhatItsWorkDiedOf) {
  const auto killed = Ask([](int) -> std::string {
    raise(SIGKILL);
    return "";
  });
  EXPECT_EQ(killed.end, End::kDied);
  EXPECT_EQ(killed.text, "signal 9 (Killed)");
  const auto aborted = Ask([](int) -> std::string { std::abort(); });
  EXPECT_EQ(aborted.end, End::kDied);
  EXPECT_EQ(aborted.text, "signal 6 (Aborted)");
  const auto left = Ask([](int) -> std::string { _exit(3); });
  EXPECT_EQ(left.end, End::kDied);
  EXPECT_EQ(left.text, "exit status 3 without a result");
}

// No caller catches the exception, although one could: this test's own framework.
TEST(WorkerProcess, AnExceptionIsADeath) {
  EXPECT_EQ(Ask([](int) -> std::string { throw 1; }).text, "signal 6 (Aborted)");
}

TEST(WorkerProcess, EndsWorkThatTakesTooLong) {
  const auto reply = Ask(
      [](int) -> std::string {
        for (;;) pause();
      },
      0.05);
  EXPECT_EQ(reply.end, End::kTimedOut);
  EXPECT_TRUE(reply.text.empty());
}

TEST(WorkerProcess, GoesOnAfterADeath) {
  WorkerProcess worker(
      [](int i) -> std::string {
        if (i == 0) std::abort();
        return "alive";
      },
      60.0);
  worker.Start(0);
  EXPECT_EQ(worker.Receive().end, End::kDied);
  worker.Start(1);
  EXPECT_EQ(worker.Receive().text, "alive");
}

TEST(ShareWork, DoesEveryItemOnceOnAllWorkers) {
  const pid_t self = getpid();
  std::vector<WorkerProcess> workers;
  for (int i = 0; i < 3; ++i) {
    workers.emplace_back([=](int item) { return std::to_string(item * 2 + (getpid() == self)); },
                         60.0);
  }
  std::vector<int> items;
  for (int i = 0; i < 40; ++i) items.push_back(i);
  std::map<int, std::string> done;
  ShareWork(
      workers, 3, items,
      [&](const WorkerReply& r) { EXPECT_TRUE(done.emplace(r.item, r.text).second); },
      [] { return false; });
  ASSERT_EQ(done.size(), items.size());
  for (const auto& [item, text] : done) EXPECT_EQ(text, std::to_string(2 * item));
}

TEST(ShareWork, KeepsToSoManyAtATime) {
  const auto now = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
  // When it began and ended: in one at a time, none begins before the last has ended.
  const auto work = [&](int) {
    const auto begin = now();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return std::to_string(begin) + " " + std::to_string(now());
  };
  std::vector<WorkerProcess> workers;
  for (int i = 0; i < 3; ++i) workers.emplace_back(work, 60.0);
  long last = 0;
  int done = 0;
  ShareWork(
      workers, 1, {0, 1, 2, 3, 4, 5},
      [&](const WorkerReply& reply) {
        std::istringstream times(reply.text);
        long begin = 0, end = 0;
        times >> begin >> end;
        EXPECT_GT(begin, last);
        EXPECT_GT(end, begin);
        last = end;
        ++done;
      },
      [] { return false; });
  EXPECT_EQ(done, 6);
}

TEST(ShareWork, StopsWhenAsked) {
  std::vector<WorkerProcess> workers;
  workers.emplace_back([](int) { return std::string("x"); }, 60.0);
  int done = 0;
  ShareWork(
      workers, 1, {0, 1, 2, 3, 4, 5}, [&](const WorkerReply&) { ++done; },
      [&] { return done == 2; });
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace touchdown::evaluation
