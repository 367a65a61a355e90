// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "touchdown/estimation/pad_filter.h"
#include "touchdown/evaluation/landing_judge.h"
#include "touchdown/evaluation/pad_log.h"
#include "touchdown/evaluation/scenario.h"

namespace touchdown::evaluation {

/// How well the pad is known and foretold in flights, by each of the filter's models.
struct PadStudyOptions {
  std::vector<std::string> scenarios = {"straight_turn", "circle"};
  std::vector<double> sigmas = {0.01, 0.5, 1.0};  ///< gps.sigma [m]
  std::vector<std::string> overrides;             ///< as --set
  int trials = 100;                               ///< of each scenario and sigma
  std::uint64_t seed = 1;                         ///< trial seeds follow from it as in a sweep
  int jobs = 1;
};

inline constexpr double kPadHorizon = 1.5;  ///< so far ahead is foretold [s]
inline constexpr double kPadSettled = 3.0;  ///< flights count from here on [s]
/// A tag seen at most so long ago: the filter goes by tags, else by GPS alone [s].
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

/// One model's errors in one flight, of one course and one kind of information.
struct PadStudyRow {
  int scenario = 0, sigma = 0;  ///< indices in the options
  int trial = 0;
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::kError;
  estimation::PadModel model = estimation::PadModel::kTurnRate;
  PadCourse course = PadCourse::kStraight;
  bool tags = false;
  PadSums sums;
};

/// Runs a filter on what came to the flight's, and compares it with the truth at every sample from
/// kPadSettled to contact whose horizon the log reaches. One row for each course and information that
/// occurred; only model, course, tags and sums are set.
std::vector<PadStudyRow> ReplayPadLog(const PadLog& log,
                                      const estimation::PadFilterOptions& options);

/// Flies the trials, each once, and runs both models on what its filter was given. Rows do not
/// depend on `jobs`. @throws BadInput for a scenario that cannot be had, and what RunTrial throws.
std::vector<PadStudyRow> RunPadStudy(const PadStudyOptions& options, const Registries& registries,
                                     const std::function<void(int done, int all)>& progress);

}  // namespace touchdown::evaluation
