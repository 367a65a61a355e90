// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// One backend, found by its name.
struct BackendEntry {
  std::string name;
  std::string description;  ///< one line: method and natural use
  std::function<std::unique_ptr<SolverBackend>()> make;
};

/// The backends a program offers: an explicit list, passed as a value.
using BackendRegistry = std::vector<BackendEntry>;

/// Every backend of the library, those not compiled in included.
BackendRegistry StandardBackends();

/// The same backends; `listener` is called before every solve of instances made by the new registry.
BackendRegistry Overheard(const BackendRegistry& registry, const SolveListener& listener);

/// A new instance of the named backend. Throws std::invalid_argument naming the known ones.
std::unique_ptr<SolverBackend> MakeBackend(const BackendRegistry& registry,
                                           const std::string& name);

}  // namespace touchdown::solvers
