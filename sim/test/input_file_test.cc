// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/input_file.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Written(const std::string& name, const std::string& text) {
  const std::string path = ::testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string Refusal(const std::string& path, std::size_t most) {
  const std::string why =
      test::MessageOf<std::invalid_argument>([&] { ReadInputFile(path, most); });
  EXPECT_THAT(why, StartsWith(path + ": "));
  return why;
}

TEST(InputFile, GivesAllBytesUpToItsBound) {
  const std::string bytes = std::string("a\0\r\n", 4) + std::string(3 << 20, 'x');
  const std::string path = Written("input_file", bytes);
  EXPECT_EQ(ReadInputFile(path, bytes.size()), bytes);
  EXPECT_THAT(Refusal(path, bytes.size() - 1), HasSubstr("larger than the 3 MiB that are read"));
  EXPECT_EQ(HeadOfFile(path, 3), std::string("a\0\r", 3));
  EXPECT_EQ(HeadOfFile(path, bytes.size() + 9), bytes);
  EXPECT_EQ(ReadInputFile(Written("input_empty", ""), 1), "");
  // The kernel says that this one has no bytes.
  EXPECT_THAT(ReadInputFile("/proc/self/status", 1 << 20), HasSubstr("Name:"));
}

// Whoever opens the FIFO waits for a writer, and /dev/zero has no end.
TEST(InputFile, OnlyARegularFileIsRead) {
  const std::string fifo = ::testing::TempDir() + "input_fifo";
  std::remove(fifo.c_str());
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_THAT(Refusal(fifo, 9), HasSubstr("no regular file"));
  EXPECT_THAT(Refusal("/dev/zero", 9), HasSubstr("no regular file"));
  EXPECT_THAT(Refusal(::testing::TempDir(), 9), HasSubstr("it is a directory"));
  EXPECT_THAT(Refusal("/no/such/file", 9), HasSubstr("cannot be read (No such file"));
  for (const char* none : {"/dev/zero", "/no/such/file", fifo.c_str()}) {
    EXPECT_EQ(HeadOfFile(none, 9), "");
  }
  std::remove(fifo.c_str());
}

}  // namespace
}  // namespace touchdown::sim
