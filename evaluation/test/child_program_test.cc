// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/child_program.h"

#include <chrono>
#include <cstdlib>
#include <limits>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace touchdown::evaluation {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

ChildEnd RunScript(const std::string& script, const std::vector<std::string>& environment = {}) {
  return RunChild({"/bin/sh", "-c", script, "name", "two words", "$HOME"}, environment, kNoLimit);
}

TEST(ChildProgram, ItsLastLineIsWhatItWroteLastAnywhere) {
  const ChildEnd end = RunScript("echo first; echo second >&2; echo '  '; echo");
  EXPECT_EQ(end.failure, "");
  EXPECT_EQ(end.last_line, "second");
  EXPECT_EQ(RunScript("printf 'a\\nno end of line'").last_line, "no end of line");
  EXPECT_EQ(RunScript("exit 0").last_line, "");
}

TEST(ChildProgram, ItsWordsAreNoText) {
  EXPECT_EQ(RunScript("echo \"$1, $2\"").last_line, "two words, $HOME");
}

TEST(ChildProgram, HasNothingToRead) {
  EXPECT_EQ(RunScript("read line || echo nothing").last_line, "nothing");
}

// As a program is started with `<&- >&-`.
TEST(ChildProgram, WorksWithoutAStandardInputAndOutput) {
  const int input = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 10);
  const int output = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 10);
  close(STDIN_FILENO);
  close(STDOUT_FILENO);
  const ChildEnd end = RunScript("read line || echo nothing");
  if (input >= 0) dup2(input, STDIN_FILENO);
  if (output >= 0) dup2(output, STDOUT_FILENO);
  for (const int copy : {input, output}) close(copy);
  EXPECT_EQ(end.failure, "");
  EXPECT_EQ(end.last_line, "nothing");
}

TEST(ChildProgram, VariablesStandInPlaceOfThoseOfTheSameName) {
  setenv("TOUCHDOWN_TEST", "old", 1);
  setenv("TOUCHDOWN_TEST_2", "kept", 1);
  const std::string script =
      "echo $TOUCHDOWN_TEST $TOUCHDOWN_TEST_2; env | grep -c ^TOUCHDOWN_TEST=";
  EXPECT_EQ(RunScript(script, {"TOUCHDOWN_TEST=new"}).last_line, "1");
  EXPECT_EQ(RunScript("echo $TOUCHDOWN_TEST $TOUCHDOWN_TEST_2", {"TOUCHDOWN_TEST=new"}).last_line,
            "new kept");
  EXPECT_STREQ(std::getenv("TOUCHDOWN_TEST"), "old");
  unsetenv("TOUCHDOWN_TEST");
  unsetenv("TOUCHDOWN_TEST_2");
}

TEST(ChildProgram, AFailureIsItsLastWordsOrItsStatusOrItsSignal) {
  EXPECT_EQ(RunScript("echo no such record. >&2; exit 2").failure, "no such record");
  EXPECT_EQ(RunScript("exit 3").failure, "exit status 3");
  EXPECT_EQ(RunScript("echo words; kill -SEGV $$").failure, "signal 11 (Segmentation fault)");
  EXPECT_EQ(RunChild({"/no/such/program"}, {}, kNoLimit).failure,
            "it cannot be started (No such file or directory)");
}

TEST(ChildProgram, IsEndedAtTheLimit) {
  const auto begin = std::chrono::steady_clock::now();
  const ChildEnd end = RunChild({"/bin/sh", "-c", "echo words; exec sleep 100"}, {}, 0.2);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(end.failure, "it did not end within 0.2 s");
  EXPECT_GE(taken.count(), 0.2);
  EXPECT_LT(taken.count(), 50.0);
}

TEST(ChildProgram, WhatItLeavesRunningHoldsUpNobody) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(RunScript("sleep 20 & echo done").last_line, "done");
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(taken.count(), 15.0);
}

TEST(ChildProgram, IsFoundOnPath) {
  EXPECT_TRUE(FindOnPath("sh").ends_with("/sh"));
  EXPECT_EQ(FindOnPath("no_such_program"), "");
  EXPECT_EQ(FindOnPath(""), "");  // a folder is no program
}

}  // namespace
}  // namespace touchdown::evaluation
