// SPDX-License-Identifier: BSD-3-Clause
// Prediction of the pad from one belief. An uncertain turn rate would bend the far future for
// nothing, so it is shrunk by its signal to noise ratio. This is the linear minimum mean square
// error estimate of a turn rate whose prior variance is its own square. The predicted circle keeps
// its closed form and its exact derivatives. The covariance is that of the unshrunk model.

#include "touchdown/estimation/pad/pad_predictor.h"

#include <stdexcept>

namespace touchdown::estimation {

BeliefPrediction::BeliefPrediction(const PadBelief& belief, double height, const PadNoise& noise)
    : belief_(belief), height_(height), noise_(noise) {
  if (belief_.motion == PadMotion::kTurn) {
    const double power = belief_.mean(4) * belief_.mean(4);
    const double total = power + belief_.cov(4, 4);
    belief_.mean(4) *= total > 0.0 ? power / total : 1.0;
  }
}

PadState BeliefPrediction::At(double t) const noexcept {
  return ToPadState(PropagateBelief(belief_, t, noise_), height_);
}

PadState BeliefPrediction::MeanAt(double t) const noexcept {
  PadBelief belief = belief_;
  belief.mean = Propagate(belief_.motion, belief_.mean, t - belief_.t);
  belief.cov.setZero();
  return ToPadState(belief, height_);
}

const PadPrediction& BeliefPredictor::Predict(const PadKnowledge& known) {
  return prediction_.emplace(known.belief, known.height, known.noise);
}

const PadPrediction& StraightPredictor::Predict(const PadKnowledge& known) {
  PadKnowledge straight = known;
  PadBelief& belief = straight.belief;
  if (belief.motion == PadMotion::kTurn) {
    belief.motion = PadMotion::kHeading;
    belief.mean[4] = 0.0;
    belief.cov.row(4).setZero();
    belief.cov.col(4).setZero();
  }
  return BeliefPredictor::Predict(straight);
}

BeliefPrediction Predict(const PadFilter& filter) {
  if (!filter.initialized()) {
    throw std::invalid_argument("Predict: the pad filter has had no measurement yet");
  }
  return BeliefPrediction(filter.belief(), filter.options().pad_height, filter.options().noise);
}

}  // namespace touchdown::estimation
