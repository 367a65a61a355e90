// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/base/statistics.h"
#include "evaluation/studies/pad/pad_study.h"

namespace touchdown::evaluation {

/// One model over many flights: root mean squares and means over all samples.
struct PadModelFigures {
  double position_m = 0.0;
  double velocity_mps = 0.0;
  double prediction_m = 0.0;
  double nees_position = 0.0, nees_state = 0.0, nees_prediction = 0.0;  ///< over degrees of freedom
};

/// Samples of a scenario and a sigma that have course and information in common.
struct PadStudyCell {
  int scenario = 0, sigma = 0;
  std::optional<PadCourse> course;  ///< none: any
  std::optional<bool> tags;         ///< none: any
  int samples = 0;
  int flights = 0;  ///< with such samples
  PadModelFigures paper, turn_rate;
  double ratio = 0.0;  ///< of the prediction's errors, turn_rate over paper
  Interval interval;   ///< its 95 % bootstrap interval, over flights
};

/// The cell for these members of `asked`; nothing without samples.
std::optional<PadStudyCell> Summarise(const PadStudy& study, PadStudyCell asked);

/// Every course, with tags, by GPS alone, and both, and all courses, of every scenario and sigma.
std::vector<PadStudyCell> PadStudyCells(const PadStudyOptions& options, const PadStudy& study);

/// A demand on the turn-rate model, and whether the study fulfils it.
struct PadDemand {
  std::string text;
  std::optional<double> value;  ///< none: no samples
  double limit = 0.0;
  bool met() const { return value && *value <= limit; }
};

/// The demands for every scenario and sigma of the options, with samples or not. They limit the ratio of the
/// prediction's errors, turn_rate over paper. If the pad's motion is the circle, the limit is 1/3 at a GPS up to
/// kPadGoodGps and with tags, and 0.7 at a coarser one. For any other motion it is 1.5 on its straights. The limit of
/// the state's NEES over its degrees of freedom is 1.5.
std::vector<PadDemand> PadDemands(const PadStudyOptions& options, const PadStudy& study);
inline constexpr double kPadGoodGps = 0.05;  ///< [m]

}  // namespace touchdown::evaluation
