// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of a view against central differences, column by column. The Hessian is compared with
// differences of the (checked) gradient. Their error is about the square root of a second
// difference's.

#include "touchdown/solvers/backend/derivative_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace touchdown::solvers {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The resolution of a difference: the value's relative error over the step, times this. It is a few
// such errors, divided by the relative error that callers ask for.
constexpr double kRounding = 1e6;
// Share of a term's nominal curvature below which differences across a hinge's edge say nothing.
constexpr double kReach = 1e-3;

/// The largest of its terms.
double SlopeError(const Problem& problem) {
  double error = std::numeric_limits<double>::epsilon();
  for (int i = 0; i < problem.num_terms(); ++i) {
    error = std::max(error, problem.term(i).shape().slope_error);
  }
  return error;
}

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
    for (int j = 0; j < block.rows(); ++j) {
      const int first = block.first_block[block.window_of(j)];
      const double* du = block.slopes(j);
      VectorXd row = VectorXd::Zero(view.num_variables());
      std::vector<int> reduced(static_cast<std::size_t>(shape.window));
      const int count = view.WindowBlocks(first, shape.window, reduced.data());
      VectorXd by_block(count * d);
      view.WindowJacobian(du, first, shape.window, 1.0, by_block.data());
      for (int b = 0; b < count; ++b) row.segment(reduced[b] * d, d) = by_block.segment(b * d, d);
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

/// Errors are measured against the arrays' own size, and where this is smaller against `floor`.
double RelativeError(const MatrixXd& mine, const MatrixXd& difference, double floor) {
  if (mine.size() == 0) return 0.0;
  if (!mine.allFinite() || !difference.allFinite() || !std::isfinite(floor)) return HUGE_VAL;
  const double error = (mine - difference).cwiseAbs().maxCoeff();
  if (error == 0.0) return 0.0;
  return error / std::max({mine.cwiseAbs().maxCoeff(), difference.cwiseAbs().maxCoeff(), floor});
}

double Largest(const MatrixXd& m) { return m.size() == 0 ? 0.0 : m.cwiseAbs().maxCoeff(); }

/// Sizes of the numbers that cancel in what is compared. The sum of |du| |x| is taken over a window
/// for the largest u and residual, over all windows for the rest.
struct Magnitudes {
  double u = 0.0, r = 0.0, value = 0.0, slope = 0.0;
};

Magnitudes MagnitudesOf(const View& view, const ViewEvaluation& e, const Lagrangian& lagrangian) {
  Magnitudes m;
  m.value = std::abs(e.full.value);
  const int d = view.block_size();
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    const TermBlock& block = e.full.terms[i];
    const TermShape& shape = view.problem().term(i).shape();
    const bool cost = view.problem().role(i) == Role::kCost;
    const double* multiplier = lagrangian.rows ? lagrangian.rows[i].multiplier : nullptr;
    for (int j = 0; j < block.rows(); ++j) {
      const double* x = &e.x[static_cast<std::size_t>(block.first_block[block.window_of(j)] * d)];
      double u = std::abs(block.u[j]) + std::abs(block.du_dh[j] * e.h), steepest = 0.0;
      for (int k = 0; k < shape.variables(); ++k) {
        const double du = std::abs(block.slopes(j)[k]);
        u += du * std::abs(x[k]);
        steepest = std::max(steepest, du);
      }
      m.u = std::max(m.u, u);
      if (!cost) {
        if (multiplier) m.slope += std::abs(multiplier[j]) * steepest;
        continue;
      }
      m.r = std::max(m.r, std::abs(block.r[j]) + std::abs(block.dr[j]) * u);
      m.value += std::abs(block.drho[j]) * u;
      m.slope += (std::abs(block.drho[j]) + std::abs(block.d2rho[j]) * u) * steepest;
    }
  }
  return m;
}

/// The Hessian as backends read it, the block diagonal whole.
MatrixXd Dense(const BorderedBandMatrix& hessian) {
  const int n = hessian.size(), d = hessian.block_size();
  MatrixXd dense(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) dense(i, j) = hessian.At(i, j);
  }
  for (int b = 0; b < hessian.blocks(); ++b) {
    for (int i = 0; i < d * d; ++i) dense(b * d + i / d, b * d + i % d) = hessian.block(b, 0)[i];
  }
  return dense;
}

/// Evaluations on both sides of the point along one variable.
struct Sides {
  ViewEvaluation at, plus, minus;
  double dz = 0.0;
};

/// Differences of all residuals. A hinge's residual grows like u^1.5. Where its u changes sign
/// between the sides, a central difference is wrong. But r is convex in u there, so the derivative
/// lies between the two one-sided differences. The nearer of these is returned, or `mine` itself if
/// it lies between them.
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

