// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/problem/affine_lift.h"
#include "touchdown/solvers/problem/problem.h"

namespace touchdown::solvers {

/// Evaluation of a view: the reduced quantities, and the problem's own beneath them.
struct ViewEvaluation {
  Evaluation full;
  std::vector<double> x;         ///< lifted blocks
  std::vector<double> dl, d2l;   ///< derivatives of the offset with respect to h
  double h = 1.0;                ///< interval of this evaluation
  std::vector<double> gradient;  ///< of the objective: reduced blocks x d, then h if free
  BorderedBandMatrix hessian;    ///< of the Lagrangian

  /// See Evaluation::HoldParameters; the lift's offset at a fixed interval is held too.
  void HoldParameters();

 private:
  friend class View;
  bool hold_ = false;
  bool offset_known_ = false;
  std::vector<double> offset_;   // at a fixed interval
  std::vector<double> scratch_;  // full size
};

/// A Problem in the variables that a backend works on: y = the reduced blocks, then h if it is
/// free. With the identity lift this is the Full view; with the elimination of
/// planning/boundary_lift the Reduced one. The problem and the lift's offset must outlive the view
/// and must not change during a solve. Terms and bounds that are added to the problem later count
/// too: storage that was sized before must be sized again.
class View {
 public:
  /// Throws std::invalid_argument if the lift does not fit the problem.
  View(const Problem& problem, AffineLift lift);
  /// The problem in its own variables.
  explicit View(const Problem& problem)
      : View(problem, AffineLift::Identity(problem.shape().blocks)) {}
  /// A view of a temporary would be one of nothing.
  View(const Problem&&, AffineLift) = delete;
  explicit View(const Problem&&) = delete;

  const Problem& problem() const { return *problem_; }
  const AffineLift& lift() const { return lift_; }
  int blocks() const { return lift_.reduced_blocks; }
  int block_size() const { return problem_->shape().block_size; }
  bool free_interval() const { return problem_->shape().free_interval; }
  /// Its variables are the problem's own.
  bool identity() const;
  /// Variables but the interval have bounds.
  bool bounded() const { return problem_->bounded(); }
  /// Variables but the interval have bounds, or there are constraint rows.
  bool constrained() const;
  /// Bounds of variable i, including the interval. Except for the interval they are only useful if
  /// the view is the identity.
  double lower(int i) const;
  double upper(int i) const;
  /// Its bounds leave it one value.
  bool fixed(int i) const { return lower(i) == upper(i); }
  int num_free_variables() const;
  /// Moves what is beyond its bounds onto them. Does not allocate.
  void MoveIntoBounds(double* y) const;
  int num_variables() const { return blocks() * block_size() + (free_interval() ? 1 : 0); }

  /// Allocates what Evaluate needs.
  void Resize(ViewEvaluation* evaluation) const;

  /// Evaluates at y; see Problem::Evaluate. Does not allocate. Returns false, and says why in
  /// `full.failure`, if the evaluation does not have the sizes of this view and its problem.
  bool Evaluate(const double* y, Want want, const Lagrangian& lagrangian,
                ViewEvaluation* evaluation) const noexcept;

  /// out = J^T w over all constraint rows at the last evaluation (with gradients). It maps
  /// multipliers or right-hand sides `weights[term][row]` to the view's variables.
  void MultiplyRowsTransposed(const double* const* weights, ViewEvaluation* evaluation,
                              double* out) const;
  /// out[term][row] = J dy over all constraint rows, at the last evaluation.
  void MultiplyRows(const double* dy, ViewEvaluation* evaluation, double* const* out) const;

  /// The problem's blocks at y, and the interval there.
  void Lift(const double* y, std::vector<double>* x, double* h) const;
  /// The reduced variables of a point: the inverse of Lift where x lies in its range, else the
  /// nearest by each block's first occurrence.
  Eigen::VectorXd Restrict(const double* x, double h) const;

  /// The distinct reduced blocks that a window reaches, in order; at most `window` of them.
  /// Returns their number.
  int WindowBlocks(int first_block, int window, int* reduced) const;
  /// `scale` times the derivative of one output of a window by the reduced blocks that WindowBlocks
  /// lists. `du` is the derivative by its full blocks; `out` has d numbers for each reduced block.
  void WindowJacobian(const double* du, int first_block, int window, double scale,
                      double* out) const;
  /// Its derivative, unscaled, with respect to h, the moving offset included.
  double IntervalDerivative(const double* du, double du_dh, int first_block, int window,
                            const ViewEvaluation& evaluation) const;

 private:
  bool Fits(const ViewEvaluation& evaluation) const;
  void ComputeOffset(Want want, ViewEvaluation* evaluation) const;
  void AddReducedBlocks(const double* y, double* x) const;
  void ReduceVector(const double* full, const ViewEvaluation& evaluation, double* out) const;
  void ReduceHessian(const Lagrangian& lagrangian, ViewEvaluation* evaluation) const;

  const Problem* problem_;
  AffineLift lift_;
  std::vector<int> run_;  // [block]: so many from it on are one to one, and follow each other
};

}  // namespace touchdown::solvers
