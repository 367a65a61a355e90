// SPDX-License-Identifier: BSD-3-Clause
// Solver backends on the same random landing problems, each judged from outside by one merit.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "touchdown/evaluation/landing_case.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/solver_result.h"

namespace touchdown::evaluation {

struct CompareOptions {
  CaseOptions cases;
  int problems = 20;
  std::vector<int> points = {20};     ///< control points, each in [9, 1000]
  std::vector<std::string> backends;  ///< none: all that can solve the formulation
  double gap = 1e-4;                  ///< of the cost, at which a problem counts as solved
  int repeats = 3;                    ///< of the timed solve; their median counts
  std::optional<double> deadline_ms;  ///< also solve under this wall-clock limit
  /// Wall time that a backend may use at one number of points, tight solves not counted: one that
  /// used more sits out the remaining problems, and all larger sizes. The referees among them still
  /// help to find the reference.
  double backend_seconds = 20.0;
};

/// What a solve was made for.
enum class SolvePhase {
  kTight,     ///< tight tolerances: the reference cost, and whether success is told rightly
  kGap,       ///< stopped from outside once it is within the gap: the time that counts
  kShares,    ///< the same, with a clock on its parts
  kDeadline,  ///< default tolerances under a wall-clock limit
};
const char* ToString(SolvePhase phase);

/// One solve. Cost, gap, residuals and violation are those of the returned point, evaluated anew
/// outside the solver.
struct SolveRow {
  int points = 0;
  int problem = 0;
  std::string backend;
  SolvePhase phase = SolvePhase::kTight;
  int repeat = 0;
  solvers::SolveStatus status = solvers::SolveStatus::kNumericalFailure;
  bool reached = false;  ///< the returned point is feasible and within the gap
  double cpu_ms = 0.0;   ///< thread CPU time of the call
  double wall_ms = 0.0;
  int iterations = 0;
  int evaluations = 0;
  double cost = 0.0;
  double gap = 0.0;             ///< (cost - reference) / reference
  double end_position_m = 0.0;  ///< of the curve at its end, off the predicted pad
  double end_velocity_mps = 0.0;
  double max_violation = 0.0;
  bool best_returned = true;  ///< kDeadline: no feasible point that it evaluated was better
  solvers::SolveShares shares;
};

struct ProblemRow {
  int points = 0;
  LandingCase made;
  double reference_cost = 0.0;    ///< NaN: no backend found a feasible point
  std::string reference_backend;  ///< whose tight solve it is
  int reference_solves = 0;       ///< tight solves that it is the best of
};

/// A backend that was not compared, or only on some of the problems, and the sentence why.
struct Refusal {
  int points = 0;
  std::string backend;
  std::string reason;
};

struct CompareResult {
  std::vector<std::string> backends;  ///< compared, in the order of the registry
  std::vector<ProblemRow> problems;
  std::vector<SolveRow> solves;
  std::vector<Refusal> refusals;
};

/// Solves every problem with every backend. Backends take turns problem by problem in a random order
/// that repeats with the seed, so that what disturbs the machine meets all of them. `report(done, all)` is called after each problem.
/// Throws BadInput if a backend is unknown or named twice, or none can solve the formulation.
CompareResult RunCompare(const CompareOptions& options, const solvers::BackendRegistry& registry,
                         const std::function<void(int done, int all)>& report);

}  // namespace touchdown::evaluation
