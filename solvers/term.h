// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "touchdown/solvers/loss.h"

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

/// A term of the objective or a set of constraint rows: sum over windows k and components c of
/// rho(u_c(q_k .. q_{k+w-1}, h, t_k)), t_k = t0 + k h. Or, as rows: lo <= u_c <= hi.
struct TermShape {
  int block_size = 3;         ///< scalars in a block, d
  int window = 1;             ///< consecutive blocks in a window, w <= kMaxWindow
  int outputs = 1;            ///< components of u, m
  int max_windows = 0;        ///< most windows it can ever have at this problem size
  bool uses_interval = true;  ///< u depends on h
};

/// Where a term is evaluated.
struct TermInput {
  const double* x = nullptr;   ///< blocks x block_size, block by block
  double h = 1.0;              ///< knot interval [s]
  double t0 = 0.0;             ///< absolute time of knot 0 [s]
  bool free_interval = false;  ///< h is a variable: its derivatives are wanted too
};

/// What is wanted of an evaluation; implied parts are added by the term (a Hessian needs
/// gradients).
struct Want {
  bool gradient = false;
  bool hessian = false;
};

/// What one term hands to adapters and views: plain arrays over its active windows, sized once.
/// With v = w d scalars in a window, arrays are row-major over [window][output][v].
struct TermBlock {
  int windows = 0;                       ///< active now, <= max_windows
  std::vector<int> first_block;          ///< [window]
  std::vector<double> u;                 ///< [window][output]
  std::vector<double> du;                ///< [window][output][v]
  std::vector<double> du_dh;             ///< [window][output], t_k's share included
  std::vector<double> rho, drho, d2rho;  ///< [window][output]
  std::vector<double> r, dr;             ///< [window][output], residual and dr/du
  /// [window][v + 1][v + 1], symmetric, h last: sum_c m_c d2u_c with m = drho for a cost and the
  /// given multiplier for a row.
  std::vector<double> curvature;

  /// Sizes every array for `shape`. The only call that allocates.
  void Resize(const TermShape& shape);
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

  /// Fills `block`. `multipliers` ([window][output]) is null for a cost. Where the term cannot be
  /// evaluated it leaves NaN in u. Must not allocate. An exception is caught by the Problem.
  virtual void Evaluate(const TermInput& input, Want want, const double* multipliers,
                        TermBlock* block) const = 0;
};

/// An entry of a term registry: what the term is, and how to make one with random parameters that
/// fits a spline of `blocks` control points, for derivative checks.
struct TermFactory {
  TermInfo info;
  std::function<std::shared_ptr<Term>(int blocks, std::mt19937_64& random)> sample;
};

}  // namespace touchdown::solvers
