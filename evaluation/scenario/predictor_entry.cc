// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/predictor_entry.h"

#include <utility>

#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::evaluation {
namespace {

class Oracle final : public estimation::PadPredictor {
 public:
  explicit Oracle(std::shared_ptr<const sim::PadCourse> truth) : prediction_(std::move(truth)) {}
  const estimation::PadPrediction& Predict(const estimation::PadKnowledge& /*known*/) override {
    return prediction_;
  }

 private:
  sim::OraclePadPrediction prediction_;
};

PredictorEntry Predictor(
    const char* name, const char* summary,
    std::function<std::unique_ptr<estimation::PadPredictor>(const PredictorSetup&)> make) {
  PredictorEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.make = std::move(make);
  return entry;
}

}  // namespace

std::vector<PredictorEntry> StandardPredictors() {
  return {
      Predictor(
          "paper", "straight on",
          [](const PredictorSetup&) { return std::make_unique<estimation::StraightPredictor>(); }),
      Predictor(
          "turn_rate", "along an arc, straight on if estimator.pad is paper",
          [](const PredictorSetup&) { return std::make_unique<estimation::BeliefPredictor>(); }),
      Predictor("oracle", "the true future, as soon as the pad is seen",
                [](const PredictorSetup& setup) { return std::make_unique<Oracle>(setup.truth); }),
  };
}

}  // namespace touchdown::evaluation
