// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace touchdown::evaluation {

/// Thrown to end the program. The exit status is then 128 plus the signal's number, as in a shell. It is no
/// std::exception, because nothing has failed.
struct Interruption {
  int signal;
};

/// While it lives, SIGINT and SIGTERM do not end the process. They are noted, and end its system calls. One at a time.
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
