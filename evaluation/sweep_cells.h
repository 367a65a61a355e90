// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "touchdown/evaluation/statistics.h"
#include "touchdown/evaluation/sweep.h"

namespace touchdown::evaluation {

/// The trials of a sweep with one combination of the listed values.
struct SweepCell {
  std::vector<std::pair<std::string, std::string>> values;  ///< key and value, listed keys alone
  int trials = 0;
  int succeeded = 0;
  Interval rate;                                   ///< 95 % Clopper-Pearson
  std::optional<double> time_to_land_median_s;     ///< of the landed trials
  std::optional<double> touchdown_error_median_m;  ///< of the landed trials
};

/// The cells in the order of their first trials. A key with a range makes no cells: where no key is
/// listed, the one cell is the whole sweep.
std::vector<SweepCell> SweepCells(const SweepOptions& options, const std::vector<SweepRow>& rows);

}  // namespace touchdown::evaluation
