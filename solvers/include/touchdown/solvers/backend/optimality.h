// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/backend/constraint_rows.h"
#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// Judges the points that backends return, whatever they say of them.
class OptimalityCheck {
 public:
  using MustStop = std::function<bool()>;

  /// Allocates for views of this structure.
  void Prepare(const View& view);

  /// Checks y. `told` has the backend's multipliers, or none. If they do not make the point
  /// stationary, they are estimated from the rows and variables at their bounds. `first_cost`: the
  /// cost at the start of the solve. `storage` was sized by the view, and is overwritten. Asks
  /// `must_stop` before every evaluation; if it says yes, returns what is known so far. Does not
  /// allocate.
  Optimality Look(const View& view, const Eigen::VectorXd& y, const SolverResult& told,
                  double first_cost, const MustStop& must_stop, ViewEvaluation* storage);

  /// An estimate of how far the cost of y, which keeps the rows, may be above the optimum. It comes
  /// from a quadratic model: the gain of a Newton step of the Lagrangian, plus the distances of
  /// pushing rows from their bounds times estimated multipliers. It is a bound if the problem is
  /// convex and quadratic. Infinite where the Lagrangian does not curve upwards. Does not allocate.
  double Above(const View& view, const Eigen::VectorXd& y, ViewEvaluation* storage);

  /// Where steps along the slopes of the rows end (Gauss-Newton's, least squares of what they are off).
  enum class Foot {
    kMeets,    ///< at a point that meets them: a backend that says they cannot be met only gave up
    kLeast,    ///< where no step meets them better: they cannot be met, as far as is seen from here
    kUnknown,  ///< elsewhere: stopped, slow, or where rows cannot be evaluated
  };
  /// From y, or from beside it. Does not allocate.
  Foot StepOntoRows(const View& view, const Eigen::VectorXd& y, const MustStop& must_stop,
                    ViewEvaluation* storage);

 private:
  /// At which of its bounds a row is, by its multiplier's sign.
  enum class Side : signed char { kLower = -1, kNone = 0, kUpper = 1, kBoth = 2 };

  /// Rows that are held: those of side_, or all that are at a bound.
  enum class Kept { kHeld, kAtBounds };
  enum class Metric { kSizes, kDiagonal };
  /// Of a walk from y outwards: each point so many times as far as the one before.
  struct Reach {
    double outwards, farthest;
  };
  static constexpr double kFirstShift = 1e-15;  // rounding, share of the diagonal
  static constexpr double kShiftGrowth = 10.0;

  bool Begin(const View& view, const Eigen::VectorXd& y, const MustStop& must_stop,
             ViewEvaluation* storage);
  bool Evaluate(const double* y, Want want, const Lagrangian& lagrangian);
  void TakeMultipliers(const SolverResult& told);
  bool Estimate();
  Optimality Weigh();
  double Beyond(int row, double u) const;
  double Violation(int row, double u) const;
  double Violation(const std::vector<double>& u) const;
  double SquaredViolation(const std::vector<double>& u) const;
  double WayTo(int row, double multiplier) const;
  Side SideOf(int row) const;
  bool EvaluateHessian(const double* multipliers, const double* weights, double cost_factor);
  void WeighRows(Kept kept);
  bool FactorRows();
  void ShortestStep();
  bool StepsCloser(bool* least);
  void ReleaseBounds();
  void MoveAway(double share, const std::vector<double>& way);
  void Residual(const double* lambda);
  bool HoldRows();
  bool FactorShifted();
  void Shift(double share);
  void MeasureDiagonal();
  double CostValue() const;
  // optimality_neighbours.cc
  void LookAround(Optimality* found);
  bool RefuteSoftWays(Optimality* found);
  bool FactorRowsAtBounds();
  bool Refutes(const Reach& reach, Optimality* found);
  double Fall(double sign, const Reach& reach, double rise, double* where);
  bool RisesBefore(double way, double rise);
  bool FactorAcross();
  double Sink(double away, double enough);
  void AcrossStep();
  void LagrangianSlope();
  bool EvaluateOnRows();
  double OffRow(int row) const;
  bool HoldPushing(double pushes);
  bool HoldsAll() const;
  bool CurvesUpwards();
  bool SoftestWay(Metric metric);

  const View* view_ = nullptr;
  const Eigen::VectorXd* y_ = nullptr;
  Eigen::VectorXd foot_;  // of steps onto the rows
  const MustStop* must_stop_ = nullptr;
  ViewEvaluation* at_ = nullptr;
  int evaluations_ = 0;
  double first_cost_ = 0.0;
  double cost_ = 0.0;
  double cost_size_ = 0.0;  // what was gained, or its slope
  double curvature_ = 0.0;  // the most of the Lagrangian
  double left_ = 0.0;       // of the cost, by the conditions
  double at_bound_ = 0.0;   // way of a row to its bound, along its slope
  double shift_ = 0.0;      // that made the Hessian definite, share of the diagonal
  ConstraintRows rows_;     // bounds among them
  BorderedCholesky factor_;
  BorderedCholesky across_;  // of the Hessian, where walks look for the bottom of a valley
  bool sinks_ = false;       // they do
  double softness_ = 0.0;    // on its diagonal
  std::vector<double> size_;  // of each variable, 1 + |y_i|; what follows is in variables over it
  std::vector<double>
      diagonal_;  // what shifts are a share of: the largest in each row of a Hessian
  std::vector<double> gradient_, residual_, step_, way_, soft_, near_;
  std::vector<double> slope_, sink_, soft_share_;
  std::vector<int> order_;
  std::vector<double> u_, u_near_, off_, jacobian_, norm_, lambda_, weight_;
  std::vector<Side> side_;
  std::vector<std::vector<double>> by_term_, weights_by_term_;
  std::vector<RowWeights> row_weights_;
  std::vector<const double*> multipliers_;  // by_term_
};

}  // namespace touchdown::solvers
