// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of a view against central differences, column by column. The Hessian is compared with
// differences of the (checked) gradient, which keeps the error at the square root's size of the
// second difference's.

#include "touchdown/solvers/derivative_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchdown::solvers {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// All u (or all residuals) of a view's evaluation in one vector.
VectorXd Stack(const View& view, const ViewEvaluation& e, bool residuals) {
  std::vector<double> out;
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    const TermBlock& block = e.full.terms[i];
    const int count = block.windows * view.problem().term(i).shape().outputs;
    const std::vector<double>& from = residuals ? block.r : block.u;
    out.insert(out.end(), from.begin(), from.begin() + count);
  }
  return Eigen::Map<VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

/// The dense Jacobian of Stack in the view's variables, from the terms' own derivatives.
MatrixXd StackJacobian(const View& view, const ViewEvaluation& e, bool residuals) {
  const int d = view.block_size();
  std::vector<VectorXd> rows;
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    const TermBlock& block = e.full.terms[i];
    const TermShape& shape = view.problem().term(i).shape();
    const int v = shape.window * d;
    for (int j = 0; j < block.windows * shape.outputs; ++j) {
      const int first = block.first_block[j / shape.outputs];
      const double* du = &block.du[j * v];
      VectorXd row = VectorXd::Zero(view.num_variables());
      std::vector<int> reduced(static_cast<std::size_t>(shape.window));
      const int count = view.WindowBlocks(first, shape.window, reduced.data());
      for (int b = 0; b < count; ++b) {
        view.WindowJacobian(du, first, shape.window, reduced[b], row.data() + reduced[b] * d);
      }
      if (view.free_interval()) {
        row[view.num_variables() - 1] =
            view.IntervalDerivative(du, block.du_dh[j], first, shape.window, e);
      }
      rows.push_back(residuals ? VectorXd(block.dr[j] * row) : row);
    }
  }
  MatrixXd jacobian(static_cast<Eigen::Index>(rows.size()), view.num_variables());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    jacobian.row(static_cast<Eigen::Index>(r)) = rows[r].transpose();
  }
  return jacobian;
}

/// factor x gradient of the objective + J^T lambda over the constraint rows.
VectorXd LagrangianGradient(const View& view, const ViewEvaluation& e,
                            const Lagrangian& lagrangian) {
  VectorXd gradient = lagrangian.objective_factor *
                      Eigen::Map<const VectorXd>(e.gradient.data(), view.num_variables());
  if (!lagrangian.rows) return gradient;
  const MatrixXd rows = StackJacobian(view, e, false);
  Eigen::Index row = 0;
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    const int count = e.full.terms[i].windows * view.problem().term(i).shape().outputs;
    for (int j = 0; j < count; ++j, ++row) {
      if (view.problem().role(i) != Role::kConstraint || !lagrangian.rows[i].multiplier) continue;
      gradient += lagrangian.rows[i].multiplier[j] * rows.row(row).transpose();
    }
  }
  return gradient;
}

double RelativeError(const MatrixXd& mine, const MatrixXd& difference) {
  if (mine.size() == 0) return 0.0;
  const double scale = 1.0 + difference.cwiseAbs().maxCoeff();
  const double error = (mine - difference).cwiseAbs().maxCoeff() / scale;
  return std::isfinite(error) ? error : HUGE_VAL;
}

/// Evaluations on both sides of the point along one variable.
struct Sides {
  ViewEvaluation at, plus, minus;
  double dz = 0.0;
};

/// Differences of all residuals. A hinge's residual grows like u^1.5: where its u changes sign
/// between the sides no central difference is any good, and as r is convex in u there the
/// derivative must lie between the two one-sided ones; the nearer of them, or `mine` itself, is
/// returned.
VectorXd ResidualDifference(const View& view, const Sides& s, const VectorXd& mine) {
  const VectorXd at = Stack(view, s.at, true), plus = Stack(view, s.plus, true),
                 minus = Stack(view, s.minus, true);
  const VectorXd u_plus = Stack(view, s.plus, false), u_minus = Stack(view, s.minus, false);
  VectorXd difference = (plus - minus) / (2.0 * s.dz);
  for (Eigen::Index i = 0; i < difference.size(); ++i) {
    if (u_plus[i] * u_minus[i] > 0.0) continue;
    const double right = (plus[i] - at[i]) / s.dz, left = (at[i] - minus[i]) / s.dz;
    difference[i] = std::clamp(mine[i], std::min(left, right), std::max(left, right));
  }
  return difference;
}

