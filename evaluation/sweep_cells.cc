// SPDX-License-Identifier: BSD-3-Clause
// Rates and medians by combination of listed values: what is asked of a sweep that varies a key.
#include "touchdown/evaluation/sweep_cells.h"

#include <map>

namespace touchdown::evaluation {

CellPlan PlanCells(const Campaign& campaign) {
  CellPlan plan;
  std::map<std::vector<std::pair<std::string, std::string>>, int> known;
  for (const SweepTrial& trial : campaign.trials) {
    CellPlan::Cell cell;
    for (std::size_t i = 0; i < campaign.keys.size(); ++i) {
      if (!campaign.keys[i].range) cell.values.push_back(trial.varied.at(i));
    }
    const int next = static_cast<int>(plan.cells.size());
    const int at = known.emplace(cell.values, next).first->second;
    if (at == next) plan.cells.push_back(std::move(cell));
    ++plan.cells[static_cast<std::size_t>(at)].trials;
    plan.cell_of.push_back(at);
  }
  return plan;
}

void CellTally::Add(const TrialResult& result) {
  ++trials_;
  succeeded_ += result.succeeded() ? 1 : 0;
  if (!result.landed()) return;
  times_.push_back(result.touchdown->t);
  errors_.push_back(result.touchdown->error_m);
}

CellFigures CellTally::Figures() const {
  CellFigures figures;
  figures.trials = trials_;
  figures.succeeded = succeeded_;
  if (trials_ > 0) figures.rate = ClopperPearson(succeeded_, trials_);
  figures.time_to_land_median_s = Quantile(times_, 0.5);
  figures.touchdown_error_median_m = Quantile(errors_, 0.5);
  return figures;
}

}  // namespace touchdown::evaluation
