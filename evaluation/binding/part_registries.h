// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/python_term.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::binding {

/// What a Python program offers: the library's parts, and its own in Python.
struct PartRegistries {
  evaluation::Registries all = evaluation::StandardRegistries();
  std::set<std::string> own;                                    ///< names of what was entered
  std::map<std::string, std::shared_ptr<TermTime>> term_times;  ///< of terms of Python
  InUse use{"Registries"};
};

/// {name: {"weight": ..., "hard": ..., parameter: ...}}
std::vector<planning::TermSettings> TermSettingsOf(const pybind11::dict& terms);

}  // namespace touchdown::binding
