// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "touchdown/solvers/linear/bordered_band_matrix.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

/// Size of a problem's variables: N blocks of d scalars and, if free, the knot interval h.
struct ProblemShape {
  int blocks = 0;              ///< N >= 1
  int block_size = 3;          ///< d >= 1
  bool free_interval = false;  ///< h is a variable
  double interval_min = 1e-3;  ///< bounds of a free interval [s]
  double interval_max = 1e3;
};

/// The function whose Hessian is wanted: objective_factor x objective + the rows' shares.
struct Lagrangian {
  double objective_factor = 1.0;
  const RowWeights* rows = nullptr;  ///< [term], read where the term is a constraint; null: no rows
  bool nominal_curvature = false;    ///< see TermRequest
};

/// Result storage of one evaluation; one per thread. Sized by Problem::Resize.
struct Evaluation {
  bool ok = false;                   ///< false: a value or a slope is not finite, or a term threw
  int failed_term = -1;              ///< which one; -1: none, or the gradient of the sum
  std::string failure;               ///< what it threw, or why nothing was evaluated
  double value = 0.0;                ///< sum of the cost terms
  double max_violation = 0.0;        ///< worst violation of a constraint row or a bound
  int worst_term = -1;               ///< whose row that is; -1: none, or a bound
  std::vector<double> gradient;      ///< of the objective: blocks x d, then h if free
  std::vector<double> row_gradient;  ///< sum of multiplier x row, filled with the Hessian
  BorderedBandMatrix hessian;        ///< of the Lagrangian
  std::vector<double> cost_by_term;  ///< [term]; 0 for constraints
  std::vector<TermBlock> terms;      ///< [term]

  /// Declares that parameters stay as they are from now on. Numbers that do not depend on x are
  /// then computed once: windows, Jacobians of affine maps, the Hessian of quadratic terms. Without
  /// it everything is computed at every call.
  void HoldParameters();

 private:
  friend class Problem;
  void ForgetConstants();

  bool hold_ = false;
  bool placed_ = false;
  bool constant_jacobian_ = false;  // du of the quadratic terms is in the blocks
  double constant_factor_ = 0.0;    // objective factor of constant_hessian_; NaN: not there
  bool constant_nominal_ = false;   // its nominal_curvature
  BorderedBandMatrix constant_hessian_;
};

/// An optimisation problem over blocks with windowed terms. Its structure is fixed at construction
/// and by AddTerm; parameters live in the terms and may change between solves without allocation.
/// While a solve runs the problem must not change; then any number of threads may evaluate it, each
/// with its own Evaluation.
class Problem {
 public:
  /// The bound of a row that has none.
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// Throws std::invalid_argument if a size or an interval bound is out of range.
  explicit Problem(const ProblemShape& shape);

  /// Adds a term. Throws std::invalid_argument if its block size differs, its window is longer than
  /// the problem, or the bounds of its rows are not lo <= hi.
  void AddTerm(std::shared_ptr<const Term> term, Role role);

  /// Bounds lower <= x <= upper of the blocks, N x d numbers each, infinite (or beyond kNoBound)
  /// where there is none. For backends that keep them without rows (Capabilities). Throws
  /// std::invalid_argument on another size, or where they are not lower <= upper.
  void SetBounds(std::vector<double> lower, std::vector<double> upper);
  /// Has bounds other than the interval's.
  bool bounded() const { return !lower_.empty(); }
  double lower(int i) const { return bounded() ? lower_[i] : -kInfinity; }
  double upper(int i) const { return bounded() ? upper_[i] : kInfinity; }

  const ProblemShape& shape() const { return shape_; }
  int num_terms() const { return static_cast<int>(terms_.size()); }
  const Term& term(int i) const { return *terms_[i].term; }
  Role role(int i) const { return terms_[i].role; }
  /// Every cost is convex at a fixed interval and the interval is fixed.
  bool convex() const;
  /// Block diagonals above the main one that can be nonzero.
  int half_bandwidth() const { return half_bandwidth_; }

  /// Fixed interval, or the first guess of a free one [s].
  double interval() const { return interval_; }
  void set_interval(double h) { interval_ = h; }
  /// Absolute time of knot 0 [s].
  double t0() const { return t0_; }
  void set_t0(double t0) { t0_ = t0; }

  /// Allocates everything that Evaluate needs.
  void Resize(Evaluation* evaluation) const;
  /// It has the sizes of this problem: Resize has been called since the last AddTerm.
  bool Fits(const Evaluation& evaluation) const;

  /// Evaluates everything wanted at the blocks `x` and interval `h` in one pass. Does not allocate.
  /// Returns evaluation->ok; false, and says why in `failure`, where it does not fit.
  bool Evaluate(const double* x, double h, Want want, const Lagrangian& lagrangian,
                Evaluation* evaluation) const noexcept;

 private:
  struct Entry {
    std::shared_ptr<const Term> term;
    Role role;
  };
  bool EvaluateAll(const double* x, double h, Want want, const Lagrangian& lagrangian,
                   Evaluation* evaluation) const noexcept;
  bool Place(Evaluation* evaluation) const;
  void StartHessian(const Lagrangian& lagrangian, const TermInput& input, const TermSums& sums,
                    Evaluation* evaluation) const;
  bool HeldConstant(const Entry& entry, const Evaluation& evaluation) const;
  bool AddCost(std::size_t i, Evaluation* evaluation) const;
  void AddBoundViolation(const double* x, Evaluation* evaluation) const;
  bool AddViolation(std::size_t i, bool gradient, Evaluation* evaluation) const;

  ProblemShape shape_;
  std::vector<Entry> terms_;
  std::vector<double> lower_, upper_;  // of the blocks, or none
  int half_bandwidth_ = 0;
  double interval_ = 1.0;
  double t0_ = 0.0;
};

}  // namespace touchdown::solvers
