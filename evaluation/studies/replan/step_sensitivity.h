// SPDX-License-Identifier: BSD-3-Clause
// The effect of each constant of a replanning step. Each one is changed by a quarter down and up, and the same scenes
// are asked again.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/studies/replan/replan_study.h"
#include "touchdown/planning/problem/step_constants.h"

namespace touchdown::evaluation {

/// One constant, changed, against the same steps with it as it is.
struct SensitivityRow {
  const planning::StepConstant* constant = nullptr;
  double value = 0.0;  ///< that it was changed to
  int steps = 0;
  int gained = 0;          ///< steps that plan now and did not before
  int lost = 0;            ///< the other way round
  int changed = 0;         ///< steps whose plan is another, or that gained or lost one
  double mean_work = 1.0;  ///< of a step, over before
  double mean_cost = 1.0;  ///< of the plans of steps that plan in both, over before
};

/// First and later steps of `options.count` scenes of every part. The parts differ in set and kind. Nothing is timed:
/// the same parts give the same rows. `report` gets the progress.
std::vector<SensitivityRow> MeasureSensitivity(
    const std::vector<ReplanStudyOptions>& parts, const solvers::BackendRegistry& backends,
    const std::function<void(int done, int all)>& report);

/// A table for people.
std::string SensitivityText(const std::vector<SensitivityRow>& rows);

nlohmann::ordered_json SensitivityJson(const std::vector<SensitivityRow>& rows);

}  // namespace touchdown::evaluation
