// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace touchdown::evaluation {

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

 private:
  struct sigaction interrupt_ = {};
  struct sigaction terminate_ = {};
};

}  // namespace touchdown::evaluation
