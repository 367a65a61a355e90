// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "touchdown/solvers/problem/dual.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

/// Sizes and windows of a FunctionTerm.
struct FunctionShape {
  int block_size = 1;  ///< scalars in a block, d
  int window = 1;      ///< consecutive blocks that the function sees, w
  int outputs = 1;     ///< m
  int first = 0;       ///< block at which the first window starts
  int windows = 1;     ///< they start at consecutive blocks
};

/// A term whose sizes are known at run time: for small problems, and where a WindowTerm for every
/// size would take long to compile. Its function is written once,
///
///   [](const auto* q, auto* u) { u[0] = q[0] * q[1] - 1.0; }
///
/// on the w d scalars of a window, and is differentiated twice, exactly. If it begins with `int window`, it gets the
/// number of its window, from 0. It does not see the interval. About ten times slower than a WindowTerm of the same
/// size.
class FunctionTerm : public Term {
 public:
  static constexpr int kMostVariables = 32;  ///< w d
  static constexpr int kMostOutputs = 32;    ///< m
  using Loss = AnyLoss;

  /// Throws std::invalid_argument on a size out of range. A function that writes the output behind the last
  /// cannot be evaluated: the solve says so.
  template <class Function>
  FunctionTerm(TermInfo info, const FunctionShape& shape, Loss loss, Function function)
      : FunctionTerm(
            std::move(info), shape, loss,
            Functions{Told<double>(function), Told<First>(function), Told<Second>(function)}) {}

  const TermInfo& info() const override { return info_; }
  const TermShape& shape() const override { return shape_; }
  LossBounds bounds() const override;
  double nominal_row_weight() const override;
  void Place(TermBlock* block) const override;
  void Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                const TermSums& sums) const override;

 private:
  using First = Dual<kMostVariables>;
  using Second = SecondDual<kMostVariables>;
  template <class T>
  using Of = std::function<void(int, const T*, T*)>;
  struct Functions {
    Of<double> value;
    Of<First> first;
    Of<Second> second;
  };
  /// A function that does not ask which window it sees is not told.
  template <class T, class Function>
  static Of<T> Told(const Function& function) {
    if constexpr (std::is_invocable_v<Function&, int, const T*, T*>) {
      return function;
    } else {
      return [f = function](int /*window*/, const T* x, T* u) mutable { f(x, u); };
    }
  }

  FunctionTerm(TermInfo info, const FunctionShape& shape, Loss loss, Functions functions);
  [[noreturn]] void RefuseOutput() const;
  void EvaluateFunction(int window, const double* q, bool derivatives, double* u, double* du) const;
  void AddHessian(int window, const double* q, const TermInput& input, const TermRequest& request,
                  const TermBlock& block, const TermSums& sums) const;

  TermInfo info_;
  TermShape shape_;
  int first_;
  int windows_;
  int variables_;  // of a window
  Loss loss_;
  Functions functions_;
};

}  // namespace touchdown::solvers
