// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/video_encoder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// The program ffmpeg is this script while it lives.
class EncoderScope {
 public:
  explicit EncoderScope(const std::string& script) : before_(std::getenv("PATH")) {
    const fs::path folder = fs::path(::testing::TempDir()) / "touchdown_other_encoder";
    fs::create_directories(folder);
    std::ofstream(folder / "ffmpeg") << "#!/bin/sh\n" << script;
    fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
    setenv("PATH", folder.string().append(":").append(before_).c_str(), 1);
  }
  ~EncoderScope() { setenv("PATH", before_.c_str(), 1); }
  EncoderScope(const EncoderScope&) = delete;
  EncoderScope& operator=(const EncoderScope&) = delete;

 private:
  std::string before_;
};

std::string VideoPath() {
  const std::string path = ::testing::TempDir() + "touchdown_video_encoder.mp4";
  fs::remove(path);
  return path;
}

// Of some pictures; empty: all went well.
std::string FaultOf(const std::string& path, int pictures) {
  try {
    VideoEncoder encoder(path, 64, 48, 25);
    for (int i = 0; i < pictures; ++i) encoder.Add(std::vector<std::uint8_t>(64 * 48 * 3, 90));
    encoder.Finish();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// Of a program that reads all that it gets, and then does this.
std::string FaultWith(const std::string& script) {
  const EncoderScope other("cat > /dev/null\n" + script);
  return FaultOf(VideoPath(), 2);
}

TEST(VideoEncoder, WhatTheProgramSaysIsAFailureWhateverItsStatus) {
  EXPECT_EQ(FaultWith("echo Error writing trailer: no space left. >&2\necho >&2\nexit 0\n"),
            "ffmpeg failed (Error writing trailer: no space left)");
  EXPECT_EQ(FaultWith("exit 3\n"), "ffmpeg failed (exit status 3)");
}

TEST(VideoEncoder, OfAProgramThatIsKilledTheSignalIsNamed) {
  EXPECT_EQ(FaultWith("kill -9 $$\n"), "ffmpeg failed (signal 9 (Killed))");
}

TEST(VideoEncoder, AFileMustBeThereInTheEnd) {
  EXPECT_EQ(FaultWith("exit 0\n"), "ffmpeg ended without a file");
  EXPECT_EQ(FaultOf(VideoPath(), 0), "there is no picture to be shown");
}

// A loop device of a few kilobytes would need rights; /dev/full is full for everybody.
TEST(VideoEncoder, AFullDiskIsAFailure) {
  EXPECT_THAT(FaultOf("/dev/full", 50), HasSubstr("ffmpeg failed ("));
}

// As a program has it that was started with `<&-`.
TEST(VideoEncoder, WorksWithoutAStandardInput) {
  const int input = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 10);
  close(STDIN_FILENO);
  const std::string path = VideoPath();
  const std::string fault = FaultOf(path, 5);
  if (input >= 0) {
    dup2(input, STDIN_FILENO);
    close(input);
  }
  EXPECT_EQ(fault, "");
  EXPECT_GT(fs::file_size(path), 500U);
}

TEST(VideoEncoder, TheProgramGetsNoOtherFile) {
  // Three standard ones; the shell that lists them has one of its own.
  EXPECT_EQ(FaultWith("ls -l /proc/$$/fd | grep -c memfd >&2\n"), "ffmpeg failed (2)");
}

}  // namespace
}  // namespace touchdown::evaluation
