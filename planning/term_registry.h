// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/term.h"

namespace touchdown::planning {

/// The cost terms a landing problem can be built from: an explicit list, passed as a value.
/// evaluation's program lists it, and the derivative checks run over it.
using TermRegistry = std::vector<solvers::TermFactory>;

/// Every term shipped with the library.
TermRegistry StandardTerms();

}  // namespace touchdown::planning
