// SPDX-License-Identifier: BSD-3-Clause
// Solver backends on one problem after another. Each is judged from outside by one merit.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "touchdown/planning/problem/term_registry.h"
#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::evaluation {

struct BenchOptions {
  std::vector<std::string> backends;  ///< none: all that can solve the formulation
  double gap = 1e-4;                  ///< of the cost, at which a problem counts as solved
  int repeats = 3;                    ///< of the timed solve; their median counts
  bool shares = true;                 ///< solve once more with a clock on the parts
  std::optional<double> deadline_ms;  ///< also solve under this wall-clock limit
  /// Wall time that a backend may use, without tight solves. A backend that used more is skipped in the remaining
  /// problems. The referees among them still help to find the reference.
  double backend_seconds = 20.0;
  std::uint64_t seed = 1;  ///< of the order in which backends take turns
};

/// What a solve was made for.
enum class SolvePhase {
  kTight,     ///< tight tolerances: for the reference cost, and to check the claim of success
  kGap,       ///< stopped from outside once it is within the gap: the time that counts
  kShares,    ///< the same, with a clock on its parts
  kDeadline,  ///< default tolerances under a wall-clock limit
};
const char* ToString(SolvePhase phase);

/// One solve. Cost, gap and violation are those of the returned point, evaluated anew outside the
/// solver.
struct SolveRow {
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
  double gap = 0.0;  ///< (cost - reference) / reference
  double max_violation = 0.0;
  bool best_returned = true;  ///< kDeadline: no feasible point that it evaluated was better
  solvers::SolveShares shares;
};

/// A problem as a planner posed it.
struct ProblemRow {
  int flight = 0;  ///< that posed it
  int solve = 0;   ///< of the flight's solves, from 0
  int points = 0;  ///< control points
  bool free_arrival = false;
  bool hard_limits = false;        ///< it has inequality rows
  bool explicit_endpoint = false;  ///< its variables are all control points
  int pairs = 0;                   ///< windows of its clearance terms
  double duration_s = 0.0;         ///< at the start
  double start_gap = 0.0;          ///< of the start; NaN where it is not feasible
  bool standing = false;           ///< the start is within the gap: nothing to time
  double reference_cost = 0.0;     ///< NaN: no backend found a feasible point
  std::string reference_backend;   ///< whose tight solve it is
  int reference_solves = 0;        ///< tight solves that it is the best of
};

/// A backend that was not compared, or only on some of the problems, and the sentence why.
struct Refusal {
  std::string backend;
  std::string reason;
};

struct BenchResult {
  std::vector<std::string> backends;  ///< compared, in the order of the registry
  std::vector<ProblemRow> problems;
  std::vector<SolveRow> solves;
  std::vector<Refusal> refusals;
  int refused = 0;  ///< problems that no compared backend could take
};

/// All backends of a registry. They solve the problems that they are shown, in place. They take turns in a random order
/// that repeats with the seed, so that disturbances of the machine meet all of them.
class SolverBench {
 public:
  /// `terms` says which of a problem's terms keep it clear of obstacles. Throws BadInput if a backend is
  /// unknown or named twice.
  SolverBench(const BenchOptions& options, const solvers::BackendRegistry& registry,
              const planning::TermRegistry& terms);
  ~SolverBench();

  /// Solves the asked problem with every backend. `flight` and `solve` say where it comes from.
  void Run(const solvers::SolveRequest& asked, int flight, int solve);

  const BenchResult& result() const { return result_; }

 private:
  struct BenchBackend;
  struct Field;
  struct Merit;

  Field& FieldFor(const solvers::SolveRequest& asked);
  void Enter(const solvers::BackendEntry& entry, const solvers::View& view, Field* field);
  Merit Judge(const Eigen::VectorXd& y);
  SolveRow Solve(BenchBackend* backend, SolvePhase phase, const solvers::Stop& stop);
  ProblemRow Facts(const solvers::View& view);
  void FindReference(ProblemRow* row);
  void SolveToGap(BenchBackend* backend, const ProblemRow& row, int repeat, bool shares);
  void SolveUnderDeadline(BenchBackend* backend, const ProblemRow& row, int repeat);
  void Rate(const ProblemRow& row, SolveRow* solve) const;
  void EndTurns();
  std::vector<BenchBackend*> Shuffled(SolvePhase phase, int repeat);
  bool Compares(const std::string& name) const;
  int index() const { return static_cast<int>(result_.problems.size()); }

  BenchOptions options_;
  solvers::BackendRegistry registry_;
  std::set<std::string> clearance_terms_;
  std::vector<Field> fields_;              // one for each structure
  std::map<std::string, double> seconds_;  // used so far, without the tight solves
  std::set<std::string> out_;              // of all but FindReference
  BenchResult result_;

  // The problem at hand.
  const solvers::SolveRequest* asked_ = nullptr;
  Field* field_ = nullptr;
  solvers::SolverResult solver_;
};

}  // namespace touchdown::evaluation
