// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace touchdown::evaluation {

/// Thrown on the way to the program's end, which then has the exit status 128 and the signal's number, as a shell has it. No
/// std::exception: nothing has failed.
struct Interruption {
  int signal;
};

/// While it lives SIGINT and SIGTERM do not end the process but are noted, and end its system calls. One at a
/// time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();  ///< as it was before
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// The signal that came, or 0.
  int signal() const;
  /// @throws Interruption if one came
  void ThrowIfAsked() const;

 private:
  struct sigaction interrupt_ = {};
  struct sigaction terminate_ = {};
};

}  // namespace touchdown::evaluation
