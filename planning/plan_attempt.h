// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "touchdown/planning/certificate.h"
#include "touchdown/planning/collision_pairs.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/landing_problem.h"
#include "touchdown/planning/replan_log.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// The options of the landing problems that a replanner with these options solves.
LandingProblemOptions ProblemOptions(const ReplannerOptions& options, ArrivalMode arrival);

/// What one attempt is made with.
struct AttemptRequest {
  SplineState start;
  double t0 = 0.0;
  const estimation::PadPrediction* pad = nullptr;
  EndpointTarget target;
  double duration = 1.0;  ///< T, or its first guess [s]
  ArrivalMode arrival = ArrivalMode::kFixed;
  const FreeSpace* space = nullptr;
  const UniformBspline* previous = nullptr;  ///< committed curve: the guide of choice while clear
  AttemptLog* log = nullptr;                 ///< filled if not null (allocates)
};

/// Solve, check the whole curve, bind pairs where it is blocked, solve again, until it is clear or
/// out of rounds; then certify. Keeps one prepared problem and backend per number of segments.
class PlanAttempt {
 public:
  PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends);

  /// Tries once; fills curve, certificate, pairs, guide paths, solver, counts and times of `result`
  /// (adding to counts and times). Returns kNone when the certificate passed.
  ReplanReason Run(const AttemptRequest& request, ReplanResult* result);

 private:
  struct Prepared {
    std::unique_ptr<LandingProblem> problem;
    std::unique_ptr<solvers::SolverBackend> backend;
  };
  void Prepare(int segments, ArrivalMode arrival);
  ReplanReason Try(const AttemptRequest& request, ReplanResult* result);
  ReplanReason Bind(const AttemptRequest& request, const UniformBspline& curve,
                    std::size_t max_pairs, ReplanResult* result);
  ReplanReason FindGuide(const AttemptRequest& request, const UniformBspline& curve,
                         const BlockedRun& run, GuidePath* guide, ReplanResult* result);

  ReplannerOptions options_;
  solvers::BackendRegistry backends_;
  std::map<std::pair<int, ArrivalMode>, Prepared> prepared_;
  GridSearch search_;
  int expansions_left_ = 0;      // of this attempt
  bool previous_clear_ = false;  // the committed curve can serve as a guide
  std::vector<BlockedRun> runs_;
  std::vector<ObstaclePair> pairs_;
};

}  // namespace touchdown::planning
