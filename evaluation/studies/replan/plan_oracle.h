// SPDX-License-Identifier: BSD-3-Clause
// Whether there is a plan at all. The success of a replanning step is counted against it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "evaluation/studies/replan/replan_scene.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// The oracle's verdict on a scene. That it found no plan proves nothing.
struct OracleVerdict {
  bool found = false;        ///< there is a plan
  std::string found_by;      ///< "path", "wide path", "motion"; empty: no plan
  bool end_blocked = false;  ///< the end is in an obstacle at every arrival that was tried
  bool cannot_stop = false;  ///< braking from the start meets an obstacle
  int solves = 0;
};

/// With the plan that it found, which has the same certificate as plans that are flown.
struct OracleAnswer : OracleVerdict {
  std::optional<planning::UniformBspline> plan;
  int tries = 0;  ///< ways times arrivals times segments that were tried
};

/// Tries many ways around obstacles, arrival times and segments, each with many rounds of binding. Takes milliseconds
/// where a plan is near and seconds where there is none. It shares with the replanning step the definition of a plan
/// (the landing problem, corridors, the certificate and its pair), but not the search.
class PlanOracle {
 public:
  /// @param options as a step has them; backend and formulation are the oracle's own: `banded`, soft limits,
  /// fixed arrivals.
  PlanOracle(const planning::ReplannerOptions& options, const solvers::BackendRegistry& backends);
  ~PlanOracle();

  OracleAnswer Ask(const ReplanScene& scene);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::evaluation
