// SPDX-License-Identifier: BSD-3-Clause
// The eigenvalues of a symmetric 2x2 matrix are the roots of its characteristic polynomial.
#include "estimation/base/covariance.h"

#include <cmath>

namespace touchdown::estimation {

double LargestVariance(const Eigen::Matrix2d& cov) {
  return 0.5 * cov.trace() + std::hypot(0.5 * (cov(0, 0) - cov(1, 1)), cov(0, 1));
}

}  // namespace touchdown::estimation
