// SPDX-License-Identifier: BSD-3-Clause
// Latency, success and safety of single replanning steps.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/base/statistics.h"
#include "evaluation/studies/replan/plan_oracle.h"
#include "evaluation/studies/replan/replan_scene.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

struct ReplanStudyOptions {
  SceneOptions scenes;
  planning::ReplannerOptions replanner;
  int count = 700;      ///< scenes
  int repeats = 3;      ///< timed steps of each scene; the median counts
  bool later = false;   ///< ask for the steps that follow the first one, too
  bool oracle = false;  ///< ask in each scene whether there is a plan at all (plan_oracle.h) ...
  /// ... else it is taken from here, where it is known.
  std::function<std::optional<OracleVerdict>(const SceneOptions& scenes, int index)> verdict;
  bool check = true;  ///< look for collisions at 1 cm, by map and by FCL
};

/// The check of a plan at points 1 cm apart.
struct PlanCheck {
  double length = 0.0;         ///< [m]
  bool map_blocked = false;    ///< a point lies in a blocked cell
  bool truly_near = false;     ///< a point is nearer to an obstacle than the inflation, by FCL
  double true_clearance = 0;   ///< least distance to an obstacle, by FCL [m]; infinite: none known
  bool beyond_limits = false;  ///< a point is faster, or accelerates more, than the limits
};

/// Which step of a scene. Those after the first follow a first step that made a plan, and go on from it.
enum class SceneStep {
  kFirst,
  kTenth,  ///< 0.1 s on
  kFifth,  ///< 0.2 s on
  kGrown,  ///< 0.2 s on, after a first step that knew 5 m; now those 5 m from where it is are known, too
};
inline constexpr SceneStep kSceneSteps[] = {SceneStep::kFirst, SceneStep::kTenth, SceneStep::kFifth,
                                            SceneStep::kGrown};
const char* ToString(SceneStep step);

/// One step in one scene.
struct ReplanRow {
  int index = 0;
  SceneStep step = SceneStep::kFirst;
  bool feasible = false;
  bool straight_blocked = false;  ///< an obstacle is in the straight way
  double target_moved = 0.0;      ///< [m]
  planning::ReplanStatus status = planning::ReplanStatus::kUnsafe;
  planning::ReplanReason reason = planning::ReplanReason::kNone;
  planning::StageTimes times;  ///< of the repeat whose total is the median
  int work = 0;                ///< of max_work units
  int solves = 0;
  int pairs = 0;
  int guides = 0;  ///< guide paths searched
  // Of the accepted plan; none: there is none.
  std::optional<double> duration;  ///< [s]
  std::optional<double> stretch;   ///< duration over the guessed one, of a first step
  std::optional<double> lateness;  ///< its arrival over the earliest possible (EarliestArrival)
  std::optional<double> cost;      ///< without obstacles and limits; time has its usual price
  std::optional<double> jerk;      ///< integral of squared jerk [m^2/s^5]
  std::optional<PlanCheck> check;  ///< none also where it was not asked for
  std::optional<OracleVerdict> oracle;  ///< of a first step, where it was asked

  bool planned() const { return status == planning::ReplanStatus::kPlanned; }
};

/// Times of rows [ms, thread CPU].
struct RowTimes {
  int count = 0;
  Quantiles ms;
};

/// Of the wall time of steps [0, 1].
struct StageShares {
  double search = 0.0, pairs = 0.0, solve = 0.0, check = 0.0, certificate = 0.0;
};
RowTimes TimesOf(const std::vector<const ReplanRow*>& rows);

/// One kind of scenes in figures.
struct ReplanSummary {
  int scenes = 0;
  int feasible = 0;
  int succeeded = 0;      ///< first steps in feasible scenes
  Interval success;       ///< 95 % Clopper-Pearson
  int accepted = 0;       ///< in all scenes
  int checked = 0;        ///< of these
  int colliding = 0;      ///< of the checked
  int disagreeing = 0;    ///< of the checked: the two checkers disagree about a collision
  int beyond_limits = 0;  ///< of the checked
  int asked = 0;          ///< scenes of which the oracle was asked
  int found = 0;          ///< of these, with a plan of the oracle's
  int met = 0;            ///< of the found, with a plan of the first step's
  int missed = 0;         ///< by the oracle: a plan of the step's where it found none
  int end_blocked = 0,
      cannot_stop = 0;           ///< of the asked without any plan; cannot_stop: with a free end
  RowTimes all, clear, blocked;  ///< all scenes; straight way free; not free
  StageShares shares;
  std::optional<double> lateness, cost, jerk;  ///< medians of the accepted plans
};

/// Runs the steps of every scene; deterministic except for the times. `report` gets the progress.
std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const solvers::BackendRegistry& backends,
                                      const std::function<void(int done, int all)>& report);

/// The same in scenes that were drawn with options.scenes before: the first ones, in their order.
std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const std::vector<ReplanScene>& scenes,
                                      const solvers::BackendRegistry& backends);

/// A ball that a map knows. Infinite: all of its window.
struct KnownBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in W [m]
  double radius = std::numeric_limits<double>::infinity();
};

/// Looks at a plan at points 1 cm apart; for obstacles where the map knows the space.
PlanCheck CheckPlan(const planning::UniformBspline& plan, const ReplanScene& scene,
                    const planning::Limits& limits, const KnownBall& known = {});

/// Of the rows of this step.
ReplanSummary Summarise(const std::vector<ReplanRow>& rows, SceneStep step = SceneStep::kFirst);

}  // namespace touchdown::evaluation
