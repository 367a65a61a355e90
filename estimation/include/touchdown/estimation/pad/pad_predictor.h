// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/estimation/pad/pad_motion_model.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::estimation {

/// What is known of the pad when a plan is requested.
struct PadKnowledge {
  PadBelief belief;
  double height = 0.0;  ///< of the deck in W [m]
  PadNoise noise;
};

/// Predicts the pad from what is known of it.
class PadPredictor {
 public:
  virtual ~PadPredictor() = default;

  /// Valid until the next call. The same for the same knowledge, whatever was asked before: a replay asks other
  /// questions in between. Does not allocate.
  virtual const PadPrediction& Predict(const PadKnowledge& known) = 0;
};

/// The future of the pad as one belief predicts it: straight for kVelocity and kHeading, a
/// circular arc for kTurn. A snapshot by value: later measurements do not change it.
class BeliefPrediction final : public PadPrediction {
 public:
  /// `height`: deck's upper face in W [m]. The turn rate is shrunk towards zero by its signal to
  /// noise ratio, omega^3 / (omega^2 + var(omega)). So a turn is predicted only as far as it is
  /// known.
  BeliefPrediction(const PadBelief& belief, double height, const PadNoise& noise);

  /// Any finite t [s], before or after the belief's. Does not allocate.
  PadState At(double t) const noexcept override;
  /// cov_p is zero.
  PadState MeanAt(double t) const noexcept override;

  const PadBelief& belief() const { return belief_; }

 private:
  PadBelief belief_;
  double height_;
  PadNoise noise_;
};

/// Predicts by the filter's model.
class BeliefPredictor : public PadPredictor {
 public:
  const PadPrediction& Predict(const PadKnowledge& known) override;

 private:
  std::optional<BeliefPrediction> prediction_;
};

/// The paper's extrapolation along the heading. A turn rate in the filter is ignored.
class StraightPredictor final : public BeliefPredictor {
 public:
  const PadPrediction& Predict(const PadKnowledge& known) override;
};

/// Prediction from the filter's present belief. Throws std::invalid_argument before the filter's
/// first measurement. Does not allocate.
BeliefPrediction Predict(const PadFilter& filter);

}  // namespace touchdown::estimation
