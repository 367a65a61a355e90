// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/base/statistics.h"
#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// The cells of a campaign, in the order of their first trials. Where no label is listed, the one cell is
/// the whole campaign.
struct CellPlan {
  struct Cell {
    std::vector<std::pair<std::string, std::string>> values;  ///< labels that are not ranges
    int trials = 0;                                           ///< that are planned
  };
  std::vector<Cell> cells;
  std::vector<int> cell_of;  ///< of each trial
};
CellPlan PlanCells(const Campaign& campaign);

/// The results of a cell's flown trials.
struct CellFigures {
  int trials = 0;
  int succeeded = 0;
  std::optional<Interval> rate;                    ///< 95 % Clopper-Pearson
  std::optional<double> time_to_land_median_s;     ///< of the landed trials
  std::optional<double> touchdown_error_median_m;  ///< of the landed trials
};

/// Gathers trials of one cell, in any order.
class CellTally {
 public:
  void Add(const TrialResult& result);
  CellFigures Figures() const;

 private:
  int trials_ = 0;
  int succeeded_ = 0;
  std::vector<double> times_;
  std::vector<double> errors_;
};

}  // namespace touchdown::evaluation
