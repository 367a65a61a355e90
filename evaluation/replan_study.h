// SPDX-License-Identifier: BSD-3-Clause
// Latency, success and safety of single replanning steps.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "touchdown/evaluation/replan_scene.h"
#include "touchdown/evaluation/statistics.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

struct ReplanStudyOptions {
  SceneOptions scenes;
  planning::ReplannerOptions replanner;
  int count = 700;    ///< scenes
  int repeats = 3;    ///< timed steps of each scene; the median counts
  bool check = true;  ///< look for collisions at 1 cm, by map and by FCL
};

/// A plan seen at points 1 cm apart.
struct PlanCheck {
  double length = 0.0;         ///< [m]
  bool map_blocked = false;    ///< a point lies in a blocked cell
  bool truly_near = false;     ///< a point is nearer to an obstacle than the inflation, by FCL
  double true_clearance = 0;   ///< least distance to an obstacle, by FCL [m]; infinite: none known
  bool beyond_limits = false;  ///< a point is faster, or accelerates more, than the limits
};

/// The first step in one scene.
struct ReplanRow {
  int index = 0;
  bool feasible = false;
  bool straight_blocked = false;  ///< an obstacle is in the straight way
  double target_moved = 0.0;      ///< [m]
  planning::ReplanStatus status = planning::ReplanStatus::kUnsafe;
  planning::ReplanReason reason = planning::ReplanReason::kNone;
  planning::StageTimes times;  ///< of the repeat whose total is the median
  int solves = 0;
  int pairs = 0;
  int guides = 0;  ///< guide paths searched
  // Of the accepted plan; none: there is none.
  std::optional<double> duration;  ///< [s]
  std::optional<double> stretch;   ///< duration over the guessed one
  std::optional<double> jerk;      ///< integral of squared jerk [m^2/s^5]
  std::optional<PlanCheck> check;  ///< none also where it was not asked for

  bool planned() const { return status == planning::ReplanStatus::kPlanned; }
};

/// Times of rows [ms, thread CPU].
struct RowTimes {
  int count = 0;
  Quantiles ms;
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
  int disagreeing = 0;    ///< of the checked: one checker takes it for colliding and one does not
  int beyond_limits = 0;  ///< of the checked
  RowTimes all, clear, blocked;  ///< all scenes; straight way free; not free
};

/// Runs the first step in every scene; deterministic but for the times. `report` is told of progress.
std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const solvers::BackendRegistry& backends,
                                      const std::function<void(int done, int all)>& report);

/// Looks at a plan at points 1 cm apart; for obstacles where the map knows the space.
PlanCheck CheckPlan(const planning::UniformBspline& plan, const ReplanScene& scene,
                    const planning::Limits& limits);

ReplanSummary Summarise(const std::vector<ReplanRow>& rows);

}  // namespace touchdown::evaluation