/// The change of variables y = y0 + W z that the check runs in, and what it makes of derivatives.
class Coordinates {
 public:
  Coordinates(int n, const Whitening* whitening)
      : whitening_(whitening), directions_(MatrixXd::Identity(n, n)) {
    if (!whitening) return;
    const MatrixXd unit = directions_;
    for (int j = 0; j < n; ++j) whitening->FromWhite(unit.col(j).data(), directions_.col(j).data());
  }
  auto direction(int j) const { return directions_.col(j); }
  VectorXd Gradient(VectorXd g) const {
    if (whitening_) whitening_->GradientToWhite(g.data());
    return g;
  }
  /// Every row of `rows` as a gradient.
  MatrixXd Rows(MatrixXd rows) const {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = Gradient(rows.row(i)).transpose();
    return rows;
  }

 private:
  const Whitening* whitening_;
  MatrixXd directions_;
};

}  // namespace

double DerivativeErrors::worst() const {
  if (!evaluated) return HUGE_VAL;
  return std::max({gradient, hessian, residual_jacobian, row_jacobian});
}

DerivativeErrors CheckDerivatives(const View& view, const VectorXd& y, const Lagrangian& lagrangian,
                                  double step, const Whitening* whitening) {
  constexpr Want kAll{.gradient = true, .hessian = true, .residual = true};
  DerivativeErrors errors;
  Sides s;
  for (ViewEvaluation* e : {&s.at, &s.plus, &s.minus}) view.Resize(e);
  if (!view.Evaluate(y.data(), kAll, lagrangian, &s.at)) return errors;

  const int n = view.num_variables();
  const Coordinates in(n, whitening);
  const MatrixXd u_jacobian = in.Rows(StackJacobian(view, s.at, false));
  const MatrixXd r_jacobian = in.Rows(StackJacobian(view, s.at, true));
  VectorXd gradient(n);
  MatrixXd hessian(n, n), u_difference(u_jacobian.rows(), n), r_difference(r_jacobian.rows(), n);
  const auto evaluate_sides = [&](const VectorXd& direction, double dz) {
    s.dz = dz;
    const VectorXd ahead = y + dz * direction, behind = y - dz * direction;
    return view.Evaluate(ahead.data(), kAll, lagrangian, &s.plus) &&
           view.Evaluate(behind.data(), kAll, lagrangian, &s.minus);
  };
  const auto slope_difference = [&]() -> VectorXd {
    return in.Gradient(LagrangianGradient(view, s.plus, lagrangian) -
                       LagrangianGradient(view, s.minus, lagrangian)) /
           (2.0 * s.dz);
  };
  for (int j = 0; j < n; ++j) {
    const VectorXd direction = in.direction(j);
    const double dz = step / direction.cwiseAbs().maxCoeff();
    // On the edge of a hinge the gradient grows like u^2 to one side, and the error of its central
    // difference with the step: extrapolated away by half a step.
    if (!evaluate_sides(direction, 0.5 * dz)) return errors;
    hessian.col(j) = 2.0 * slope_difference();
    if (!evaluate_sides(direction, dz)) return errors;
    hessian.col(j) -= slope_difference();
    gradient[j] = (s.plus.full.value - s.minus.full.value) / (2.0 * dz);
    u_difference.col(j) = (Stack(view, s.plus, false) - Stack(view, s.minus, false)) / (2.0 * dz);
    r_difference.col(j) = ResidualDifference(view, s, r_jacobian.col(j));
  }

  MatrixXd mine(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) mine(i, j) = s.at.hessian.At(i, j);
  }
  mine = in.Rows(in.Rows(mine).transpose());
  errors.evaluated = true;
  errors.gradient =
      RelativeError(in.Gradient(Eigen::Map<const VectorXd>(s.at.gradient.data(), n)), gradient);
  errors.hessian = RelativeError(mine, hessian);
  errors.residual_jacobian = RelativeError(r_jacobian, r_difference);
  errors.row_jacobian = RelativeError(u_jacobian, u_difference);
  return errors;
}

}  // namespace touchdown::solvers
