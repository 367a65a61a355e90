// SPDX-License-Identifier: BSD-3-Clause
// The Python module touchdown._touchdown: what the package touchdown is made from.

#include "evaluation/base/bad_input.h"
#include "evaluation/binding/bind.h"

namespace touchdown::binding {

const char* Doc(std::string_view name) {
  const auto found = Docstrings().find(name);
  return found != Docstrings().end() ? found->second : "";
}

}  // namespace touchdown::binding

PYBIND11_MODULE(_touchdown, m) {
  using namespace touchdown::binding;
  m.doc() = "The C++ of the package touchdown.";
  m.attr("__version__") = TOUCHDOWN_VERSION;
  // Annotations of those who use it: touchdown.SolveStatus and the others.
  const py::object literal = py::module_::import("typing").attr("Literal");
  for (const auto& [name, words] : AllWords()) {
    m.attr(name.c_str()) = literal[py::tuple(py::cast(words))];
  }
  py::register_exception<touchdown::evaluation::BadInput>(m, "BadInput", PyExc_ValueError);
  BindLosses(m);
  BindSolve(m);
  BindSpline(m);
  BindMap(m);
  BindRegistries(m);
  BindLanding(m);
  BindReplan(m);
  BindOnboard(m);
  BindFlight(m);
}
