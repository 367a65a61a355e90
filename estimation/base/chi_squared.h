// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::estimation {

/// The value that a chi-squared variable stays below with this probability.
/// @param degrees of freedom, 1 to 3. @param probability in (0, 1).
/// Throws std::invalid_argument naming the value and the range.
double ChiSquaredQuantile(int degrees, double probability);

}  // namespace touchdown::estimation
