// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace touchdown::evaluation {

/// Bounds of a probability.
struct Interval {
  double lo = 0.0;
  double hi = 1.0;
};

/// Two-sided Clopper-Pearson interval for `successes` out of `trials` at `confidence` in (0, 1).
/// @throws std::invalid_argument for successes outside [0, trials], trials < 1 or a confidence
/// outside (0, 1).
Interval ClopperPearson(int successes, int trials, double confidence = 0.95);

/// Sample quantile at q in [0, 1], linear between order statistics (Hyndman and Fan's type 7, the
/// default of numpy and R). Empty for no values. @throws std::invalid_argument for q outside [0,
/// 1].
std::optional<double> Quantile(std::vector<double> values, double q);
/// The same for values that are already in order; this is not checked.
std::optional<double> QuantileOfSorted(const std::vector<double>& values, double q);

/// Four figures of a sample. An infinite value (a failure's time) makes the quantiles that reach it
/// infinite. An empty sample has none.
struct Quantiles {
  std::optional<double> median, p95, p99, max;
};
Quantiles QuantilesOf(const std::vector<double>& values);

}  // namespace touchdown::evaluation
