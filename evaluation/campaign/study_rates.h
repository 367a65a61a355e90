// SPDX-License-Identifier: BSD-3-Clause
// The results of a study, in rates with intervals. Its command prints them without any other program.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/statistics.h"

namespace touchdown::evaluation {

/// One method in one cell.
struct PartRates {
  std::string cell, cell_title;
  std::string method, method_title;
  int planned = 0;                              ///< trials
  std::string refusal;                          ///< why none is flown; empty: they are
  int trials = 0;                               ///< flown
  int succeeded = 0;                            ///< landed, or followed
  Interval rate;                                ///< 95 % Clopper-Pearson
  Quantiles time_to_land_s, touchdown_error_m;  ///< of the landed
  std::map<std::string, int> outcomes;          ///< of all
};

struct StudyRates {
  std::string folder, study;
  bool quick = false;
  bool part = false;  ///< of the study, as --cells, --methods or --trials asked for
  std::uint64_t seed = 0;
  int trials = 0;
  int errors = 0;                ///< trials that ended in an error of the program
  std::vector<PartRates> parts;  ///< in the order in which they were planned
};

/// The rates of what the study's folder holds now. @throws BadInput if it is no study's
StudyRates ReadStudyRates(const std::string& folder);

/// For people: a line for each method in each cell, with how its other trials ended.
std::string StudyRatesText(const StudyRates& rates);
nlohmann::ordered_json StudyRatesJson(const StudyRates& rates);

}  // namespace touchdown::evaluation
