// SPDX-License-Identifier: BSD-3-Clause
// The published state machine's rules (measured facts, not its text):
//   wait_target     -> generate   there is a goal
//   generate        -> execute    a plan from the vehicle's state; random guesses from the second try
//   execute         -> replan     a new goal; or replan_distance from the start of the trajectory and
//                                 no_replan_distance from the goal
//   execute         -> wait_target  the trajectory is over
//   replan          -> execute    a plan from the trajectory: warm, then polynomial, then random
//   (safety check)  -> execute, replan or emergency_stop
//   emergency_stop  -> generate   the vehicle stands
// The stop is armed only by a plan out of `generate`: a second emergency after `replan` makes none.

#include "planning/baselines/ego/ego_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kOver = 0.01;        // before its end a trajectory is over [s]
constexpr double kCheckStep = 0.01;   // of the collision check [s]
constexpr double kStanding = 0.1;     // [m/s]
constexpr double kClockSlack = 1e-6;  // [s]
constexpr double kSearchTime = 0.2;   // that a search may take as published [s]
constexpr int kHoverPoints = 6;       // control points of a stop
constexpr double kFarthest = 1e3;     // a goal farther from the vehicle is absurd [m]
constexpr double kFastest = 1e3;      // so is such a velocity [m/s]

const EgoPlannerOptions& Checked(const EgoPlannerOptions& options) {
  if (!(options.goal_rate > 0.0)) {
    throw std::invalid_argument("EgoPlannerOptions: goal_rate is " +
                                std::to_string(options.goal_rate) + " Hz, it must be > 0 Hz");
  }
  return options;
}

UniformBspline Hover(const Eigen::Vector3d& p_W, double interval, double t) {
  ControlPoints points(3, kHoverPoints);
  points.colwise() = p_W;
  return UniformBspline(points, interval, t);
}

FlatState StateOn(const UniformBspline& curve, double t) {
  FlatState state = curve.Evaluate(t);
  if (t > curve.t_end()) {
    state.v_WB.setZero();
    state.a_WB.setZero();
    state.j_WB.setZero();
  }
  return state;
}

bool Plausible(const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
  return p.cwiseAbs().maxCoeff() < kFarthest && v.norm() < kFastest;
}

bool Usable(const ReplanInput& input) {
  return std::isfinite(input.t_now) && std::isfinite(input.t_start) &&
         input.t_start >= input.t_now && Plausible(input.vehicle.p_WB, input.vehicle.v_WB);
}

ReplanReason ReasonOf(EgoStatus status) {
  switch (status) {
    case EgoStatus::kPlanned:
      return ReplanReason::kNone;
    case EgoStatus::kInvalidInput:
    case EgoStatus::kOutsideMap:
      return ReplanReason::kInvalidInput;
    case EgoStatus::kCloseToGoal:
      return ReplanReason::kAtGoal;
    case EgoStatus::kStartInObstacle:
      return ReplanReason::kStartBlocked;
    case EgoStatus::kTerminalBlocked:
      return ReplanReason::kGoalBlocked;
    case EgoStatus::kSearchFailed:
      return ReplanReason::kSearchFailed;
    case EgoStatus::kNoInitialPath:
    case EgoStatus::kPairLookupEmpty:
    case EgoStatus::kSolverFailed:
      return ReplanReason::kSolverFailed;
    case EgoStatus::kRestartsUsedUp:
    case EgoStatus::kReboundsUsedUp:
    case EgoStatus::kRefinementHit:
      return ReplanReason::kCollisionRemains;
  }
  return ReplanReason::kSolverFailed;
}

}  // namespace

const char* ToString(EgoMode mode) {
  switch (mode) {
    case EgoMode::kWaitTarget:
      return "wait_target";
    case EgoMode::kGenerate:
      return "generate";
    case EgoMode::kExecute:
      return "execute";
    case EgoMode::kReplan:
      return "replan";
    case EgoMode::kEmergencyStop:
      return "emergency_stop";
  }
  return "unknown";
}

EgoPlanner::EgoPlanner(const EgoPlannerOptions& options)
    : options_(Checked(options)), plan_(options.plan) {
  CommitHover(Eigen::Vector3d::Zero(), 0.0);
}

void EgoPlanner::CommitHover(const Eigen::Vector3d& p_W, double t) {
  current_ = next_ = Hover(p_W, 1.0, t);
  takes_over_ = t;
  has_trajectory_ = has_goal_ = new_goal_ = false;
  may_stop_ = true;
  tries_ = 0;
  climb_.reset();
  next_goal_t_ = next_safety_t_ = next_call_t_ = busy_until_ =
      -std::numeric_limits<double>::infinity();
  mode_ = EgoMode::kWaitTarget;
}

FlatState EgoPlanner::Reference(double t) const {
  FlatState state = StateOn(InForce(t), t);
  state.j_WB.setZero();
  return state;
}

