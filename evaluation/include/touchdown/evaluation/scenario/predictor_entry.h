// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/evaluation/scenario/part.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// What a predictor is made from.
struct PredictorSetup : PartSetup {
  std::shared_ptr<const sim::PadCourse> truth;  ///< of the trial; for oracles alone
};

/// How a predictor gets into the program.
struct PredictorEntry : Part {
  std::function<std::unique_ptr<estimation::PadPredictor>(const PredictorSetup&)> make;
};

/// The predictors of the library.
std::vector<PredictorEntry> StandardPredictors();

}  // namespace touchdown::evaluation
