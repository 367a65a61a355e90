// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <sys/types.h>

namespace touchdown::evaluation {

/// The result of one piece of work.
struct WorkerReply {
  enum class End { kDone, kDied, kTimedOut };
  int item = 0;
  End end = End::kDone;
  std::string text;  ///< what the work gave; for kDied the cause, in words
};

/// A process that waits for numbers and answers each with `work(number)`. A child process of its own does each piece of
/// work, so work that crashes or never ends loses only its own result. The worker is a copy of the process that makes
/// it, at that time; that process should have no other threads.
class WorkerProcess {
 public:
  using Work = std::function<std::string(int item)>;

  /// Work that has not ended after `limit_s` of wall time [s] is ended. @throws std::system_error
  WorkerProcess(const Work& work, double limit_s);
  ~WorkerProcess();  ///< ends what is under way
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;
  WorkerProcess& operator=(WorkerProcess&&) = delete;

  /// Only while not busy.
  void Start(int item);
  bool busy() const { return busy_; }
  /// Can be read from once the work has ended.
  int descriptor() const { return socket_; }
  /// Waits for the reply to the last Start. @throws std::runtime_error if the process itself is gone
  WorkerReply Receive();

 private:
  pid_t process_ = -1;
  int socket_ = -1;
  bool busy_ = false;
};

}  // namespace touchdown::evaluation
