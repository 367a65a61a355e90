// SPDX-License-Identifier: BSD-3-Clause
// Two forks. The worker is forked once, before its maker opens files or starts MPI, and stays as small as it was. For
// each item it forks a child. It reads the child's answer from a pipe until the child closes it or the time is up. The
// kernel kills both when the process above them ends, however it ends. Both ignore the signals of a keyboard, which
// reach the whole group: their maker decides.
#include "evaluation/base/worker_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "evaluation/base/words.h"

namespace touchdown::evaluation {
namespace {

using Clock = std::chrono::steady_clock;

// The header of a reply.
struct Head {
  std::int32_t item;
  WorkerReply::End end;
  std::uint64_t size;
};

bool ReadAll(int from, void* to, std::size_t size) {
  char* at = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t count = read(from, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

// Also to a pipe, of which SIGPIPE is ignored by then.
bool WriteAll(int to, const void* from, std::size_t size) {
  const char* at = static_cast<const char*>(from);
  while (size > 0) {
    const ssize_t count = write(to, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

// To be called first in a forked process: it does not outlive `parent`.
void BindTo(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it was gone before the kernel was told
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL);  // or there is nothing to wait for
}

std::string Words(int status) {
  if (WIFSIGNALED(status)) return SignalWords(WTERMSIG(status));
  return fmt::format("exit status {} without a result", WEXITSTATUS(status));
}

int Wait(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// Reads until the other end is closed; false when the time is up.
bool ReadUntil(int from, Clock::time_point deadline, std::string* text) {
  std::array<char, 65536> buffer;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd readable{from, POLLIN, 0};
    // A wait of more than a minute is made of minutes: milliseconds are an int.
    const int ready =
        poll(&readable, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 60000)));
    if (ready <= 0) continue;
    const ssize_t count = read(from, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    text->append(buffer.data(), static_cast<std::size_t>(count));
  }
}

// Takes the size off a child's answer; false if it is not whole.
bool Unwrap(std::string* text) {
  std::uint64_t size = 0;
  if (text->size() < sizeof(size)) return false;
  std::memcpy(&size, text->data(), sizeof(size));
  text->erase(0, sizeof(size));
  return text->size() == size;
}

// noexcept: an exception ends this process and does not reach a handler of the process that made it.
[[noreturn]] void Answer(const WorkerProcess::Work& work, int item, int to) noexcept {
  const std::string text = work(item);
  const std::uint64_t size = text.size();
  const bool told = WriteAll(to, &size, sizeof(size)) && WriteAll(to, text.data(), text.size());
  // Not exit(): this process must not close or flush anything of its maker.
  _exit(told ? 0 : 1);
}

WorkerReply Do(const WorkerProcess::Work& work, int item, double limit_s) {
  WorkerReply reply;
  reply.item = item;
  std::array<int, 2> ends;
  if (pipe(ends.data()) != 0) _exit(1);
  const pid_t self = getpid();
  const auto limit =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
  const Clock::time_point deadline = Clock::now() + limit;
  const pid_t child = fork();
  if (child < 0) _exit(1);
  if (child == 0) {
    BindTo(self);
    close(ends[0]);
    Answer(work, item, ends[1]);
  }
  close(ends[1]);
  const bool in_time = ReadUntil(ends[0], deadline, &reply.text);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  const int status = Wait(child);
  if (!in_time) {
    reply.end = WorkerReply::End::kTimedOut;
    reply.text.clear();
  } else if (status != 0 || !Unwrap(&reply.text)) {
    reply.end = WorkerReply::End::kDied;
    reply.text = Words(status);
  }
  return reply;
}

[[noreturn]] void Serve(const WorkerProcess::Work& work, double limit_s, int socket) noexcept {
  std::int32_t item = 0;
  while (ReadAll(socket, &item, sizeof(item))) {
    const WorkerReply reply = Do(work, item, limit_s);
    const Head head{reply.item, reply.end, reply.text.size()};
    if (!WriteAll(socket, &head, sizeof(head))) break;
    if (!WriteAll(socket, reply.text.data(), reply.text.size())) break;
  }
  _exit(0);
}

}  // namespace

WorkerProcess::WorkerProcess(const Work& work, double limit_s) {
  std::array<int, 2> ends;
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "a worker process cannot be reached");
  }
  const pid_t self = getpid();
  process_ = fork();
  if (process_ < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    throw std::system_error(error, std::generic_category(), "a worker process cannot be started");
  }
  if (process_ == 0) {
    BindTo(self);
    close(ends[0]);
    Serve(work, limit_s, ends[1]);
  }
  close(ends[1]);
  socket_ = ends[0];
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      socket_(std::exchange(other.socket_, -1)),
      busy_(std::exchange(other.busy_, false)) {}

WorkerProcess::~WorkerProcess() {
  if (process_ < 0) return;
  close(socket_);
  kill(process_, SIGKILL);  // and with it, by BindTo, its current work
  Wait(process_);
}

void WorkerProcess::Start(int item) {
  const std::int32_t number = item;
  // Not write(): a dead worker shows in Receive, not as a signal to this process.
  send(socket_, &number, sizeof(number), MSG_NOSIGNAL);
  busy_ = true;
}

WorkerReply WorkerProcess::Receive() {
  WorkerReply reply;
  Head head{};
  bool whole = ReadAll(socket_, &head, sizeof(head));
  if (whole) {
    reply.item = head.item;
    reply.end = head.end;
    reply.text.resize(head.size);
    whole = ReadAll(socket_, reply.text.data(), head.size);
  }
  busy_ = false;
  if (!whole) throw std::runtime_error("a worker process has ended by itself, or was killed");
  return reply;
}

}  // namespace touchdown::evaluation