void EgoPlanner::TakeOverAt(double t) {
  busy_until_ = std::max(busy_until_, t);
  const bool committed =
      result_.status == ReplanStatus::kPlanned || result_.status == ReplanStatus::kUnsafe;
  if (committed) takes_over_ = std::max(takes_over_, t);
}

void EgoPlanner::SetGoal(const ReplanInput& input, const Eigen::Vector3d& goal,
                         const Eigen::Vector3d& v_goal) {
  reference_.Set(input.vehicle.p_WB, input.vehicle.v_WB, goal, v_goal, options_.plan);
  has_goal_ = new_goal_ = true;
  if (mode_ == EgoMode::kWaitTarget) {
    mode_ = EgoMode::kGenerate;
    tries_ = 0;
  }
  if (mode_ == EgoMode::kExecute) mode_ = EgoMode::kReplan;
}

const ReplanResult& EgoPlanner::Replan(const ReplanInput& input, const OccupancyMap& map) {
  if (!Usable(input)) return Refuse(input);
  climb_.reset();
  if (input.pad != nullptr && input.t_now >= next_goal_t_ - kClockSlack) {
    const estimation::PadState pad = input.pad->At(input.t_now);
    const Eigen::Vector3d goal = pad.p_WP + input.endpoint.height * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d v_goal =
        options_.goal_velocity ? pad.v_WP : Eigen::Vector3d(Eigen::Vector3d::Zero());
    if (!Plausible(goal, v_goal) || (goal - input.vehicle.p_WB).norm() > kFarthest) {
      return Refuse(input);
    }
    SetGoal(input, goal, v_goal);
    next_goal_t_ = std::max(next_goal_t_, input.t_now) + 1.0 / options_.goal_rate;
  }
  return Step(input, map);
}

/// Input numbers that cannot be used: the committed trajectory goes on, and the goal is asked for
/// again.
const ReplanResult& EgoPlanner::Refuse(const ReplanInput& input) {
  Begin(input);
  result_.idle = false;
  result_.reason = ReplanReason::kInvalidInput;
  result_.detail = ToString(EgoStatus::kInvalidInput);
  result_.curve = next_;
  return result_;
}

const ReplanResult& EgoPlanner::Rest(const ReplanInput& input, double climb,
                                     const OccupancyMap& map) {
  if (!Usable(input) || !std::isfinite(climb)) return Refuse(input);
  if (climb_ != climb) {
    climb_ = climb;
    has_goal_ = new_goal_ = false;
    if (climb > 0.0) {
      const Eigen::Vector3d p = Reference(input.t_now).p_WB;
      SetGoal(input, p + climb * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero());
    }
  }
  return Step(input, map);
}

void EgoPlanner::Begin(const ReplanInput& input) {
  result_ = {};
  const bool flying = has_trajectory_ && input.t_now < next_.t_end();
  result_.status = flying ? ReplanStatus::kKept : ReplanStatus::kHolding;
  result_.idle = true;
}

const ReplanResult& EgoPlanner::Step(const ReplanInput& input, const OccupancyMap& map) {
  Begin(input);
  StageTimer total(&result_.times.total);
  if (input.t_now >= busy_until_ - kClockSlack) {
    FreeSpace space;
    space.map = &map;
    space.floor = options_.floor_height;
    if (has_goal_) space.floor = std::min(space.floor, reference_.goal().z() - map.resolution());
    space.ceiling = options_.ceiling_height;
    const FreeSpaceGrid grid(space);
    if (input.t_now >= next_safety_t_ - kClockSlack) {
      next_safety_t_ = std::max(next_safety_t_, input.t_now) + 1.0 / kSafetyRate;
      CheckSafety(input, grid);
    }
    if (input.t_now >= busy_until_ - kClockSlack) Execute(input, grid);
  }
  result_.curve = next_;
  return result_;
}

/// One step of the state machine.
void EgoPlanner::Execute(const ReplanInput& input, const EgoGrid& grid) {
  const EgoOptions& o = options_.plan;
  switch (mode_) {
    case EgoMode::kWaitTarget:
      if (has_goal_) mode_ = EgoMode::kGenerate;
      return;
    case EgoMode::kGenerate:
      if (!has_goal_) {
        mode_ = EgoMode::kWaitTarget;
      } else if (PlanFromVehicle(input, grid)) {
        mode_ = EgoMode::kExecute;
        may_stop_ = true;
      }
      return;
    case EgoMode::kReplan:
      if (!has_goal_) {
        mode_ = EgoMode::kExecute;
      } else if (PlanFromCurve(input, grid)) {
        mode_ = EgoMode::kExecute;
      }
      return;
    case EgoMode::kExecute: {
      const Eigen::Vector3d p = StateOn(next_, input.t_now).p_WB;
      if (input.t_now >= next_.t_end() - kOver) {
        has_goal_ = false;
        mode_ = EgoMode::kWaitTarget;
      } else if (has_goal_ && (reference_.goal() - p).norm() >= o.no_replan_distance &&
                 (next_.Evaluate(next_.t0()).p_WB - p).norm() >= o.replan_distance) {
        mode_ = EgoMode::kReplan;
      }
      return;
    }
    case EgoMode::kEmergencyStop:
      if (may_stop_) {
        Stop(input);
      } else if (input.vehicle.v_WB.norm() < kStanding) {
        mode_ = EgoMode::kGenerate;
        tries_ = 0;
      }
      may_stop_ = false;
      return;
  }
}

