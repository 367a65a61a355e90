// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// The options of the landing problems that a replanner with these options solves.
LandingProblemOptions ProblemOptions(const ReplannerOptions& options, ArrivalMode arrival);

/// Number of segments of a plan with this duration [s] at these limits. A segment takes at most `share` of the time
/// for `longest` [m] at full speed, or at 2.5 m/s if that is faster.
int SegmentsFor(double duration, const Limits& limits, double share, double longest);

/// A landing problem and its backend, to be solved again and again.
struct PreparedProblem {
  std::unique_ptr<LandingProblem> problem;
  std::unique_ptr<solvers::SolverBackend> backend;
  solvers::WarmStart start{Eigen::VectorXd()};  // of the next solve
  solvers::SolverResult solver;                 // of the last
  Eigen::VectorXd first_guess;                  // of the solves with pairs
};

/// One for every number of segments that SegmentsFor gives and every arrival that a replanner may ask for. They are
/// made beforehand: refusals appear at once, and nothing is built in flight. A free arrival falls back to a fixed
/// one.
class PreparedProblems {
 public:
  /// Throws std::invalid_argument if the backend does not exist or cannot do what the options ask.
  PreparedProblems(const ReplannerOptions& options, const solvers::BackendRegistry& backends);

  PreparedProblem& At(int segments, ArrivalMode arrival) {
    return prepared_.at({segments, arrival});
  }

 private:
  std::map<std::pair<int, ArrivalMode>, PreparedProblem> prepared_;
};

}  // namespace touchdown::planning
