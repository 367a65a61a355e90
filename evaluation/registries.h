// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/term_registry.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// What the program offers: an out-of-tree project adds its own entries and has every sub-command.
struct Registries {
  solvers::BackendRegistry backends;
  planning::TermRegistry terms;
};

/// What the library ships.
inline Registries StandardRegistries() {
  return {solvers::StandardBackends(), planning::StandardTerms()};
}

}  // namespace touchdown::evaluation
