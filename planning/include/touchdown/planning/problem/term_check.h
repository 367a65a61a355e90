// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/solvers/backend/derivative_check.h"

namespace touchdown::planning {

/// Derivatives of a term count as right up to this relative error (DerivativeErrors). Central
/// differences of a hinge are this good at its edge, where the third derivative jumps. The worst of
/// 130 random runs over all terms was 4e-5. A wrong derivative is off by percents.
inline constexpr double kTermCheckTolerance = 1e-4;

struct TermCheckOptions {
  int control_points = 12;  ///< >= 9
  int trials = 8;           ///< random landings, >= 1
  std::uint64_t seed = 1;
};

enum class CheckedView { kFull, kReduced, kWhitened };
/// Where derivatives are compared: at a random point, at one where some u is 0 to rounding, and at
/// one just beyond it. u = 0 is the edge of a hinge or an active row.
enum class CheckedPoint { kRandom, kZero, kActive };

/// The worst errors of one kind of view, role and point.
struct TermCheckRow {
  CheckedView view = CheckedView::kFull;
  ArrivalMode arrival = ArrivalMode::kFixed;
  bool hard = false;  ///< as rows with random multipliers, else as a cost
  CheckedPoint point = CheckedPoint::kRandom;
  int points = 0;   ///< compared; 0 where no u can be brought to 0
  int windows = 0;  ///< evaluated at these points
  solvers::DerivativeErrors errors;
  bool has_edge = false;         ///< the term is a hinge: kZero is where its pieces meet
  bool claims_convex = false;    ///< TermInfo::convex, and this row is a cost at a fixed interval,
                                 ///< on the full view
  double least_curvature = 0.0;  ///< lowest eigenvalue of its Hessian over the largest, if below 0
};

/// A cost that claims to be convex may be concave by this share, which is rounding.
inline constexpr double kTermCheckConvexity = 1e-9;

/// Compares gradient, Hessian, residual and row Jacobians of a term with central differences on
/// every view, as cost and as rows. The random landings have a fixed or free end acceleration. The
/// term is made with its default parameters and weight 1. Throws std::invalid_argument if an option
/// is out of range.
std::vector<TermCheckRow> CheckTerm(const TermEntry& entry, const TermCheckOptions& options);

/// One sentence on what is wrong; empty if nothing is. Then every row that compared something is
/// within the tolerance, windows were evaluated, a hinge's edge was reached, and what claims to be
/// convex is.
std::string Complaint(const std::vector<TermCheckRow>& rows);
/// Without a complaint.
bool Passed(const std::vector<TermCheckRow>& rows);

}  // namespace touchdown::planning
