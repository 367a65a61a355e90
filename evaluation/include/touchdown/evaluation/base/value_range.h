// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// The allowed values of a key, for messages and documentation.
struct ValueRange {
  double lo = 0.0;
  double hi = 0.0;
  bool above_lo = false;  ///< lo itself is not allowed
  std::string unit;       ///< "m/s"; empty: none
  std::string ToString() const;
};

}  // namespace touchdown::evaluation