/// The change of variables y = y0 + W z that the check uses, and the derivatives in z.
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

/// The nearest point with room for a step to both sides of every variable.
VectorXd MoveInside(const View& view, VectorXd y, double step) {
  view.MoveIntoBounds(y.data());
  for (int i = 0; i < view.num_variables(); ++i) {
    const double room = std::min(step, 0.5 * (view.upper(i) - view.lower(i)));
    y[i] = std::clamp(y[i], view.lower(i) + room, view.upper(i) - room);
  }
  return y;
}

/// Of a move along a direction, to both sides: no variable moves by more than `step`, nor beyond
/// its bounds.
double LongestMove(const View& view, const VectorXd& y, const VectorXd& direction, double step) {
  double longest = step / direction.cwiseAbs().maxCoeff();
  for (int i = 0; i < view.num_variables(); ++i) {
    if (direction[i] == 0.0) continue;
    const double room = std::min(y[i] - view.lower(i), view.upper(i) - y[i]);
    if (room < step) longest = std::min(longest, room / std::abs(direction[i]));
  }
  return longest;
}

}  // namespace

double DerivativeErrors::worst() const {
  if (!evaluated) return HUGE_VAL;
  double worst = 0.0;
  for (const double error : {gradient, hessian, residual_jacobian, row_jacobian}) {
    worst = std::isnan(error) ? HUGE_VAL : std::max(worst, error);
  }
  return worst;
}

DerivativeErrors CheckDerivatives(const View& view, const VectorXd& point,
                                  const Lagrangian& lagrangian, double step,
                                  const Whitening* whitening) {
  const VectorXd y = MoveInside(view, point, step);
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
  double longest = 0.0, shortest = HUGE_VAL;
  std::vector<int> fixed;
  for (int j = 0; j < n; ++j) {
    const VectorXd direction = in.direction(j);
    const double dz = LongestMove(view, y, direction, step);
    if (dz == 0.0) {  // a fixed variable: nothing to compare
      fixed.push_back(j);
      continue;
    }
    longest = std::max(longest, dz);
    shortest = std::min(shortest, dz);
    // On the edge of a hinge the gradient grows like u^2 to one side. The error of its central
    // difference is linear in the step. A half step extrapolates it away.
    if (!evaluate_sides(direction, 0.5 * dz)) return errors;
    hessian.col(j) = 2.0 * slope_difference();
    if (!evaluate_sides(direction, dz)) return errors;
    hessian.col(j) -= slope_difference();
    gradient[j] = (s.plus.full.value - s.minus.full.value) / (2.0 * dz);
    u_difference.col(j) = (Stack(view, s.plus, false) - Stack(view, s.minus, false)) / (2.0 * dz);
    r_difference.col(j) = ResidualDifference(view, s, r_jacobian.col(j));
  }

  if (static_cast<int>(fixed.size()) == n) {
    errors.evaluated = true;
    return errors;
  }
  const Magnitudes sizes = MagnitudesOf(view, s.at, lagrangian);
  const MatrixXd mine = in.Rows(in.Rows(Dense(s.at.hessian)).transpose()).transpose();
  const VectorXd slope = in.Gradient(Eigen::Map<const VectorXd>(s.at.gradient.data(), n));
  for (const int j : fixed) {
    gradient[j] = slope[j];
    hessian.col(j) = mine.col(j);
    u_difference.col(j) = u_jacobian.col(j);
    r_difference.col(j) = r_jacobian.col(j);
  }
  // The curvature of the terms where they act. Near the edge of a hinge all curvature is smaller,
  // but the differences reach beyond the edge.
  Lagrangian nominal = lagrangian;
  nominal.nominal_curvature = true;
  if (!view.Evaluate(y.data(), kAll, nominal, &s.plus)) return errors;
  const double bend = Largest(in.Rows(in.Rows(Dense(s.plus.hessian)).transpose()));
  const double rounding = kRounding * std::numeric_limits<double>::epsilon() / shortest;
  const double slope_rounding = kRounding * SlopeError(view.problem()) / shortest;
  errors.evaluated = true;
  errors.gradient =
      RelativeError(slope, gradient, std::max(rounding * sizes.value, bend * longest));
  errors.hessian =
      RelativeError(mine, hessian, std::max(slope_rounding * sizes.slope, kReach * bend));
  errors.residual_jacobian = RelativeError(r_jacobian, r_difference, rounding * sizes.r);
  errors.row_jacobian = RelativeError(u_jacobian, u_difference, rounding * sizes.u);
  return errors;
}

}  // namespace touchdown::solvers
