// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "touchdown/solvers/linear/bordered_band_matrix.h"
#include "touchdown/solvers/problem/loss.h"

namespace touchdown::solvers {

/// What people and the derivative checks want to know of a term.
struct TermInfo {
  std::string name;
  std::string formula;  ///< one line, in the symbols of docs/formulation.md
  std::string unit;     ///< of the inner map u
  std::string source;   ///< paper and equation
  bool convex = false;  ///< convex in the blocks at a fixed interval
};

/// Longest window a term may have, in blocks.
inline constexpr int kMaxWindow = 6;

/// Whether a term is part of the objective or a set of constraint rows.
enum class Role { kCost, kConstraint };

/// A term of the objective or a set of constraint rows. The cost is the sum over windows k and
/// components c of rho(u_c(q_k .. q_{k+w-1}, h, t_k)), t_k = t0 + k h. Rows are lo <= u_c <= hi.
struct TermShape {
  int block_size = 3;         ///< scalars in a block, d
  int window = 1;             ///< consecutive blocks in a window, w <= kMaxWindow
  int outputs = 1;            ///< components of u, m
  int max_windows = 0;        ///< most windows it can ever have at this problem size
  bool uses_interval = true;  ///< u depends on h
  bool quadratic = false;     ///< u affine in the blocks, rho quadratic, r affine in u: one Hessian
                              ///< and one residual Jacobian for all x
  bool has_residual = true;   ///< its cost is a sum of squares r^2 / 2
  /// Relative error of du: rounding, unless du is found by differences.
  double slope_error = std::numeric_limits<double>::epsilon();

  /// Scalars in a window, v = w d.
  int variables() const { return window * block_size; }
  /// The row of an output of a window: its place in TermBlock, in multipliers and in row weights.
  int row(int of_window, int output) const { return of_window * outputs + output; }
};

/// Where a term is evaluated.
struct TermInput {
  const double* x = nullptr;   ///< blocks x block_size, block by block
  double h = 1.0;              ///< knot interval [s]
  double t0 = 0.0;             ///< absolute time of knot 0 [s]
  bool free_interval = false;  ///< h is a variable: its derivatives are wanted too
  /// Bounds of x and of a free h, for terms that find derivatives by differences. Null: none.
  const double* lower = nullptr;
  const double* upper = nullptr;
  double h_lower = 0.0, h_upper = std::numeric_limits<double>::infinity();
};

/// What is wanted of an evaluation; implied parts are added by the term (a Hessian needs
/// gradients).
struct Want {
  bool gradient = false;
  bool hessian = false;   ///< of the Lagrangian; only if gradient is wanted too
  bool residual = false;  ///< r and dr of the cost terms, for least-squares backends
};

/// The share of one constraint term's rows in a Lagrangian: sum of multiplier x u + weight x u^2 /
/// 2. Of the square's curvature only weight x du du^T is used. Arrays over [row]; null: zero.
struct RowWeights {
  const double* multiplier = nullptr;
  const double* weight = nullptr;
};

/// How a term is to be evaluated and added up.
struct TermRequest {
  Want want;
  Role role = Role::kCost;
  double objective_factor = 1.0;  ///< of a cost in the Hessian
  RowWeights rows;                ///< of a constraint
  /// Every loss uses its nominal curvature instead of its own second derivative, and inner maps add
  /// no curvature: the metric of whitening.h.
  bool nominal_curvature = false;
  bool jacobian_known = false;  ///< du in the block is still right: u is affine, h the same
  bool hessian_known = false;   ///< its Hessian is in the sum already
};

/// Sums over all terms, in the problem's variables: blocks x d, then h where it is free.
struct TermSums {
  double* gradient = nullptr;      ///< += sum of drho du over costs
  double* row_gradient = nullptr;  ///< += sum of multiplier du over rows
  int interval_index = 0;          ///< place of h in both
  BorderedBandMatrix* hessian = nullptr;
};

/// What one term hands to adapters and views: plain arrays over the rows of its active windows,
/// sized once. The rows of a window are consecutive, one for each output (TermShape::row).
struct TermBlock {
  int windows = 0;                       ///< active now, <= max_windows
  std::vector<int> first_block;          ///< [window]
  std::vector<double> u;                 ///< [row]
  std::vector<double> du;                ///< [row][v], see slopes
  std::vector<double> du_dh;             ///< [row], t_k's share included
  std::vector<double> rho, drho, d2rho;  ///< [row], of a cost
  std::vector<double> r, dr;             ///< [row], residual and dr/du of a cost

  int rows() const { return windows * outputs_; }  ///< active now
  int window_of(int row) const { return row / outputs_; }
  /// du of a row by the v scalars of its window.
  double* slopes(int row) { return &du[static_cast<std::size_t>(row * variables_)]; }
  const double* slopes(int row) const { return &du[static_cast<std::size_t>(row * variables_)]; }

  /// Sizes every array for `shape`. The only call that allocates.
  void Resize(const TermShape& shape);
  /// It was resized for this shape.
  bool Fits(const TermShape& shape) const;

 private:
  int outputs_ = 1, variables_ = 1, max_windows_ = 0;  // of the shape
};

/// The base of every term. Users write an inner map and take WindowTerm (window_term.h), which
/// derives the rest; adapters see only this.
class Term {
 public:
  virtual ~Term() = default;

  virtual const TermInfo& info() const = 0;
  virtual const TermShape& shape() const = 0;
  /// Feasible interval of every u_c where the term is made hard.
  virtual LossBounds bounds() const = 0;
  /// Weight of its rows in the metric of whitening.h where they are equalities.
  virtual double nominal_row_weight() const = 0;

  /// Sets block->windows and first_block.
  virtual void Place(TermBlock* block) const = 0;
  /// Fills the rest of a placed `block` and adds to `sums` what is wanted. Where the term cannot be
  /// evaluated it leaves NaN in u. Must not allocate. An exception is caught by the Problem.
  virtual void Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                        const TermSums& sums) const = 0;
};

}  // namespace touchdown::solvers
