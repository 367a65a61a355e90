// SPDX-License-Identifier: BSD-3-Clause
// One replanning step in a scene, from its start at rest.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluation/playground/scene.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// The answer where the truth forbids a plan, whatever the vehicle knows: it starts in an obstacle. Null: it does not.
nlohmann::ordered_json RefusalOf(const PlaygroundScene& scene);

/// A step as JSON, without its attempts. `pad`: what it planned to.
nlohmann::ordered_json AnswerJson(const planning::ReplanResult& result,
                                  const estimation::PadPrediction& pad, double t_now);

/// The planner's question at the scene's start, ready to be asked again and again.
class SceneStep {
 public:
  /// The map has what the scene's `known` says. @throws std::invalid_argument as SceneFrom and Replanner.
  explicit SceneStep(const PlaygroundScene& scene);

  /// Asks once. The same answer every time.
  const planning::ReplanResult& Ask();
  /// Asks, and writes down what was tried.
  nlohmann::ordered_json Explain();
  /// Asks so many times. Wall clock of one, in the mean [ms].
  double MeanTime(int steps);

 private:
  planning::OccupancyMap map_;
  sim::OraclePadPrediction pad_;
  planning::Replanner replanner_;
  planning::ReplannerState before_;
  planning::ReplanInput input_;
};

}  // namespace touchdown::evaluation
