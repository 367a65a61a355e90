// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::estimation {

/// The largest variance in any direction of the plane: the larger eigenvalue of a symmetric 2x2
/// matrix. Its lower left number is not read. Does not allocate.
double LargestVariance(const Eigen::Matrix2d& cov);

}  // namespace touchdown::estimation
