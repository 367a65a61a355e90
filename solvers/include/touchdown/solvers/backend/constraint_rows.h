// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// The constraint rows of a view as one flat list lo <= u_r(y) <= hi with a sparse Jacobian, for
/// backends that want them so. Rows are ordered by term, then active window, then output. A row
/// without a variable that is free, one on eliminated blocks or on fixed variables alone, is a
/// constant, which no solver can change. It is left out here, and only its violation is kept.
class ConstraintRows {
 public:
  /// Allocates for the most rows that views of this structure can have. With `bounds` those of
  /// variables, the interval's among them, follow the others as rows u = y_i.
  void Prepare(const View& view, bool bounds = false);
  /// Takes the rows that are active in `evaluation`, which must have been evaluated. Does not
  /// allocate.
  void Set(const View& view, const ViewEvaluation& evaluation);

  int size() const { return static_cast<int>(lo_.size()); }
  double lo(int row) const { return lo_[row]; }
  double hi(int row) const { return hi_[row]; }
  /// The first of the rows that are bounds; size() without any.
  int first_bound() const { return first_bound_; }
  /// Worst violation of the rows that were left out.
  double constant_violation() const { return constant_violation_; }

  /// Nonzeros of the Jacobian, row by row; the columns of a row ascend.
  int nonzeros() const { return static_cast<int>(column_.size()); }
  /// The most that there can be, in views of the prepared structure.
  int most_nonzeros() const { return static_cast<int>(column_.capacity()); }
  /// First nonzero of a row; of size(): nonzeros().
  int start(int row) const { return start_[row]; }
  int column(int nonzero) const { return column_[nonzero]; }

  /// u of every row, at an evaluation of the same view.
  void Values(const ViewEvaluation& evaluation, double* u) const;
  /// Every nonzero; the evaluation must hold gradients.
  void Jacobian(const ViewEvaluation& evaluation, double* values) const;

  /// Multipliers row by row to [term][row], without bounds, 0 at constant rows; sized
  /// by Prepare.
  void Spread(const double* flat, std::vector<std::vector<double>>* by_term) const;
  /// The inverse; false if `by_term` does not hold every row.
  bool Gather(const std::vector<std::vector<double>>& by_term, double* flat) const;
  /// Sizes [term][row] for the most rows.
  static void Size(const View& view, std::vector<std::vector<double>>* by_term);
  /// Whether they have that size.
  static bool Fit(const View& view, const std::vector<std::vector<double>>& by_term);

 private:
  /// One window with all its outputs, which share their columns.
  struct Window {
    int term;
    int index;
    int first_block;
    int reduced_count;
    int reduced[kMaxWindow];
  };
  static bool IsConstant(const View& view, const Window& window);

  const View* view_ = nullptr;
  std::vector<Window> windows_;
  std::vector<double> lo_, hi_;
  std::vector<int> start_, column_;
  bool with_bounds_ = false;
  int first_bound_ = 0;
  double constant_violation_ = 0.0;
};

}  // namespace touchdown::solvers
