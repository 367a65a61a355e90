// SPDX-License-Identifier: BSD-3-Clause
// The Python module touchdown._touchdown: what the package touchdown is made from.
#include <stdexcept>

#include "evaluation/base/bad_input.h"
#include "evaluation/binding/bind.h"

namespace touchdown::binding {

const char* Doc(std::string_view name) {
  const auto found = Docstrings().find(name);
  if (found != Docstrings().end()) return found->second;
  throw std::logic_error("no header says anything of " + std::string(name));
}

}  // namespace touchdown::binding

PYBIND11_MODULE(_touchdown, m) {
  using namespace touchdown::binding;
  m.doc() = "The C++ of the package touchdown.";
  m.attr("__version__") = TOUCHDOWN_VERSION;
  py::register_exception<touchdown::evaluation::BadInput>(m, "BadInput", PyExc_ValueError);
  BindLosses(m);
  BindSolve(m);
}
