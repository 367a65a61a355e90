// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "touchdown/solvers/backend/solver_backend.h"

namespace touchdown::solvers {

/// Stands in for a backend whose library was left out at configure time: it has the name, and
/// refuses every view with a sentence.
std::unique_ptr<SolverBackend> MakeMissingBackend(const std::string& name);

}  // namespace touchdown::solvers
