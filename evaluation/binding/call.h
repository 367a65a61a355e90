// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <pybind11/pybind11.h>

namespace touchdown::binding {

/// Thrown through C++ where called Python code has raised. The call for which Python waits then raises the kept error.
class PythonRaised : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One call of C++ from Python, without the lock of the interpreter. Calls of one thread are nested.
class Call {
 public:
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// The innermost of this thread; nullptr: none.
  static Call* Now();

  /// Keeps the first error. The lock is held.
  void Keep(const pybind11::error_already_set& error);
  /// An error is kept: the called code may end.
  bool failed() const { return error_.has_value(); }
  /// The kept error is no Exception, but Ctrl-C or the interpreter's end. Then the call around this one fails, too.
  bool interrupted();
  /// The kept error, in words.
  std::string what() const;
  /// The same, and Ctrl-C: it looks for signals 50 times a second at most. The lock is not held.
  bool MustEnd();
  /// Raises the kept error. The lock is held.
  void Raise();

 private:
  Call* outer_;
  std::optional<pybind11::error_already_set> error_;
  std::chrono::steady_clock::time_point looked_;
};

/// When the interpreter ends, calls of other threads than its main one end first, as by Ctrl-C; later ones never
/// return. Called once, when the module is imported.
void HearOfTheEnd();

/// A call is under way in this thread. The lock is held.
class CallGuard {
 public:
  CallGuard();
  ~CallGuard();
  CallGuard(const CallGuard&) = delete;
  CallGuard& operator=(const CallGuard&) = delete;
};

/// The interpreter ends, and this is not its main thread.
bool MustEndWithIt();

/// Calls `work` without the lock. Errors of Python code that it calls, and Ctrl-C, are raised in the end. They precede
/// what C++ throws.
template <class Work>
auto WithoutLock(Work&& work) {
  if constexpr (!std::is_void_v<std::invoke_result_t<Work>>) {
    std::optional<std::invoke_result_t<Work>> result;
    WithoutLock([&] { result.emplace(work()); });
    return std::move(*result);
  } else {
    const CallGuard under_way;
    Call call;
    std::exception_ptr thrown;
    {
      const pybind11::gil_scoped_release release;
      try {
        work();
      } catch (...) {
        thrown = std::current_exception();
      }
    }
    call.Raise();
    if (thrown) std::rethrow_exception(thrown);
  }
}

/// Calls `work`, which uses Python, with the lock. @throws PythonRaised; where no call waits, the raised error itself
template <class Work>
auto WithLock(Work&& work) {
  Call* call = Call::Now();
  if (call != nullptr && call->failed()) throw PythonRaised("an earlier call raised");
  if (MustEndWithIt()) throw PythonRaised("the interpreter ends");
  const pybind11::gil_scoped_acquire acquire;
  try {
    return work();
  } catch (const pybind11::error_already_set& error) {
    if (call == nullptr) throw;
    const std::string what = error.what();
    call->Keep(error);
    throw PythonRaised(what);
  } catch (const pybind11::builtin_exception& error) {  // ours, about what Python returned
    if (call == nullptr) throw;
    const std::string what = error.what();
    error.set_error();
    call->Keep(pybind11::error_already_set());
    throw PythonRaised(what);
  }
}

}  // namespace touchdown::binding
