// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/predictor_entry.h"

#include <optional>
#include <utility>

#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::evaluation {
namespace {

/// As the filter's model goes on.
class AlongTheBelief : public PadPredictor {
 public:
  const estimation::PadPrediction& Predict(const PadKnowledge& known) override {
    return prediction_.emplace(known.belief, known.height, known.noise);
  }

 private:
  std::optional<estimation::BeliefPrediction> prediction_;
};

/// The paper extrapolates along the heading: a turn that the filter knows of is left out.
class StraightOn final : public AlongTheBelief {
 public:
  const estimation::PadPrediction& Predict(const PadKnowledge& known) override {
    PadKnowledge straight = known;
    estimation::PadBelief& belief = straight.belief;
    if (belief.motion == estimation::PadMotion::kTurn) {
      belief.motion = estimation::PadMotion::kHeading;
      belief.mean[4] = 0.0;
      belief.cov.row(4).setZero();
      belief.cov.col(4).setZero();
    }
    return AlongTheBelief::Predict(straight);
  }
};

class Oracle final : public PadPredictor {
 public:
  explicit Oracle(std::shared_ptr<const sim::PadCourse> truth) : prediction_(std::move(truth)) {}
  const estimation::PadPrediction& Predict(const PadKnowledge& /*known*/) override {
    return prediction_;
  }

 private:
  sim::OraclePadPrediction prediction_;
};

PredictorEntry Predictor(const char* name, const char* summary,
                         std::function<std::unique_ptr<PadPredictor>(const PredictorSetup&)> make) {
  PredictorEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.make = std::move(make);
  return entry;
}

}  // namespace

std::vector<PredictorEntry> StandardPredictors() {
  return {
      Predictor("paper", "straight on",
                [](const PredictorSetup&) { return std::make_unique<StraightOn>(); }),
      Predictor("turn_rate", "along an arc, straight on if estimator.pad is paper",
                [](const PredictorSetup&) { return std::make_unique<AlongTheBelief>(); }),
      Predictor("oracle", "the true future, as soon as the pad is seen",
                [](const PredictorSetup& setup) { return std::make_unique<Oracle>(setup.truth); }),
  };
}

}  // namespace touchdown::evaluation
