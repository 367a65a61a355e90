// SPDX-License-Identifier: BSD-3-Clause
// Rates and medians by combination of listed values, for a sweep that varies a key.
#include "evaluation/campaign/sweep_cells.h"

#include <algorithm>
#include <map>

namespace touchdown::evaluation {
namespace {

// Always sorted, because a median is needed after every trial, and there may be very many.
void Insert(double value, std::vector<double>* sorted) {
  sorted->insert(std::upper_bound(sorted->begin(), sorted->end(), value), value);
}

}  // namespace

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
  Insert(result.touchdown->t, &times_);
  Insert(result.touchdown->error_m, &errors_);
}

CellFigures CellTally::Figures() const {
  CellFigures figures;
  figures.trials = trials_;
  figures.succeeded = succeeded_;
  if (trials_ > 0) figures.rate = ClopperPearson(succeeded_, trials_);
  figures.time_to_land_median_s = QuantileOfSorted(times_, 0.5);
  figures.touchdown_error_median_m = QuantileOfSorted(errors_, 0.5);
  return figures;
}

}  // namespace touchdown::evaluation
