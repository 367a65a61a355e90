// SPDX-License-Identifier: BSD-3-Clause
// Small terms on scalar blocks: the conformance problems, and terms that misbehave on purpose.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "touchdown/solvers/problem/view.h"
#include "touchdown/solvers/problem/window_term.h"

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

/// An offset that moves nonlinearly with h.
class CurvedOffset : public LiftOffset {
 public:
  explicit CurvedOffset(int n) : n_(n) {}
  void At(double h, double* l, double* dl, double* d2l) const noexcept override {
    for (int i = 0; i < n_; ++i) {
      l[i] = std::sin(i + h);
      if (dl) dl[i] = std::cos(i + h);
      if (d2l) d2l[i] = -std::sin(i + h);
    }
  }

 private:
  int n_;
};

/// Blocks 0 and 1 fixed, the last three folded onto one reduced block, as a landing's ends are,
/// with a CurvedOffset. Blocks of two.
inline View FoldedView(const Problem& problem) {
  AffineLift lift;
  const int n = problem.shape().blocks;
  for (int i = 0; i < n; ++i) {
    lift.block.push_back(i < 2 ? -1 : std::min(i - 2, n - 5));
    lift.coefficient.push_back(i < 2 ? 0.0 : i == n - 2 ? 1.0 : i > n - 4 ? -2.0 : 1.0);
  }
  lift.reduced_blocks = n - 4;
  lift.offset = std::make_shared<CurvedOffset>(2 * n);
  return View(problem, lift);
}

}  // namespace touchdown::solvers
