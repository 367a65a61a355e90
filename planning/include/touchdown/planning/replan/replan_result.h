// SPDX-License-Identifier: BSD-3-Clause
// What goes into and comes out of a replanning step: plain data that a record can hold and play
// again.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/certify/flight_pair.h"
#include "touchdown/planning/certify/margins.h"
#include "touchdown/planning/problem/bound_part.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/problem/step_constants.h"
#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/solvers/backend/solver_result.h"

namespace touchdown::planning {

/// How a Replanner plans; the defaults land the default vehicle.
struct ReplannerOptions {
  std::string backend = "banded";
  std::vector<std::pair<std::string, double>> solver_options;  ///< of the backend, by name
  ArrivalMode arrival = ArrivalMode::kFixed;
  Limits limits;
  Formulation problem;           ///< terms, their settings, how limits and ends are kept
  double floor_height = 0.45;    ///< body origin stays above this away from the pad [m]
  double ceiling_height = 10.0;  ///< and below this everywhere [m]
  double pad_radius = 1.2;  ///< half width of the strip over the pad [m], which has as its floor
  double contact_height = 0.12;  ///< ... this, body origin above the deck when the feet touch [m]
  double max_duration = 30.0;    ///< a pad farther away in time is unreachable [s]
  double min_duration = 0.8;     ///< shortest plan: a vehicle above the pad keeps following [s]
  double min_contact_duration = 0.3;  ///< ... and one that is to end in contact [s]
  double odometry_threshold = 0.5;  ///< tracking error beyond which plans start at the vehicle [m]
  /// A plan is flown at least this long before its stop, if no newer one comes [s]. Longer if the caller's last two
  /// answers took over farther apart.
  double reaction = 0.15;
  double segment_length = 0.75;  ///< of a plan's segment at full speed, at most [m]
  double hull_radius = 0.324;    ///< of the body at every tilt, about its origin [m]
  double deck_half_size = 0.0;   ///< of the pad's deck [m]; 0: there is none to land on
  double vertical_cost = 2.0;    ///< of ways: a metre up or down costs as much as this many ahead
  int max_guides = 2;            ///< ways around the first obstacle that are tried
  bool warm_start = true;        ///< a solve begins at the rest of the committed plan
  int max_rebinds = 3;           ///< solve / check / re-bind rounds per attempt
  int max_iterations = 50;       ///< solver iterations per solve
  /// A solve ends this near to the optimum, as a share of the cost (solvers::Stop::gap). A plan needs its
  /// certificate, not the last digits of an optimum.
  double gap = 5e-3;
  /// Budget of a step (work_budget.h); from rest four times that. If there is no plan to fly, the next step continues: after a first attempt
  /// that did not fit, at a later one.
  int max_work = 10000;
  StepConstants constants;  ///< what else a step decides by
};

/// Nothing is planned at positions whose coordinates reach this [m]: their last digits would be worth too much.
inline constexpr double kFarthestPlace = 1e6;

/// What one replanning step is asked. Plain data: a record can hold it and play it again.
struct ReplanInput {
  double t_now = 0.0;                ///< when the question is put [s]
  double t_start = 0.0;              ///< when the answer takes over, >= t_now [s]
  estimation::VehicleState vehicle;  ///< estimated state at t_now
  const estimation::PadPrediction* pad = nullptr;
  EndpointTarget endpoint;
  /// Fly there and rest, to look (look/scout.h), instead of to the endpoint. In W [m].
  std::optional<Eigen::Vector3d> look_from_W;
  /// Steady force on the vehicle beside gravity and drag in still air, over its mass, in W [m/s^2]. Plans keep the
  /// limits that it leaves (LimitsUnder).
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();
  Margins margins;  ///< around the hull, until it rests
};

/// What is flown after a replanning step.
enum class ReplanStatus {
  kPlanned,   ///< a new certified plan, with its stop
  kKept,      ///< no new certified plan; the previous one goes on, with a newer stop or to contact
  kBraking,   ///< the stop that was stored with the previous plan is flown, or one that is wanted
  kClimbing,  ///< a certified climb straight up to rest
  kEscaping,  ///< a certified way out of the inflated zone around an obstacle, to rest
  kHolding,   ///< at rest, and nothing else is certified: stay
  kUnsafe,    ///< the baselines only: what is flown is not certified
};

/// Why no new plan was made; kNone with kPlanned.
enum class ReplanReason {
  kNone,
  kInvalidInput,      ///< a number is not finite or absurd, or an earlier answer is still pending
  kStartBlocked,      ///< the start is inside an inflated obstacle
  kGoalBlocked,       ///< the end is inside an inflated obstacle
  kPadUnreachable,    ///< the pad or goal drives away faster than the vehicle may fly
  kSearchFailed,      ///< A* found no way around an obstacle within its expansions
  kSolverFailed,      ///< the backend returned no usable point
  kCollisionRemains,  ///< still blocked after every re-binding round
  kUnobserved,        ///< too fast to stop before space that was never observed
  kEndTooFast,        ///< hard limits leave no interior: the pad moves near the speed limit
  kBudgetSpent,       ///< the step's work was done before there was a plan
  kLimitsExceeded,    ///< still beyond a limit after every re-timing round
  kAtGoal,            ///< the baseline only: nearer to the goal than it makes plans for
};

const char* ToString(ReplanStatus status);
const char* ToString(ReplanReason reason);
/// One sentence for people.
const char* Explain(ReplanStatus status);
const char* Explain(ReplanReason reason);

/// What the stages of one replanning step cost. Never part of what must repeat bit by bit.
struct StageTimes {
  struct Span {
    const char* stage = "";
    double wall = 0.0;  ///< [s]
    double cpu = 0.0;   ///< of the thread [s]; NaN: entered, but no SpanLog listened
    long allocations =
        0;  ///< on the heap, where they are counted (touchdown/solvers/allocation_count.h)

