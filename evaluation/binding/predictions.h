// SPDX-License-Identifier: BSD-3-Clause
// The predicted position of a pad, a goal, or anything that Python defines.
#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "evaluation/binding/bind.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::binding {

/// A prediction that C++ has lent to Python for a call, or one that Python owns.
class Prediction {
 public:
  Prediction() = default;
  explicit Prediction(std::shared_ptr<const estimation::PadPrediction> owned)
      : owned_(std::move(owned)) {}

  /// Raises RuntimeError if it is no longer lent.
  const estimation::PadPrediction& get() const {
    return owned_ ? *owned_ : lent.get("this prediction");
  }
  const std::shared_ptr<const estimation::PadPrediction>& owned() const { return owned_; }

  Borrowed<estimation::PadPrediction> lent;

 private:
  std::shared_ptr<const estimation::PadPrediction> owned_;
};

/// C++'s view of a Prediction that Python owns, or of any object with at(t), which gives a PadState. Raises TypeError,
/// and ValueError for a lent one.
std::shared_ptr<const estimation::PadPrediction> PredictionOf(const pybind11::object& object);

/// Lends a prediction to Python while it lives; None without one.
class PredictionLoan {
 public:
  explicit PredictionLoan(const estimation::PadPrediction* prediction);
  ~PredictionLoan();
  PredictionLoan(const PredictionLoan&) = delete;
  PredictionLoan& operator=(const PredictionLoan&) = delete;
  pybind11::object object() const { return object_; }

 private:
  std::shared_ptr<Prediction> lent_;
  pybind11::object object_;
};

}  // namespace touchdown::binding
