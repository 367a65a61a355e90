// SPDX-License-Identifier: BSD-3-Clause
// Look-up and range check of a backend's options.

#include "touchdown/solvers/backend/solver_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace touchdown::solvers {

namespace {

[[noreturn]] void ThrowUnknown(std::string_view name, const std::vector<OptionSpec>& specs) {
  std::string known;
  for (const OptionSpec& spec : specs) known += (known.empty() ? "" : ", ") + spec.name;
  throw std::invalid_argument("solver option " + std::string(name) +
                              " is unknown; known: " + known);
}

}  // namespace

void SolverOptions::Set(std::string_view name, double value) {
  for (OptionSpec& spec : specs_) {
    if (spec.name != name) continue;
    const bool whole = !spec.integer || value == std::floor(value);
    if (!(value >= spec.lo && value <= spec.hi) || !whole) {
      std::ostringstream text;
      text << "solver option " << name << " is " << value << ", it must be "
           << (spec.integer ? "a whole number " : "") << "in [" << spec.lo << ", " << spec.hi
           << "]";
      throw std::invalid_argument(text.str());
    }
    spec.value = value;
    return;
  }
  ThrowUnknown(name, specs_);
}

double SolverOptions::Get(std::string_view name) const {
  for (const OptionSpec& spec : specs_) {
    if (spec.name == name) return spec.value;
  }
  ThrowUnknown(name, specs_);
}

}  // namespace touchdown::solvers
