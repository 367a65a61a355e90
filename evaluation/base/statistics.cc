// SPDX-License-Identifier: BSD-3-Clause
// The exact binomial interval of Clopper and Pearson (1934) through Boost.Math's beta quantiles.
// Each one-sided bound is taken at (1 - confidence) / 2. Sample quantiles are type 7 of Hyndman and
// Fan (1996).
#include "evaluation/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace touchdown::evaluation {

Interval ClopperPearson(int successes, int trials, double confidence) {
  if (trials < 1 || successes < 0 || successes > trials) {
    throw std::invalid_argument("ClopperPearson needs 0 <= successes <= trials and trials >= 1");
  }
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument("ClopperPearson needs a confidence in (0, 1)");
  }
  using Binomial = boost::math::binomial_distribution<double>;
  const double tail = 0.5 * (1.0 - confidence);
  return {Binomial::find_lower_bound_on_p(trials, successes, tail),
          Binomial::find_upper_bound_on_p(trials, successes, tail)};
}

std::optional<double> Quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return QuantileOfSorted(values, q);
}

std::optional<double> QuantileOfSorted(const std::vector<double>& values, double q) {
  if (!(q >= 0.0 && q <= 1.0)) throw std::invalid_argument("Quantile needs q in [0, 1]");
  if (values.empty()) return std::nullopt;
  const double rank = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  const double share = rank - static_cast<double>(below);
  return values[below] + share * (values[above] - values[below]);
}

namespace {

// Statistics' quantile interpolates; next to an infinite value there is nothing to interpolate.
std::optional<double> QuantileWithFailures(const std::vector<double>& values, double q) {
  std::vector<double> capped = values;
  const double huge = 1e300;
  for (double& value : capped) {
    if (!std::isfinite(value)) value = huge;
  }
  const std::optional<double> quantile = Quantile(capped, q);
  return quantile && *quantile > 1e290 ? std::numeric_limits<double>::infinity() : quantile;
}

}  // namespace

Quantiles QuantilesOf(const std::vector<double>& values) {
  return {QuantileWithFailures(values, 0.5), QuantileWithFailures(values, 0.95),
          QuantileWithFailures(values, 0.99), QuantileWithFailures(values, 1.0)};
}

}  // namespace touchdown::evaluation
