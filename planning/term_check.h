// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "touchdown/planning/landing_problem.h"
#include "touchdown/solvers/derivative_check.h"

namespace touchdown::planning {

/// Derivatives of a term count as right up to this relative error (DerivativeErrors).
inline constexpr double kTermCheckTolerance = 2e-5;

struct TermCheckOptions {
  int control_points = 12;  ///< >= 9
  int trials = 8;           ///< random landings, >= 1
  std::uint64_t seed = 1;
};

enum class CheckedView { kFull, kReduced, kWhitened };
/// Where derivatives are compared: at a random point, at one where some u is 0 to rounding (the
/// edge of a hinge, an active row), and at one just beyond it.
enum class CheckedPoint { kRandom, kZero, kActive };

/// The worst errors of one kind of view, role and point.
struct TermCheckRow {
  CheckedView view = CheckedView::kFull;
  ArrivalMode arrival = ArrivalMode::kFixed;
  bool hard = false;  ///< as rows with random multipliers, else as a cost
  CheckedPoint point = CheckedPoint::kRandom;
  int points = 0;  ///< compared; 0 where no u can be brought to 0
  solvers::DerivativeErrors errors;
};

/// Compares gradient, Hessian, residual and row Jacobians of a term with central differences on
/// every view, as cost and as rows, in random landings. The term is made with its default
/// parameters and weight 1. Throws std::invalid_argument if an option is out of range.
std::vector<TermCheckRow> CheckTerm(const TermEntry& entry, const TermCheckOptions& options);

/// Every row that compared something is within the tolerance.
bool Passed(const std::vector<TermCheckRow>& rows);

}  // namespace touchdown::planning
