// SPDX-License-Identifier: BSD-3-Clause
// The program gets a socket as its standard input. Unlike with a pipe, a write to a socket whose other end is gone can
// be told not to raise a signal. The program's output goes to a file in memory, so it never waits for a reader, nor for
// room on a full disk. It is spawned, not forked, because the rasteriser has threads. It is not in this process's
// group: a keyboard's signals are for this process, which then ends it.
#include "evaluation/video/video_encoder.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/child_program.h"
#include "evaluation/base/words.h"

namespace touchdown::evaluation {
namespace {

constexpr char kEncoder[] = "ffmpeg";

// Names that begin with a dash or look like a protocol are no options or addresses.
std::string FileWord(const std::string& path) { return "file:" + path; }

// The same file, but not as one of the three standard descriptors. These may be closed here, and the program replaces
// them. The program does not get it by itself.
int BehindStandard(int descriptor) {
  if (descriptor < 0) return -1;
  const int behind = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  close(descriptor);
  return behind;
}

}  // namespace

void RequireEncoder(const std::string& who) {
  if (!FindOnPath(kEncoder).empty()) return;
  throw BadInput(fmt::format(
      "{} needs the program {}, which is not on PATH: install the package ffmpeg.", who, kEncoder));
}

VideoEncoder::VideoEncoder(const std::string& path, int width, int height, int rate_hz)
    : path_(path), words_(fdopen(BehindStandard(memfd_create(kEncoder, MFD_CLOEXEC)), "r")) {
  if (words_ == nullptr) throw std::runtime_error("no file in memory could be made");
  std::array<int, 2> ends;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error("no socket could be made");
  }
  for (int& end : ends) end = BehindStandard(end);
  to_child_ = ends[0];
  const std::string size = fmt::format("{}x{}", width, height);
  const std::string rate = std::to_string(rate_hz);
  const std::string file = FileWord(path);
  const std::vector<const char*> words = {
      kEncoder, "-nostdin", "-y", "-loglevel", "error", "-xerror",
      // What comes in.
      "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size.c_str(), "-framerate",
      rate.c_str(), "-i", "pipe:0",
      // What comes out: plays everywhere, begins before it is wholly loaded. Its bits depend on the number of threads, which
      // otherwise is that of the cores.
      "-c:v", "libx264", "-threads", "4", "-preset", "veryfast", "-crf", "20", "-pix_fmt",
      "yuv420p", "-fflags", "+bitexact", "-movflags", "+faststart", "-f", "mp4", file.c_str(),
      nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(words_.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(words_.get()), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failed = posix_spawnp(&child_, kEncoder, &actions, &attributes,
                                  const_cast<char* const*>(words.data()), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed != 0) {
    close(to_child_);
    throw std::runtime_error(
        fmt::format("{} could not be started ({})", kEncoder, std::strerror(failed)));
  }
}

VideoEncoder::~VideoEncoder() { Wait(); }

void VideoEncoder::Wait() noexcept {
  if (to_child_ >= 0) close(std::exchange(to_child_, -1));
  if (child_ < 0) return;
  while (waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

void VideoEncoder::Add(const std::vector<std::uint8_t>& rgb) {
  for (std::size_t sent = 0; sent < rgb.size();) {
    const ssize_t count = send(to_child_, rgb.data() + sent, rgb.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail();
    sent += static_cast<std::size_t>(count);
  }
  empty_ = false;
}

void VideoEncoder::Finish() {
  if (empty_) throw std::runtime_error("there is no picture to be shown");
  Wait();
  // If a file's last part cannot be written, the program may only print that and still end with
  // success.
  if (status_ != 0 || !LastWords().empty()) Fail();
  std::error_code error;
  if (std::filesystem::file_size(path_, error) > 0 && !error) return;
  throw std::runtime_error(fmt::format("{} ended without a file", kEncoder));
}

std::string VideoEncoder::LastWords() {
  std::rewind(words_.get());
  std::array<char, 512> line;
  std::string last;
  while (std::fgets(line.data(), static_cast<int>(line.size()), words_.get()) != nullptr) {
    if (std::string words = WithoutStop(line.data()); !words.empty()) last = std::move(words);
  }
  return last;
}

void VideoEncoder::Fail() {
  Wait();
  std::string why = LastWords();
  if (WIFSIGNALED(status_)) {
    why = SignalWords(WTERMSIG(status_));
  } else if (why.empty()) {
    why = fmt::format("exit status {}", WEXITSTATUS(status_));
  }
  throw std::runtime_error(fmt::format("{} failed ({})", kEncoder, why));
}

}  // namespace touchdown::evaluation
