// SPDX-License-Identifier: BSD-3-Clause
// One replanning step in a scene, from its start at rest.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/playground/scene.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// A step as JSON, without its attempts. `pad`: what it planned to.
nlohmann::ordered_json AnswerJson(const planning::ReplanResult& result,
                                  const estimation::PadPrediction& pad, double t_now);

/// Backend `solver` made its steps ready: a question that may be put again and again.
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

/// Fills a map around the scene's start with what is known of the scene there.
void LearnScene(const PlaygroundScene& scene, planning::OccupancyMap* map);

}  // namespace touchdown::evaluation
