// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/binding/call.h"

namespace touchdown::binding {

namespace {

thread_local Call* innermost = nullptr;

constexpr std::chrono::milliseconds kLook(20);

}  // namespace

Call::Call() : outer_(innermost), looked_(std::chrono::steady_clock::now()) { innermost = this; }

Call::~Call() { innermost = outer_; }

Call* Call::Now() { return innermost; }

void Call::Keep(const pybind11::error_already_set& error) {
  if (!error_) error_.emplace(error);
}

bool Call::interrupted() {
  const pybind11::gil_scoped_acquire acquire;
  if (!error_ || !error_->matches(PyExc_KeyboardInterrupt)) return false;
  if (outer_ != nullptr) outer_->Keep(*error_);
  return true;
}

std::string Call::what() const {
  const pybind11::gil_scoped_acquire acquire;
  return error_ ? error_->what() : "";
}

bool Call::MustEnd() {
  if (failed()) return true;
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
