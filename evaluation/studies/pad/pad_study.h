// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/flight/pad_log.h"
#include "evaluation/judge/landing_judge.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Accuracy of the pad's estimate and prediction in flights, for each of the filter's models.
struct PadStudyOptions {
  std::vector<std::string> scenarios = {"straight_turn", "circle"};
  std::vector<double> sigmas = {0.01, 0.5, 1.0};  ///< gps.sigma [m]
  std::vector<std::string> overrides;             ///< as --set, of other keys
  int trials = 100;                               ///< of each scenario and sigma
  std::uint64_t seed = 1;                         ///< trial seeds follow from it as in a sweep
  int jobs = 1;
};

inline constexpr double kPadHorizon = 1.5;  ///< of the prediction [s]
inline constexpr double kPadSettled = 3.0;  ///< flights count from here on [s]
/// The filter took a sighting at most so old: it goes by tags, else by GPS alone [s].
inline constexpr double kPadTagsFresh = 0.5;

/// How the pad drove from a sample to its horizon.
enum class PadCourse { kStraight, kTurn, kChanging };
const char* ToString(PadCourse course);

/// Sums over samples; errors are horizontal.
struct PadSums {
  int samples = 0;
  double position2 = 0.0;    ///< of squared errors [m^2]
  double velocity2 = 0.0;    ///< [m^2/s^2]
  double prediction2 = 0.0;  ///< of the position kPadHorizon ahead [m^2]
  double nees_position = 0.0, nees_state = 0.0, nees_prediction = 0.0;  ///< over degrees of freedom
  void Add(const PadSums& other);
};

/// One flight, whether it left samples or not.
struct PadStudyFlight {
  int scenario = 0, sigma = 0;  ///< indices in the options
  int trial = 0;
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::kError;
};

/// One model's errors in one flight, of one course and one kind of information.
struct PadStudyRow {
  int flight = 0;  ///< index in the study
  estimation::PadModel model = estimation::PadModel::kTurnRate;
  PadCourse course = PadCourse::kStraight;
  bool tags = false;
  PadSums sums;
};

struct PadStudy {
  std::vector<std::string> motions;     ///< how the pad drives, by scenario
  std::vector<PadStudyFlight> flights;  ///< every one that was flown
  std::vector<PadStudyRow> rows;
};

/// Runs a filter of each model on the measurements of the flight's filter. Compares it with the truth at every sample
/// from kPadSettled to contact whose horizon the log reaches. A sample is by tags if it is for both, so that both
/// models have the same samples. One row for each model, course and information that occurred; `flight` is not set.
/// @param options of both; their model is not read.
std::vector<PadStudyRow> ReplayPadLog(const PadLog& log,
                                      const estimation::PadFilterOptions& options);

/// Flies the trials, each once, and runs both models on the input of its filter. Rows do not depend on `jobs`.
/// @throws BadInput for an invalid scenario, and for a gps.sigma among the overrides that differs from a cell's. Also
/// where the vehicle's own state is estimated: its pad filter lives in that estimate's frame, the truth in W. Also what
/// RunTrial throws.
PadStudy RunPadStudy(const PadStudyOptions& options, const Registries& registries,
                     const std::function<void(int done, int all)>& progress);

}  // namespace touchdown::evaluation
