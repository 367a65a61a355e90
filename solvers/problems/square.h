// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::solvers {

/// The square of a number or of one with its derivatives.
template <class T>
T Square(const T& x) {
  return x * x;
}

}  // namespace touchdown::solvers
