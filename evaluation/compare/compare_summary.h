// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/base/statistics.h"
#include "evaluation/compare/solver_bench.h"

namespace touchdown::evaluation {

/// Parts of the wall time of a solve; they add up to 1.
struct ShareSummary {
  double evaluation = 0.0;
  double whitening = 0.0;
  double native = 0.0;
  double adapter = 0.0;
};

/// The results of the solves under a deadline.
struct DeadlineSummary {
  Quantiles wall_ms;  ///< until the call returned
  Quantiles gap;      ///< of the returned point; infinite where it is not feasible
  int solves = 0;
  int best_returned = 0;  ///< solves that returned the best feasible point they evaluated
};

/// One backend over all problems.
struct BackendSummary {
  std::string backend;
  int problems = 0;      ///< run, with a reference, and with something to do
  bool ran_all = false;  ///< else its figures are not to be set beside those of others
  int solved = 0;        ///< within the gap, feasible, in the median of the repeats
  Interval solved_interval;
  Quantiles cpu_ms;  ///< to the gap, a failure's time infinite
  Quantiles wall_ms;
  Quantiles iterations;   ///< of the solved ones, to the gap
  Quantiles evaluations;  ///< of the solved ones, to the gap
  /// Tight solves that called themselves converged; also where no backend found a feasible point.
  int reported_success = 0;
  int agreeing = 0;     ///< of these, within 1e-4 of the reference
  Quantiles tight_gap;  ///< of the tight solves; infinite where the point is not feasible
  Quantiles tight_cpu_ms;
  double violation_max = 0.0;  ///< of the points that counted as solved
  std::optional<ShareSummary> shares;
  std::optional<double> ms_per_iteration;  ///< median over the tight solves, CPU time
  std::optional<DeadlineSummary> deadline;
};

/// Problems with a reference and with something to do: those that are timed.
int TimedProblems(const BenchResult& result);

/// All backends of the result, in its order.
std::vector<BackendSummary> Summarise(const BenchResult& result);

/// Median CPU time per iteration of the tight solves, by control points [ms], of sizes with at least five
/// problems.
std::map<int, double> TimePerIteration(const BenchResult& result, const std::string& backend);

}  // namespace touchdown::evaluation
