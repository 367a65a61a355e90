// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/evaluation/scenario/part.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// What is known of the pad when a plan is asked for.
struct PadKnowledge {
  estimation::PadBelief belief;
  double height = 0.0;  ///< of the deck in W [m]
  estimation::PadNoise noise;
};

/// Foretells the pad from what is known of it.
class PadPredictor {
 public:
  virtual ~PadPredictor() = default;

  /// Valid until the next call. The same for the same knowledge, whatever was asked before: a replay asks other
  /// questions in between. Does not allocate.
  virtual const estimation::PadPrediction& Predict(const PadKnowledge& known) = 0;
};

/// What a predictor is made from.
struct PredictorSetup : PartSetup {
  std::shared_ptr<const sim::PadCourse> truth;  ///< of the trial; for oracles alone
};

/// How a predictor gets into the program.
struct PredictorEntry : Part {
  std::function<std::unique_ptr<PadPredictor>(const PredictorSetup&)> make;
};

/// The predictors of the library.
std::vector<PredictorEntry> StandardPredictors();

}  // namespace touchdown::evaluation
