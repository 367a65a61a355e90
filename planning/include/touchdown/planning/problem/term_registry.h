// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

/// The terms a landing problem can be built from: an explicit list, passed as a value. The program
/// lists it, flies it and checks its derivatives.
using TermRegistry = std::vector<TermEntry>;

/// Every term shipped with the library, from planning/problem/terms.def.
TermRegistry StandardTerms();

/// Throws std::invalid_argument naming a term whose name is in the registry twice.
void RequireDistinct(const TermRegistry& registry);

/// The entry of that name. Throws std::invalid_argument naming the known ones.
const TermEntry& FindTerm(const TermRegistry& registry, std::string_view name);
const TermEntry& FindTerm(TermRegistry&& registry,
                          std::string_view name) = delete;  // it would dangle

/// A setup with the entry's defaults; a weight of 1 where the entry is off by default.
TermSetup DefaultSetup(const TermEntry& entry, int control_points);

/// Applies `settings` to `setup`, which was made for `entry`. Throws std::invalid_argument naming
/// what is unknown or out of range, and what is known or allowed.
void ApplySettings(const TermEntry& entry, const TermSettings& settings, TermSetup* setup);

}  // namespace touchdown::planning
