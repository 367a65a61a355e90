// SPDX-License-Identifier: BSD-3-Clause
// Chi-squared quantile for 1 to 3 degrees of freedom, by bisection of the closed-form distribution:
// enough for gates, and no dependency.

#include "estimation/base/chi_squared.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace touchdown::estimation {

double ChiSquaredQuantile(int degrees, double probability) {
  if (degrees < 1 || degrees > 3) {
    throw std::invalid_argument("ChiSquaredQuantile: degrees = " + std::to_string(degrees) +
                                ", allowed: 1 to 3");
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    throw std::invalid_argument("ChiSquaredQuantile: probability = " + std::to_string(probability) +
                                ", allowed: (0, 1)");
  }
  const auto cdf = [degrees](double x) {
    if (degrees == 2) return 1.0 - std::exp(-0.5 * x);
    const double one = std::erf(std::sqrt(0.5 * x));
    return degrees == 1 ? one : one - std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-0.5 * x);
  };
  double low = 0.0;
  double high = 200.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (cdf(middle) < probability ? low : high) = middle;
  }
  return high;
}

}  // namespace touchdown::estimation