/// Looks ahead along the trajectory: to two thirds of it, or all the rest once they are flown.
void EgoPlanner::CheckSafety(const ReplanInput& input, const EgoGrid& grid) {
  if (mode_ == EgoMode::kWaitTarget || mode_ == EgoMode::kEmergencyStop || !has_trajectory_) {
    return;
  }
  const double two_thirds = next_.t0() + 2.0 / 3.0 * next_.duration();
  const double end = input.t_now < two_thirds ? two_thirds : next_.t_end();
  double t = input.t_now;
  while (t < end && !grid.Occupied(next_.Evaluate(t).p_WB)) t += kCheckStep;
  if (t >= end) return;
  if (has_goal_ && PlanFromCurve(input, grid)) {
    mode_ = EgoMode::kExecute;
  } else {
    mode_ =
        t - input.t_now < options_.plan.emergency_time ? EgoMode::kEmergencyStop : EgoMode::kReplan;
  }
}

bool EgoPlanner::PlanFromVehicle(const ReplanInput& input, const EgoGrid& grid) {
  if (input.t_now < next_call_t_ - kClockSlack) return false;
  // The vehicle's state, predicted to when the plan takes over.
  const double latency = input.t_start - input.t_now;
  const SplineState start{input.vehicle.p_WB + latency * input.vehicle.v_WB, input.vehicle.v_WB,
                          Eigen::Vector3d::Zero()};
  ++tries_;
  if (Call(input, start, tries_ > 1 ? EgoGuess::kRandom : EgoGuess::kPolynomial, grid)) {
    tries_ = 0;
    return true;
  }
  return false;
}

bool EgoPlanner::PlanFromCurve(const ReplanInput& input, const EgoGrid& grid) {
  if (input.t_now < next_call_t_ - kClockSlack) return false;
  const FlatState at = StateOn(next_, input.t_start);
  const SplineState start{at.p_WB, at.v_WB, at.a_WB};
  const EgoGuess first = new_goal_ ? EgoGuess::kPolynomial : EgoGuess::kWarm;
  for (const EgoGuess guess : {first, EgoGuess::kPolynomial, EgoGuess::kRandom}) {
    if (Call(input, start, guess, grid)) return true;
  }
  return false;
}

/// One plan call; commits what it plans.
bool EgoPlanner::Call(const ReplanInput& input, const SplineState& start, EgoGuess guess,
                      const EgoGrid& grid) {
  const LocalTarget target = reference_.Target(start.p, options_.plan);
  EgoRequest request;
  request.ends = {start, target.p, target.v};
  request.guess = guess;
  request.previous = &next_;
  request.t0 = input.t_start;
  EgoPlanResult planned;
  {
    StageTimer timer(&result_.times.solve, StageTimer::kWhileLogged);
    planned = plan_.Run(grid, request);
  }
  new_goal_ = false;
  result_.idle = false;
  busy_until_ = input.t_start;
  if (planned.counts.exhausted_searches > 0) next_call_t_ = input.t_now + kSearchTime;
  ++result_.solves;
  result_.rebinds += planned.counts.rebounds + planned.counts.restarts;
  result_.solver.iterations += planned.counts.iterations + planned.refine_iterations;
  result_.solver.evaluations += planned.counts.evaluations;
  for (const auto& path : plan_.rebound().paths()) result_.guide_paths.Add(path);
  result_.pairs = 0;
  for (const auto& pairs : plan_.rebound().pairs()) {
    result_.pairs += static_cast<int>(pairs.size());
  }
  result_.reason = ReasonOf(planned.status);
  result_.detail = ToString(planned.status);
  if (planned.status != EgoStatus::kPlanned) return false;
  result_.status = ReplanStatus::kPlanned;
  current_ = next_;
  next_ = planned.curve;
  takes_over_ = next_.t0();
  has_trajectory_ = true;
  return true;
}

/// All control points where the vehicle is, as published: no braking distance.
void EgoPlanner::Stop(const ReplanInput& input) {
  current_ = next_;
  next_ = Hover(input.vehicle.p_WB, NominalInterval(options_.plan), input.t_now);
  takes_over_ = next_.t0();
  result_.idle = false;
  result_.status = ReplanStatus::kUnsafe;
  result_.reason = ReplanReason::kCollisionRemains;
  result_.detail = "emergency_stop";
}

}  // namespace touchdown::planning
