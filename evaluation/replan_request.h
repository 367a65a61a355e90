// SPDX-License-Identifier: BSD-3-Clause
// A question to the replanner as data, so that it can be written down and asked again.
#pragma once

#include <optional>

#include "touchdown/estimation/pad_predictor.h"
#include "touchdown/planning/replanner.h"

namespace touchdown::evaluation {

/// Which pad prediction the replanner was given.
enum class PredictionSource {
  kNone,    ///< none: it was asked to come to rest
  kBelief,  ///< the filter's belief
  kOracle,  ///< the true future
};

/// "none", "belief" or "oracle".
const char* ToString(PredictionSource source);
/// "velocity", "heading" or "turn".
const char* ToString(estimation::PadMotion motion);

struct PredictionData {
  PredictionSource source = PredictionSource::kNone;
  estimation::PadBelief belief;  ///< with kBelief, as BeliefPrediction takes it
  double height = 0.0;           ///< of the deck in W [m]
  estimation::PadNoise noise;

  estimation::BeliefPrediction Belief() const { return {belief, height, noise}; }
};

struct ReplanRequest {
  planning::ReplanInput input;       ///< without its pad
  std::optional<double> rest_climb;  ///< to rest, this much higher [m]; none: to the pad
  PredictionData prediction;
};

}  // namespace touchdown::evaluation
