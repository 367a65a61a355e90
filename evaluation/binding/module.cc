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
  m.attr("_words") = AllWords();
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
