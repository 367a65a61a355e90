// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/estimation/vehicle_state.h"
#include "touchdown/planning/certificate.h"
#include "touchdown/planning/endpoint.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/planning/uniform_bspline.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/solver_result.h"

namespace touchdown::planning {

enum class ArrivalMode { kFixed, kFree };

struct ReplannerOptions {
  std::string backend = "ceres";
  ArrivalMode arrival = ArrivalMode::kFixed;
  Limits limits;
  double floor_height = 0.45;      ///< body origin stays above this away from the pad [m]
  double max_duration = 30.0;      ///< a pad farther away in time is unreachable [s]
  double min_duration = 0.8;       ///< shortest plan: a vehicle above the pad keeps following [s]
  double odometry_threshold = 0.5; ///< tracking error beyond which plans start at the vehicle [m]
  int max_rebinds = 6;             ///< solve / check / re-bind rounds per attempt
  int max_iterations = 50;         ///< solver iterations per solve
  int max_expansions = 200000;     ///< A* expansions per search
};

/// What one replanning step is asked. Plain data: a record can hold it and play it again.
struct ReplanInput {
  double t_now = 0.0;                                ///< when the question is put [s]
  double t_start = 0.0;                              ///< when the answer takes over, >= t_now [s]
  estimation::VehicleState vehicle;                  ///< estimated state at t_now
  const estimation::PadPrediction* pad = nullptr;
  EndpointTarget endpoint;
};

/// What is flown after a replanning step.
enum class ReplanStatus {
  kPlanned,     ///< a new certified plan
  kKept,        ///< no new certified plan; the previous one is still safe
  kBraking,     ///< a certified braking trajectory to rest
  kClimbing,    ///< a certified climb straight up to rest
  kHolding,     ///< at rest already and nothing better is certified: stay
  kUnsafe,      ///< nothing could be certified: the previous trajectory goes on, uncertified
};

/// Why no new plan was made; kNone with kPlanned.
enum class ReplanReason {
  kNone,
  kInvalidInput,      ///< a number of the input is not finite, or t_start lies before t_now
  kStartBlocked,      ///< the start is inside an inflated obstacle
  kGoalBlocked,       ///< the end is inside an inflated obstacle
  kPadUnreachable,    ///< no arrival time up to max_duration keeps the limits
  kSearchFailed,      ///< A* found no way around an obstacle within its expansions
  kSolverFailed,      ///< the backend returned no usable point
  kCollisionRemains,  ///< still blocked after every re-binding round
  kLimitsExceeded,    ///< still beyond a limit after every re-timing round
};

const char* ToString(ReplanStatus status);
const char* ToString(ReplanReason reason);
/// One sentence for people.
const char* Explain(ReplanReason reason);

/// Wall and thread CPU time of the stages of one replanning step [s]. Never part of what must
/// repeat bit by bit.
struct StageTimes {
  struct Span {
    double wall = 0.0;
    double cpu = 0.0;
  };
  Span predict, check, search, pairs, solve, certificate, total;
};

struct ReplanResult {
  ReplanStatus status = ReplanStatus::kHolding;
  ReplanReason reason = ReplanReason::kNone;
  bool from_odometry = false;                     ///< started at the vehicle, not at the old plan
  UniformBspline curve;                           ///< what is flown from t_start on
  Certificate certificate;
  std::vector<std::vector<Eigen::Vector3d>> guide_paths;  ///< A* paths of this step, in W [m]
  int pairs = 0;                                  ///< {p, v} pairs bound at the end
  int solves = 0;                                 ///< solver calls
  int rebinds = 0;                                ///< of these, after a re-binding
  solvers::SolverResult solver;                   ///< of the last solve
  StageTimes times;
};

/// Plans, re-plans and holds the committed trajectory (design: section "Replanning"). One instance
/// per vehicle; not thread-safe; different instances are independent.
class Replanner {
 public:
  /// Throws std::invalid_argument if an option is out of range, or if the backend is unknown or
  /// cannot do what the options ask (the sentence says which).
  Replanner(const ReplannerOptions& options, const solvers::BackendRegistry& backends);
  ~Replanner();
  Replanner(Replanner&&) noexcept;
  Replanner& operator=(Replanner&&) noexcept;

  /// The vehicle hovers at p_W from t on: the first committed trajectory.
  void CommitHover(const Eigen::Vector3d& p_W, double t);

  /// One replanning step against the map. The result stays valid until the next call.
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map);

  /// The committed reference at time t (yaw fields zero). The plan made by Replan takes over at its
  /// t_start; before that the older one is flown. Does not allocate.
  FlatState Reference(double t) const;

  const ReplannerOptions& options() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
