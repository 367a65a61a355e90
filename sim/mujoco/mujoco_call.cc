// SPDX-License-Identifier: BSD-3-Clause
// MuJoCo 2.2.2 calls mju_user_error on a fatal error. Ours jumps to the scope that is open on this thread. Without a
// scope it calls the handler that was installed before. If there was none, it prints the error and ends the process.
// MuJoCo's default does the same, but also writes a log file and waits for a key. Warnings within a scope are counted
// in mjData and otherwise ignored. Warnings outside of a scope go to the handler that was installed before.

#include "sim/mujoco/mujoco_call.h"

#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>

namespace touchdown::sim {
namespace {

thread_local MujocoErrorScope* innermost = nullptr;
void (*errors_before)(const char*) = nullptr;
void (*warnings_before)(const char*) = nullptr;

void HearWarning(const char* message) {
  if (innermost == nullptr && warnings_before != nullptr) warnings_before(message);
}

}  // namespace

void MujocoErrorScope::Install() {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  if (mju_user_error != Escape) {
    errors_before = mju_user_error;
    mju_user_error = Escape;
  }
  if (mju_user_warning != HearWarning) {
    warnings_before = mju_user_warning;
    mju_user_warning = HearWarning;
  }
}

MujocoErrorScope::MujocoErrorScope() : outer_(innermost) {
  Install();
  innermost = this;
}

MujocoErrorScope::~MujocoErrorScope() { innermost = outer_; }

void MujocoErrorScope::Escape(const char* message) {
  if (innermost == nullptr) {
    if (errors_before != nullptr) return errors_before(message);
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
