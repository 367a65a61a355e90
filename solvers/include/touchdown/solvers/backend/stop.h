// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <span>

namespace touchdown::solvers {

/// What a stop callback is shown at each evaluation.
struct StopQuery {
  std::span<const double> y;  ///< variables of the view
  double cost = 0.0;
  double max_violation = 0.0;            ///< of the constraint rows
  std::span<const double> cost_by_term;  ///< in the order of the problem's terms
  int evaluations = 0;
};

/// When a solve must end, whatever its own stop test says, and how it is watched. Budgets in
/// iterations or evaluations are deterministic; a wall-clock limit is not.
struct Stop {
  double wall_limit_s = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
  int max_evaluations = std::numeric_limits<int>::max();
  std::function<bool(const StopQuery&)> callback;  ///< true: stop now
  /// Ends the solve at a point that keeps the rows and is above the optimum by at most this share
  /// of its cost (GapRule). The rule is the same for all backends, and such a point is not
  /// confirmed. 0: there is no such rule. In [0, 1).
  double gap = 0.0;
  /// Check the point of a backend that says converged (OptimalityCheck). Otherwise the backend's
  /// claim stands, and no words say what failed: for callers that judge the point themselves, as a
  /// replanning step does.
  bool confirm = true;
  bool trace = false;   ///< record every iteration in the result (allocates)
  bool shares = false;  ///< time the solve's parts in the result (reads the clock often)
};

}  // namespace touchdown::solvers
