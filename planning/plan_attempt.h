// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "touchdown/planning/certificate.h"
#include "touchdown/planning/guide_finder.h"
#include "touchdown/planning/landing_problem.h"
#include "touchdown/planning/pair_binder.h"
#include "touchdown/planning/prepared_problems.h"
#include "touchdown/planning/replan_log.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/planning/stored_stop.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// What one attempt is made with.
struct AttemptRequest {
  SplineState start;
  double t0 = 0.0;
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
  int rescue_guides = 1;  ///< ways that are tried while none of max_guides leads to a plan
  PairEnd pair_end = PairEnd::kRest;
  bool at_rest = false;                      ///< there is time to look for long ways round
  const UniformBspline* previous = nullptr;  ///< committed curve: the guide of choice ...
  const BoundParts* bound = nullptr;         ///< ... and what it was bound to
  bool looks = true;  ///< for the best way anew; else what is committed is kept while it holds
  AttemptLog* log = nullptr;  ///< filled if not null (allocates)
};

/// Solve, check the whole curve, bind pairs where it is blocked, solve again, until it is clear or
/// out of rounds; then certify. Where the straight way is blocked, up to max_guides ways around the
/// first obstacle are tried like that, each a candidate, and the cheapest that is certified wins;
/// against the side that is flown already another has to be much cheaper. Keeps one prepared problem
/// and backend per number of segments.
class PlanAttempt {
 public:
  static constexpr int kMostControlPoints = PairBinder::kMostControlPoints;  ///< of a plan

  PlanAttempt(const ReplannerOptions& options, const solvers::BackendRegistry& backends);

  /// Makes room for searches on maps with this one's window.
  void Prepare(const OccupancyMap& map) { finder_.Prepare(map); }

  /// All attempts until the next call share max_expansions.
  void RefillExpansions() { finder_.Refill(options_.max_expansions); }

  /// Tries once; fills curve with its stop, certificate, pairs, guide paths, solver, counts and times of `result`
  /// (adding to counts and times). Returns kNone when the certificate passed. With a backend that
  /// does not allocate it does not either, once its buffers have grown.
  ReplanReason Run(const AttemptRequest& request, ReplanResult* result);

  /// Of the plan that the last attempt tried [s]: as requested, or later where the way round took longer or
  /// the arrival was free.
  double duration() const { return duration_; }

 private:
  /// A plan that was tried, and how it ended.
  struct Candidate {
    FlightPair pair;
    std::optional<Certificate> certificate;
    solvers::SolverSummary solver;
    int pairs = 0;
    BoundParts bound;
    bool solved = false;
    int round = -1;  // of the log
    ReplanReason reason = ReplanReason::kNone;
  };

  void Clear(Candidate* candidate) const;

  /// Factors on weights.
  struct Pressure {
    double pairs = 1.0;
    double limits = 1.0;
  };

  ReplanReason SetEnds(const AttemptRequest& request);
  ReplanReason SolveWithoutPairs(const AttemptRequest& request, const UniformBspline* guess,
                                 ReplanResult* result);
  ReplanReason Refine(const AttemptRequest& request, ReplanResult* result);
  bool ObstacleNear(const AttemptRequest& request) const;
  ReplanReason Try(const AttemptRequest& request, ReplanResult* result);
  ReplanReason KeepCommitted(const AttemptRequest& request, ReplanResult* result);
  ReplanReason TryGuides(const AttemptRequest& request, ReplanResult* result);
  ReplanReason SolveAndCheck(const AttemptRequest& request, Candidate* candidate,
                             ReplanResult* result);
  ReplanReason KeepLimits(const AttemptRequest& request, Candidate* candidate,
                          ReplanResult* result);
  void Postpone(const BlockedRun& span, AttemptRequest* request);
  /// What the pairs of the first round lead along.
  enum class Lead { kGuide, kCommitted };
  ReplanReason Follow(const AttemptRequest& request, Lead lead, Candidate* candidate,
                      ReplanResult* result);
  ReplanReason Bind(const AttemptRequest& request, const UniformBspline& curve,
                    std::optional<Lead> lead, ReplanResult* result);
  ReplanReason Finish(const AttemptRequest& request, Candidate* candidate, ReplanResult* result);
  ReplanReason FindGuide(const AttemptRequest& request, const UniformBspline& curve, bool local,
                         BlockedRun* run, ReplanResult* result);
  double BlockedTime() const;
  double CostOfShape(const solvers::SolverSummary& solver) const;
  bool Better(const Candidate& a, const Candidate& b, bool keeps_side) const;

  ReplannerOptions options_;
  PreparedProblems problems_;
  GuideFinder finder_;
  PairBinder binder_;
  std::vector<std::string> pressed_;  // terms whose weights are scaled

  // Of the attempt under way.
  int segments_ = 0;
  PreparedProblem* now_ = nullptr;
  Pressure pressure_;
  double duration_ = 0.0;
  FreeSpace later_space_;
  UniformBspline first_curve_;  // before any pair
  std::vector<BlockedRun> runs_;
  Candidate best_, other_;
  std::vector<ObstaclePair> pairs_;
  GuidePath first_guide_, guide_;
};

}  // namespace touchdown::planning
