// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/problems/reference_problem.h"

namespace touchdown::solvers {

/// Problems of W. Hock, K. Schittkowski, "Test Examples for Nonlinear Programming Codes", Springer
/// 1981, with at most 10 variables, by their numbers: HS1 to HS113. Three kinds are left out:
/// problems that no multipliers certify (HS13), tables of data, and near relatives of others.
std::vector<ReferenceProblem> HockSchittkowski(EqualityForm form = EqualityForm::kRows);

}  // namespace touchdown::solvers
