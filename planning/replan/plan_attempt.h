// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planning/replan/pair_binder.h"
#include "planning/replan/prepared_problems.h"
#include "planning/search/path_finder.h"
#include "planning/search/timed_path.h"
#include "planning/search/work_budget.h"
#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/replan/replan_log.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// The inputs of one attempt.
struct AttemptRequest {
  SplineState start;
  double t0 = 0.0;
  double reaction = 0.0;  ///< after which the plan's stop begins [s]
  const estimation::PadPrediction* pad = nullptr;
  EndpointTarget target;
  Limits limits;  ///< what the pull leaves of the options' (LimitsUnder)
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();  ///< steady force over the mass [m/s^2]
  double duration = 1.0;                             ///< T, or its first guess [s]
  int segments = 0;                                  ///< as SegmentsFor gives them ...
  int near_segments = 0;                             ///< ... and where an obstacle is near
  ArrivalMode arrival = ArrivalMode::kFixed;
  const FreeSpace* space = nullptr;
  const HullSpace* hull = nullptr;  ///< of `space`: where the plan's pair is to be proven
  PairEnd pair_end = PairEnd::kRest;
  const UniformBspline* previous = nullptr;  ///< committed curve ...
  bool starts_on_previous = false;           ///< ... which is the way of choice then ...
  const BoundParts* bound = nullptr;         ///< ... and what it was bound to
  bool keeps = false;                        ///< it may be kept while it holds
  bool looks = true;  ///< for the best way anew; else what is committed is kept while it holds
  AttemptLog* log = nullptr;  ///< filled if not null (allocates)
};

/// Why there is no plan; kNone: there is one.
struct Refusal {
  Refusal(ReplanReason why, std::string_view by = {})
      : reason(why), forbidden_by(by) {}            // NOLINT: a reason is one
  operator ReplanReason() const { return reason; }  // NOLINT
  ReplanReason reason;
  std::string_view forbidden_by;  ///< as in ReplanResult
};

/// One attempt at a plan, in stages (plan_attempt.cc). It poses the problem, solves it without obstacles, and lays
/// ways past what blocks that. It follows each with pairs that are bound along it until the curve is clear. It
/// certifies, and chooses the cheapest that is certified. Another side than the one flown already has to be much
/// cheaper. Keeps one prepared problem and backend per number of segments.
class PlanAttempt {
 public:
  static constexpr int kMostControlPoints = PairBinder::kMostControlPoints;  ///< of a plan

  PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends);
  PlanAttempt(const PlanAttempt&) = delete;  // its parts take from one budget
  PlanAttempt& operator=(const PlanAttempt&) = delete;

  /// Makes room for searches on maps with this one's window.
  void Prepare(const OccupancyMap& map) { finder_.Prepare(map); }

  /// All attempts until the next call share the step's budget.
  void BeginStep(int work) {
    budget_.Refill(work);
    spent_ = false;
  }
  /// An attempt of this step ended because its budget was used up.
  bool spent() const { return spent_; }
  /// Of this step's budget.
  int work() const { return budget_.done(); }

  /// Tries once. Fills curve with its stop, certificate, pairs, guide paths, solver, counts and times of `result`
  /// (adding to counts and times). Returns kNone when the certificate passed. Does not allocate, once its buffers
  /// have grown, if the backend does not.
  ReplanReason Run(const AttemptRequest& request, ReplanResult* result);

  /// Duration of the plan that the last attempt tried [s]: as requested, or later where the way around took longer or
  /// the arrival was free.
  double duration() const { return duration_; }

 private:
  /// Factors on weights.
  struct Pressure {
    double pairs = 1.0;
    double limits = 1.0;
  };

  /// A problem with its ends set, and the point that the next solve of it starts from.
  struct Posed {
    PreparedProblem* prepared = nullptr;
    int segments = 0;
  };

  /// A plan on its way through the stages.
  struct Candidate {
    std::vector<ObstaclePair> pairs;
    Pressure pressure;
    FlightPair pair;
    std::vector<BlockedRun> blocked;  // of its curve
    std::optional<Certificate> certificate;
    solvers::SolverSummary solver;
    BoundParts bound;
    bool solved = false;
    int round = -1;  // of the log
    Refusal refusal = ReplanReason::kNone;
  };

  static void Begin(Candidate* candidate);

  Refusal Try(const AttemptRequest& request, ReplanResult* result);
  Refusal FindAnew(const AttemptRequest& request, const UniformBspline* warm, bool leads_around,
                   ReplanResult* result);

  ReplanReason Pose(const AttemptRequest& request, int segments, Posed* posed);
  Refusal SolveWithoutPairs(const AttemptRequest& request, int segments,
                            const UniformBspline* guess, Posed* posed, Candidate* candidate,
                            ReplanResult* result);
  Refusal Refine(const AttemptRequest& request, Posed* posed, Candidate* candidate,
                 ReplanResult* result);
  void KeepPath(const AttemptRequest& request, ReplanResult* result);
  ReplanReason LayPath(const AttemptRequest& request, const BlockedRun& span, double max_cost,
                       ReplanResult* result);
  void Postpone(const TimedPath& way, Posed* posed, AttemptRequest* request);
  Refusal KeepCommitted(const AttemptRequest& request, ReplanResult* result);
  Refusal TryPaths(const AttemptRequest& request, Posed* posed, ReplanResult* result);
  Refusal Follow(const AttemptRequest& request, const TimedPath& way, const BoundParts& more,
                 double latest, const Posed& posed, Candidate* candidate, ReplanResult* result);
  ReplanReason BindBlocked(const AttemptRequest& request, const TimedPath& way,
                           const Candidate& candidate);
  Refusal Solve(const AttemptRequest& request, const Posed& posed, Candidate* candidate,
                ReplanResult* result);
  Refusal KeepLimits(const AttemptRequest& request, const Posed& posed, Candidate* candidate,
                     ReplanResult* result);
  Refusal Finish(const AttemptRequest& request, const Posed& posed, Candidate* candidate,
                 ReplanResult* result);
  double CostOfShape(const solvers::SolverSummary& solver) const;
  bool Better(const Candidate& a, const Candidate& b, bool keeps_side) const;

  ReplannerOptions options_;
  PreparedProblems problems_;
  WorkBudget budget_;  // of the step
  PathFinder finder_;
  PairBinder binder_;
  std::vector<std::string> pressed_;  // terms whose weights are scaled

  // Room of the attempt under way.
  double duration_ = 0.0;
  int segments_ = 0;
  bool spent_ = false;
  Candidate best_, other_;
  UniformBspline first_curve_;  // before any pair
  TimedPath kept_, way_;
  bool kept_asked_ = false;
  FreeSpace later_space_;
  GuidePath path_;
};

}  // namespace touchdown::planning
