// SPDX-License-Identifier: BSD-3-Clause
// Rates and medians by combination of listed values: what is asked of a sweep that varies a key.
#include "touchdown/evaluation/sweep_cells.h"

#include <algorithm>

namespace touchdown::evaluation {
namespace {

struct Gathered {
  SweepCell cell;
  std::vector<double> times;
  std::vector<double> errors;
};

void Add(const TrialResult& result, Gathered* to) {
  ++to->cell.trials;
  to->cell.succeeded += result.succeeded() ? 1 : 0;
  if (!result.landed()) return;
  to->times.push_back(result.touchdown->t);
  to->errors.push_back(result.touchdown->error_m);
}

}  // namespace

std::vector<SweepCell> SweepCells(const SweepOptions& options, const std::vector<SweepRow>& rows) {
  std::vector<Gathered> all;
  for (const SweepRow& row : rows) {
    SweepCell cell;
    for (std::size_t i = 0; i < options.variations.size(); ++i) {
      if (!options.variations[i].values.empty()) cell.values.push_back(row.trial.varied[i]);
    }
    auto at = std::find_if(all.begin(), all.end(), [&](const Gathered& gathered) {
      return gathered.cell.values == cell.values;
    });
    if (at == all.end()) at = all.insert(at, {std::move(cell), {}, {}});
    Add(row.result, &*at);
  }
  std::vector<SweepCell> cells;
  for (Gathered& gathered : all) {
    SweepCell& cell = cells.emplace_back(std::move(gathered.cell));
    cell.rate = ClopperPearson(cell.succeeded, cell.trials);
    cell.time_to_land_median_s = Quantile(gathered.times, 0.5);
    cell.touchdown_error_median_m = Quantile(gathered.errors, 0.5);
  }
  return cells;
}

}  // namespace touchdown::evaluation
