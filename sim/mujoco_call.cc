// SPDX-License-Identifier: BSD-3-Clause
// MuJoCo 2.2.2 calls mju_user_error on a fatal error, which must not return; without one it prints and ends the
// process. Ours jumps to the scope that is open on this thread. Nobody's scope: as without us.

#include "touchdown/sim/mujoco_call.h"

#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>

namespace touchdown::sim {
namespace {

thread_local MujocoErrorScope* innermost = nullptr;
void (*handler_before)(const char*) = nullptr;

void IgnoreWarning(const char* /*message*/) {}  // counted in mjData; MuJoCo would write a file

}  // namespace

void MujocoErrorScope::Install() {
  static std::once_flag once;
  std::call_once(once, [] {
    handler_before = mju_user_error;
    mju_user_error = Escape;
    mju_user_warning = IgnoreWarning;
  });
}

MujocoErrorScope::MujocoErrorScope() : outer_(innermost) {
  Install();
  innermost = this;
}

MujocoErrorScope::~MujocoErrorScope() { innermost = outer_; }

void MujocoErrorScope::Escape(const char* message) {
  if (innermost == nullptr) {
    if (handler_before != nullptr) handler_before(message);
    std::fprintf(stderr, "ERROR: %s\n", message);
    std::exit(EXIT_FAILURE);
  }
  std::snprintf(innermost->message_.data(), innermost->message_.size(), "%s", message);
  std::longjmp(innermost->escape_, 1);
}

void MujocoErrorScope::Throw() const {
  throw std::runtime_error(std::string("MuJoCo: ") + message_.data());
}

}  // namespace touchdown::sim