    void Add(const Span& more) {
      wall += more.wall;
      cpu += more.cpu;
      allocations += more.allocations;
    }
  };
  Span look{"look"};  ///< of a scout, before the step; planners leave it alone
  Span predict{"predict"}, search{"search"}, pairs{"pairs"}, solve{"solve"}, check{"check"},
      certificate{"certificate"}, total{"total"};

  /// The stages without the total, in the order in which they come.
  std::array<const Span*, 7> Stages() const {
    return {&look, &predict, &search, &pairs, &solve, &check, &certificate};
  }
};

/// Polylines in W [m]. Clear keeps their memory, so that a list that is used again does not allocate
/// once it has grown.
class PathList {
 public:
  using Path = std::vector<Eigen::Vector3d>;

  const Path* begin() const { return paths_.data(); }
  const Path* end() const { return paths_.data() + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Path& operator[](std::size_t i) const { return paths_[i]; }

  void Reserve(std::size_t paths, std::size_t points) {
    if (paths_.size() < paths) paths_.resize(paths);
    for (Path& path : paths_) path.reserve(points);
  }
  void Clear() { size_ = 0; }
  void Add(const Path& path) {
    if (size_ == paths_.size()) paths_.emplace_back();
    paths_[size_++] = path;
  }

 private:
  std::vector<Path> paths_;
  std::size_t size_ = 0;
};

/// The pair that is flown from t_start on, and how it came about.
struct ReplanResult : FlightPair {
  ReplanStatus status = ReplanStatus::kHolding;
  ReplanReason reason = ReplanReason::kNone;
  /// With kInvalidInput the part of the input that is not valid. For the EGO-Planner baseline its name of its plan
  /// call's outcome. Else empty.
  std::string_view detail;
  /// Of a Replanner without a new plan: the term whose rows the plan that was tried violates, or the limit
  /// (limits.speed, …) that it exceeds. Empty: none. Valid as long as the planner.
  std::string_view forbidden_by;
  bool ends_in_contact = false;  ///< the requested plan does
  bool idle = false;             ///< the planner had nothing to do: there is no answer
  bool committed = false;        ///< a pair was proven in this step and takes over at t_start
  bool from_odometry = false;    ///< started at the vehicle, not at the old plan
  FlightPair& pair() { return *this; }
  const FlightPair& pair() const { return *this; }
  Certificate certificate;
  /// The map was wrong: the stored stop is flown, and a cell of its tube is not free any more, or the hull is in an
  /// occupied one.
  bool map_error = false;
  /// The first cell that is not observed free and that the next stops will need. It belongs to the plan beyond its
  /// own stop, or to the first plan that was not proven because of it. In W [m].
  std::optional<Eigen::Vector3d> unseen_W;
  PathList guide_paths;           ///< A* paths of this step
  int pairs = 0;                  ///< {p, v} pairs bound at the end
  BoundParts bound;               ///< what of that plan they bind
  int solves = 0;                 ///< solver calls
  int rebinds = 0;                ///< of these, after a re-binding
  int work = 0;                   ///< that was done, of its budget
  solvers::SolverSummary solver;  ///< of the last solve of that plan
  StageTimes times;
};

}  // namespace touchdown::planning
