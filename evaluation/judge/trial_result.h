// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/base/sensing_times.h"
#include "evaluation/judge/landing_judge.h"
#include "evaluation/judge/safety_watch.h"
#include "touchdown/planning/look/no_way.h"

namespace touchdown::evaluation {

/// Errors of the pad filter against the truth, right after each of its measurements while it counts
/// as converged, until first contact.
struct EstimatorQuality {
  double rmse_position_m = 0.0;     ///< horizontal, relative to the vehicle (estimate to estimate)
  double rmse_velocity_mps = 0.0;   ///< horizontal, in W
  double nees_position_mean = 0.0;  ///< 2 degrees of freedom: 2 if the covariance is honest
  int samples = 0;
};

/// Error of the vehicle's estimate of its own state, in flight until first contact, every 20 ms.
/// Position and velocity errors are lengths; the attitude error is an angle.
struct OwnStateQuality {
  double rmse_position_m = 0.0;
  double max_position_m = 0.0;
  double rmse_velocity_mps = 0.0;
  double max_velocity_mps = 0.0;
  double rmse_attitude_rad = 0.0;
  double max_attitude_rad = 0.0;
};

/// How well the vehicle kept above the pad over the last 10 s of a flight.
struct Following {
  double mean_error_m = 0.0;        ///< horizontal distance of B to the pad's centre
  double max_error_m = 0.0;         ///< the same
  double relative_speed_mps = 0.0;  ///< mean norm of the velocity relative to the pad
};

/// What the flight learned about its map.prior (docs/worlds.md): numbers of cells.
struct PriorFigures {
  std::int64_t occupied = 0;   ///< that the prior holds occupied
  std::int64_t looked_at = 0;  ///< of these, those that were observed
  std::int64_t gone = 0;       ///< of these, those that are free
  std::int64_t appeared = 0;   ///< that the prior holds free and that are occupied
};

/// The vehicle's answer that it knows no way, where that stood at the end (planning::NoWay).
struct NoWayFigures {
  double since_s = 0.0;
  int looks = 0;
  std::optional<planning::NarrowPlace> narrowest;  ///< of the map's widest way
  double needed_m = 0.0;                           ///< least width that a plan passes
};

/// Wall-clock figures of one trial. Nothing else depends on them.
struct TrialTiming {
  double wall_s = 0.0;         ///< the whole trial
  double cpu_s = 0.0;          ///< thread CPU time of the whole trial
  double simulated_s = 0.0;    ///< simulated time, for the real-time factor
  double physics_cpu_s = 0.0;  ///< stages of the loop, thread CPU time
  double sensing_cpu_s = 0.0;
  SensingTimes sensing_stages;  ///< a part of sensing_cpu_s
  double mapping_cpu_s = 0.0;
  double planning_cpu_s = 0.0;
  double control_cpu_s = 0.0;
  double judging_cpu_s = 0.0;
  std::vector<double> replan_wall_ms;  ///< every replan
  std::vector<double> replan_cpu_ms;
  int deadline_misses = 0;      ///< replans slower than the latency they were flown with ...
  int deadline_misses_cpu = 0;  ///< ... by CPU time alone: others waited for a loaded machine
};

/// Numbers of steps by a name.
using StepCounts = std::map<std::string, int>;

/// The result of one trial: a pure function of (scenario, seed), except for `timing`.
struct TrialResult {
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::kError;
  std::string detail;  ///< what went wrong in words; empty when landed
  /// Cause of the end. For a contact: the last thing touched, except a foot on the deck ("obstacle 3", "hull-deck").
  /// For a flight that stood still: the last reason for no new plan, else the mode. Otherwise empty.
  std::string cause;
  std::optional<Touchdown> touchdown;        ///< first contact of a foot with the pad
  std::optional<double> mean_abs_error_x_m;  ///< last 5 s before first contact, world axes
  std::optional<double> mean_abs_error_y_m;
  std::optional<double> min_clearance_m;  ///< true; empty without obstacles
  double simulated_s = 0.0;
  double effort_n2s = 0.0;        ///< integral of the rotors' squared thrusts [N^2 s]
  double saturation_share = 0.0;  ///< of control steps with a saturated mixer
  double max_speed_mps = 0.0;
  double max_acceleration_mps2 = 0.0;  ///< over 20 ms
  int replans = 0;
  StepCounts replans_by_status;
  StepCounts replans_by_reason;     ///< of those that made no new plan
  StepCounts replans_forbidden_by;  ///< of these, those whose plan a term or a limit forbade
  /// Steps of the mission of a landing (100 Hz) until first contact, by the landing condition (control::Gate).
  StepCounts gate_steps;
  std::optional<double> first_tag_s;  ///< when a tag of the pad was first found; empty: never
  std::optional<EstimatorQuality> estimator;
  std::optional<OwnStateQuality> own_state;  ///< where it is estimated
  std::optional<Following> following;        ///< of the task follow, where it lasted 10 s
  /// Of trials that are to land: bounds on the earliest possible contact
  /// (evaluation/judge/landing_time.h). The lower one is T*; the upper one is empty if none was
  /// found.
  std::optional<double> t_star_s;
  std::optional<double> t_star_upper_s;
  /// max_speed_mps and max_acceleration_mps2 are within the scenario's limits, as T* supposes.
  bool within_limits = false;
  std::optional<SafetyFigures> safety;  ///< of a planner that flies by the safety rule
  std::optional<PriorFigures> prior;    ///< where the scenario has one
  int looks = 0;                        ///< that it went, since it made no progress
  std::optional<NoWayFigures> no_way;   ///< as it stood at the end
  TrialTiming timing;

  bool landed() const { return outcome == Outcome::kLanded; }
  /// It fulfilled the scenario's task.
  bool succeeded() const { return IsSuccess(outcome); }
  /// Time to land over T*, empty unless landed within the limits.
  std::optional<double> time_ratio() const {
    if (!landed() || !within_limits || !t_star_s) return std::nullopt;
    return touchdown->t / *t_star_s;
  }
};

}  // namespace touchdown::evaluation
