// SPDX-License-Identifier: BSD-3-Clause
// A log of a replanning step: what it tried on the way to its answer. Plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/problem/landing_term.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/planning/spline/uniform_bspline.h"
#include "touchdown/solvers/backend/solver_result.h"

namespace touchdown::planning {

/// One solve and the check of its curve.
struct RoundLog {
  double pressure = 1.0;            ///< factor on the weight of the pairs
  double limit_pressure = 1.0;      ///< factor on the weight of soft limits
  std::vector<ObstaclePair> pairs;  ///< that were bound in the solve
  solvers::SolverResult solver;     ///< with its trace
  UniformBspline curve;             ///< if the solver's point was usable
  std::vector<BlockedRun> blocked;  ///< stretches of the curve
  int guide = 0;                    ///< which way around the first obstacle it follows
};

/// One arrival time that was tried.
struct AttemptLog {
  double duration = 0.0;  ///< T, or its first guess [s]
  ArrivalMode arrival = ArrivalMode::kFixed;
  int segments = 0;  ///< of all rounds but the first, which may have had fewer
  std::vector<RoundLog> rounds;
  int best = -1;                           ///< the round that the answer is from; -1: none
  std::optional<Certificate> certificate;  ///< of that round, if it came to one
  ReplanReason reason = ReplanReason::kNone;
  std::string forbidden_by;  ///< as in ReplanResult
};

struct ReplanLog {
  std::vector<AttemptLog> attempts;
};

}  // namespace touchdown::planning
