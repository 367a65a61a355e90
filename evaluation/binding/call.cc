// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/binding/call.h"

#include <atomic>
#include <thread>

namespace touchdown::binding {

namespace {

thread_local Call* innermost = nullptr;

constexpr std::chrono::milliseconds kLook(20);

std::atomic<bool> ending = false;
std::atomic<int> under_way = 0;  // calls of other threads than the main one
std::thread::id main_thread;

bool IsMain() { return std::this_thread::get_id() == main_thread; }

// Threads that wait for the lock while the interpreter ends are ended in the middle of C++. So none may be left in a
// call.
void EndCalls() {
  ending = true;
  const pybind11::gil_scoped_release release;
  constexpr int kMost = 10000;  // [ms]
  for (int i = 0; i < kMost && under_way > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

void HearOfTheEnd() {
  main_thread = std::this_thread::get_id();
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&EndCalls));
}

CallGuard::CallGuard() {
  if (IsMain()) return;
  if (ending) {
    const pybind11::gil_scoped_release release;
    while (true) std::this_thread::sleep_for(std::chrono::hours(1));
  }
  ++under_way;
}

CallGuard::~CallGuard() {
  if (!IsMain()) --under_way;
}

bool MustEndWithIt() { return ending && !IsMain(); }

Call::Call() : outer_(innermost), looked_(std::chrono::steady_clock::now()) { innermost = this; }

Call::~Call() { innermost = outer_; }

Call* Call::Now() { return innermost; }

void Call::Keep(const pybind11::error_already_set& error) {
  if (!error_) error_.emplace(error);
}

bool Call::interrupted() {
  const pybind11::gil_scoped_acquire acquire;
  if (!error_ || error_->matches(PyExc_Exception)) return false;
  if (outer_ != nullptr) outer_->Keep(*error_);
  return true;
}

std::string Call::what() const {
  const pybind11::gil_scoped_acquire acquire;
  return error_ ? error_->what() : "";
}

bool Call::MustEnd() {
  if (failed() || MustEndWithIt()) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < kLook) return false;
  looked_ = now;
  const pybind11::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) Keep(pybind11::error_already_set());
  return failed();
}

void Call::Raise() {
  if (!error_) return;
  const pybind11::error_already_set error = *error_;
  error_.reset();
  throw error;
}

}  // namespace touchdown::binding
