// SPDX-License-Identifier: BSD-3-Clause
// Shared by the parts of the Python module.
#pragma once

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "evaluation/binding/docstrings.h"
#include "evaluation/binding/words.h"

namespace touchdown::binding {

namespace py = pybind11;

/// An object that several calls may share, or that one call alone may change. Meanwhile other calls raise RuntimeError,
/// from another thread as well as from a term, planner or callback within the call.
class InUse {
 public:
  explicit InUse(const char* name) : name_(name) {}

  /// No other call may use it.
  class Claim {
   public:
    explicit Claim(InUse& of) : of_(of) {
      int none = 0;
      if (!of.users_.compare_exchange_strong(none, kAlone)) of.Refuse();
    }
    ~Claim() { of_.users_ = 0; }
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;

   private:
    InUse& of_;
  };
  /// Others may look at it, too.
  class Share {
   public:
    explicit Share(InUse& of) : of_(of) {
      int users = of.users_;
      do {
        if (users == kAlone) of.Refuse();
      } while (!of.users_.compare_exchange_weak(users, users + 1));
    }
    ~Share() { --of_.users_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    InUse& of_;
  };

 private:
  static constexpr int kAlone = -1;
  [[noreturn]] void Refuse() const {
    throw std::runtime_error(std::string("this ") + name_ + " is in use by another call");
  }

  const char* name_;
  std::atomic<int> users_ = 0;
};

/// Something of C++ that Python may use during one call, in the thread that was called.
template <class T>
class Borrowed {
 public:
  void Lend(const T* it) {
    it_ = it;
    to_ = std::this_thread::get_id();
  }
  void Return() { it_ = nullptr; }

  /// Raises RuntimeError if the caller may not use it. `name`: "this map".
  const T& get(const char* name) const {
    if (it_ == nullptr) {
      throw std::runtime_error(std::string(name) + " is of a call that has ended");
    }
    if (std::this_thread::get_id() != to_) {
      throw std::runtime_error(std::string(name) + " is lent to the thread that was called");
    }
    return *it_;
  }

 private:
  const T* it_ = nullptr;
  std::thread::id to_;
};

/// A class of plain data: attributes, of which the constructor takes any by name, and a text.
template <class T>
class Plain {
 public:
  Plain(py::module_& m, const char* name) : class_(m, name, Doc(name)), name_(name) {}

  template <class Owner, class Member>
  Plain& Field(const char* name, Member Owner::*member, const char* doc = nullptr) {
    class_.def_readwrite(name, member, doc ? doc : DocOf(name));
    names_.append(name);
    return *this;
  }
  /// The type that Python sets and gets differs from the type that is held.
  template <class Get, class Set>
  Plain& Field(const char* name, Get get, Set set, const char* doc = nullptr) {
    class_.def_property(name, get, set, doc ? doc : DocOf(name));
    names_.append(name);
    return *this;
  }
  /// Read-only.
  template <class Get>
  Plain& Look(const char* name, Get get, const char* doc = nullptr) {
    class_.def_property_readonly(name, get, doc ? doc : DocOf(name));
    return *this;
  }

  /// With its constructor and text.
  py::class_<T>& Done() {
    class_.attr("_fields") = py::tuple(names_);
    class_.def(py::init([](const py::kwargs& values) {
                 T made{};
                 Fill(values, &made);
                 return made;
               }),
               "Every attribute may be given by its name.");
    class_.def("__repr__", [](const py::object& self) {
      std::string text = py::str(py::type::of(self).attr("__name__"));
      const char* before = "(";
      for (const py::handle& name : py::type::of(self).attr("_fields")) {
        text += before + std::string(py::str(name)) + "=" +
                std::string(py::repr(self.attr(name.cast<py::str>())));
        before = ", ";
      }
      return text + (before[0] == '(' ? "()" : ")");
    });
    class_.def(py::pickle(
        [](const py::object& self) {
          py::dict values;
          for (const py::handle& name : py::type::of(self).attr("_fields")) {
            values[name] = self.attr(name.cast<py::str>());
          }
          return values;
        },
        [](const py::dict& values) {
          T made{};
          Fill(values, &made);
          return made;
        }));
    class_.def("__copy__", [](const T& self) { return T(self); });
    class_.def("__deepcopy__", [](const T& self, const py::dict&) { return T(self); });
    return class_;
  }

 private:
  const char* DocOf(const char* name) const { return Doc(name_ + "::" + name); }
  static void Fill(const py::dict& values, T* made) {
    const py::object self = py::cast(made, py::return_value_policy::reference);
    for (const auto& [name, value] : values) {
      const py::object fields = py::type::of(self).attr("_fields");
      if (!fields.contains(name)) {
        throw py::type_error(std::string(py::str(py::type::of(self).attr("__name__"))) +
                             " has no " + std::string(py::str(name)) + ", it has " +
                             std::string(py::str(py::str(", ").attr("join")(fields))));
      }
      try {
        py::setattr(self, name, value);
      } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_TypeError)) throw;
        throw py::type_error(std::string(py::str(py::type::of(self).attr("__name__"))) + ": " +
                             std::string(py::str(name)) + " is " + std::string(py::repr(value)) +
                             ", which is of another type or shape");
      }
    }
  }

  py::class_<T> class_;
  std::string name_;
  py::list names_;
};

/// A copy as an array of the last shape.
inline py::array_t<double> Array(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

/// A path or a name as text. Raises TypeError and ValueError for what cannot be one.
inline std::string PathOf(const py::object& path) {
  const py::object text = py::module_::import("os").attr("fspath")(path);
  if (!py::isinstance<py::str>(text)) throw py::type_error("a path must be text");
  auto plain = text.cast<std::string>();
  if (plain.find('\0') != std::string::npos) {
    throw py::value_error("a path holds a null character");
  }
  return plain;
}

void BindLosses(py::module_& m);
void BindSolve(py::module_& m);
void BindSpline(py::module_& m);
void BindLanding(py::module_& m);
void BindMap(py::module_& m);
void BindReplan(py::module_& m);
void BindOnboard(py::module_& m);
void BindRegistries(py::module_& m);
void BindFlight(py::module_& m);

}  // namespace touchdown::binding
