// SPDX-License-Identifier: BSD-3-Clause
// Small terms on scalar blocks: the conformance problems, and terms that misbehave on purpose.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "touchdown/solvers/window_term.h"

namespace touchdown::solvers {

/// An inner map given by a generic callable on all blocks of a problem of `n` scalars at once.
template <int n, int outputs, class Function>
class WholeMap {
 public:
  static constexpr int kBlockSize = 1, kWindow = n, kOutputs = outputs;
  static constexpr bool kUsesInterval = false;
  static constexpr bool kLinearInBlocks = false;

  explicit WholeMap(Function function) : function_(function) {}
  int windows() const { return 1; }
  int first_block(int /*k*/) const { return 0; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    function_(q, u);
  }

 private:
  Function function_;
};

/// A square-loss term sum_c u_c(x)^2 over the whole of x.
template <int n, int outputs, class Function>
std::shared_ptr<Term> SumOfSquares(const std::string& name, Function function, bool convex) {
  using Map = WholeMap<n, outputs, Function>;
  return std::make_shared<WindowTerm<Map, SquareLoss>>(
      TermInfo{name, "sum u^2", "1", "test", convex}, Map(function), SquareLoss(2.0), 1);
}

/// A nonlinear map on windows of three 2-vectors that uses h and t.
class WavyMap {
 public:
  static constexpr int kBlockSize = 2, kWindow = 3, kOutputs = 2;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;
  explicit WavyMap(int windows) : windows_(windows) {}
  int windows() const { return windows_; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& t, T* u) const {
    using std::cos, std::sin;
    u[0] = sin(q[0] * q[3]) + q[5] / h + 0.3 * cos(t);
    u[1] = (q[4] - q[0]) * (q[1] + q[2]) * h;
  }

 private:
  int windows_;
};

}  // namespace touchdown::solvers
