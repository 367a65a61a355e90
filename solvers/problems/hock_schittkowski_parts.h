// SPDX-License-Identifier: BSD-3-Clause
// The set is compiled in three parts.
#pragma once

#include "solvers/problems/square.h"
#include "touchdown/solvers/problems/hock_schittkowski.h"

namespace touchdown::solvers {

inline constexpr double kUnbounded = SmallProblem::kInfinity;

void AddHockSchittkowskiFirst(EqualityForm form, std::vector<ReferenceProblem>* all);
void AddHockSchittkowskiSecond(EqualityForm form, std::vector<ReferenceProblem>* all);
void AddHockSchittkowskiThird(EqualityForm form, std::vector<ReferenceProblem>* all);

}  // namespace touchdown::solvers
