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
      if (!lagrangian.rows[i].multiplier) continue;
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

}  // namespace

double DerivativeErrors::worst() const {
  if (!evaluated) return HUGE_VAL;
  return std::max({gradient, hessian, residual_jacobian, row_jacobian});
}

DerivativeErrors CheckDerivatives(const View& view, const VectorXd& y, const Lagrangian& lagrangian,
                                  double step) {
  DerivativeErrors errors;
  ViewEvaluation at, plus, minus;
  for (ViewEvaluation* e : {&at, &plus, &minus}) view.Resize(e);
  if (!view.Evaluate(y.data(), {.gradient = true, .hessian = true, .residual = true}, lagrangian,
                     &at))
    return errors;

  const int n = view.num_variables();
  const MatrixXd u_jacobian = StackJacobian(view, at, false);
  const MatrixXd r_jacobian = StackJacobian(view, at, true);
  VectorXd gradient(n);
  MatrixXd hessian(n, n), u_difference(u_jacobian.rows(), n), r_difference(r_jacobian.rows(), n);
  for (int j = 0; j < n; ++j) {
    const double dy = step * std::max(1.0, std::abs(y[j]));
    VectorXd moved = y;
    moved[j] = y[j] + dy;
    if (!view.Evaluate(moved.data(), {.gradient = true, .hessian = true, .residual = true},
                       lagrangian, &plus)) {
      return errors;
    }
    moved[j] = y[j] - dy;
    if (!view.Evaluate(moved.data(), {.gradient = true, .hessian = true, .residual = true},
                       lagrangian, &minus)) {
      return errors;
    }
    gradient[j] = (plus.full.value - minus.full.value) / (2.0 * dy);
    const VectorXd plus_slope = LagrangianGradient(view, plus, lagrangian);
    const VectorXd minus_slope = LagrangianGradient(view, minus, lagrangian);
    for (int i = 0; i < n; ++i) {
      hessian(i, j) = (plus_slope[i] - minus_slope[i]) / (2.0 * dy);
    }
    u_difference.col(j) = (Stack(view, plus, false) - Stack(view, minus, false)) / (2.0 * dy);
    r_difference.col(j) = (Stack(view, plus, true) - Stack(view, minus, true)) / (2.0 * dy);
  }

  MatrixXd mine(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) mine(i, j) = at.hessian.At(i, j);
  }
  errors.evaluated = true;
  errors.gradient = RelativeError(Eigen::Map<const VectorXd>(at.gradient.data(), n), gradient);
  errors.hessian = RelativeError(mine, hessian);
  errors.residual_jacobian = RelativeError(r_jacobian, r_difference);
  errors.row_jacobian = RelativeError(u_jacobian, u_difference);
  return errors;
}

}  // namespace touchdown::solvers
