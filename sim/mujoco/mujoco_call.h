// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <csetjmp>

namespace touchdown::sim {

/// Where a fatal error of MuJoCo on this thread comes out, while it lives. The innermost counts.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

  std::jmp_buf& escape() { return escape_; }
  /// Throws the error that jumped to `escape`, as std::runtime_error.
  [[noreturn]] void Throw() const;

 private:
  static void Escape(const char* message);
  static void Install();

  std::jmp_buf escape_{};
  std::array<char, 1024> message_{};
  MujocoErrorScope* outer_;
};

/// Runs `call`, which calls functions of MuJoCo, and throws its fatal errors (mju_error) as std::runtime_error from
/// here. No exception passes through frames of C. The frames in between get no clean-up, so `call` must hold nothing
/// but such calls. The mjData that they worked on is not usable after an error.
template <class Call>
void CallMujoco(const Call& call) {
  MujocoErrorScope scope;
  if (setjmp(scope.escape()) != 0) scope.Throw();
  call();
}

}  // namespace touchdown::sim
