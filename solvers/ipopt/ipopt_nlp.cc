// SPDX-License-Identifier: BSD-3-Clause
// The callbacks that Ipopt makes. It asks for objective, gradient, rows and Jacobian one by one,
// and the evaluator answers for the repeated point from its cache. The first question at a point
// also computes the gradients, since almost every trial point is accepted. A whitened row is dense
// from its first column on (forward substitution), an unwhitened one holds its window.

#include "solvers/ipopt/ipopt_nlp.h"

#include <algorithm>
#include <cmath>

namespace touchdown::solvers {

namespace {

constexpr double kUnbounded = 2e19;  // beyond Ipopt's nlp_upper_bound_inf
constexpr double kNarrow =
    1e-9;  // half the width of an equality that is given as a row of two sides

double Bound(double bound) { return std::clamp(bound, -kUnbounded, kUnbounded); }

/// Calls visit(row, column, value) for every stored element of the lower triangle.
template <class Visit>
void ForEachLower(const BorderedBandMatrix& H, Visit&& visit) {
  const int d = H.block_size();
  for (int i = 0; i < H.blocks(); ++i) {
    const int last = std::min(H.half_bandwidth(), H.blocks() - 1 - i);
    for (int k = 0; k <= last; ++k) {
      const double* block = H.block(i, k);
      for (int r = 0; r < d; ++r) {
        for (int c = k == 0 ? r : 0; c < d; ++c) {
          visit((i + k) * d + c, i * d + r, block[r * d + c]);
        }
      }
    }
  }
  if (!H.bordered()) return;
  const int n = H.blocks() * d;
  for (int j = 0; j < n; ++j) visit(n, j, H.border()[j]);
  visit(n, n, H.corner());
}

}  // namespace

void IpoptNlp::Prepare(const View& view) {
  point_.Prepare(view);
  rows_.Prepare(view);
  ConstraintRows::Size(view, &multipliers_);
  row_weights_.assign(multipliers_.size(), {});
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    if (!multipliers_[i].empty()) row_weights_[i].multiplier = multipliers_[i].data();
  }
  dense_row_.assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  bound_multipliers_ = dense_row_;
}

bool IpoptNlp::Begin(const View& view, const WarmStart& warm, Evaluator* evaluator) {
  view_ = &view;
  evaluator_ = evaluator;
  ending_ = false;
  report_ = {};
  if (!point_.Begin(view, warm.y.data(), {.whiten = !exact_hessian_}, evaluator)) return false;
  rows_.Set(view, point_.last());
  lambda_.assign(static_cast<std::size_t>(rows_.size()), 0.0);
  jacobian_.assign(static_cast<std::size_t>(rows_.nonzeros()), 0.0);
  warm_multipliers_ = rows_.size() > 0 && rows_.Gather(warm.multipliers, lambda_.data());
  return true;
}

int IpoptNlp::JacobianNonzeros() const {
  if (!point_.whitened()) return rows_.nonzeros();
  int sum = 0;
  for (int r = 0; r < rows_.size(); ++r) sum += point_.size() - rows_.column(rows_.start(r));
  return sum;
}

bool IpoptNlp::get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                            IndexStyleEnum& index_style) {
  n = point_.size();
  m = rows_.size();
  nnz_jac_g = JacobianNonzeros();
  nnz_h_lag = 0;
  if (exact_hessian_) ForEachLower(point_.last().hessian, [&](int, int, double) { ++nnz_h_lag; });
  index_style = C_STYLE;
  return true;
}

bool IpoptNlp::get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                               Number* g_u) {
  for (int i = 0; i < n; ++i) {
    const double scale = view_->free_interval() && i == n - 1 ? point_.interval_scale() : 1.0;
    x_l[i] = Bound(scale * view_->lower(i));
    x_u[i] = Bound(scale * view_->upper(i));
  }
  int equalities = 0;
  for (int r = 0; r < m; ++r) equalities += rows_.lo(r) == rows_.hi(r);
  // Ipopt refuses more equalities than free variables, even if they are consistent. Of as many it
  // believes that they leave no choice, and ends at any point that meets them. As narrow rows it
  // solves both.
  const double room = equalities >= view_->num_free_variables() ? kNarrow : 0.0;
  for (int r = 0; r < m; ++r) {
    const bool equality = rows_.lo(r) == rows_.hi(r);
    g_l[r] = Bound(rows_.lo(r)) - (equality ? room : 0.0);
    g_u[r] = Bound(rows_.hi(r)) + (equality ? room : 0.0);
  }
  return true;
}

bool IpoptNlp::get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_L,
                                  Number* z_U, Index m, bool init_lambda, Number* lambda) {
  if (init_x) std::copy(point_.z(), point_.z() + n, x);
  if (init_z) {
    std::fill(z_L, z_L + n, 0.0);
    std::fill(z_U, z_U + n, 0.0);
  }
  if (init_lambda) std::copy(lambda_.data(), lambda_.data() + m, lambda);
  return true;
}

bool IpoptNlp::MoveTo(const Number* x) {
  if (evaluator_->must_stop() && !ending_) throw Ended{};
  return point_.Evaluate(x, true);
}

bool IpoptNlp::eval_f(Index /*n*/, const Number* x, bool /*new_x*/, Number& value) {
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (!MoveTo(x)) return false;
  value = point_.value();
  return true;
}

bool IpoptNlp::eval_grad_f(Index /*n*/, const Number* x, bool /*new_x*/, Number* gradient) {
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (!MoveTo(x)) return false;
  point_.Gradient(gradient);
  return true;
}

bool IpoptNlp::eval_g(Index /*n*/, const Number* x, bool /*new_x*/, Index /*m*/, Number* g) {
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (!MoveTo(x)) return false;
  rows_.Values(point_.last(), g);
  return true;
}

bool IpoptNlp::eval_jac_g(Index n, const Number* x, bool /*new_x*/, Index m, Index /*nonzeros*/,
                          Index* row, Index* column, Number* values) {
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (!values) {
    for (int r = 0; r < m; ++r) {
      const int first = rows_.start(r), end = rows_.start(r + 1);
      const int count = point_.whitened() ? n - rows_.column(first) : end - first;
      for (int k = 0; k < count; ++k) {
        *row++ = r;
        *column++ = point_.whitened() ? rows_.column(first) + k : rows_.column(first + k);
      }
    }
    return true;
  }
  if (!MoveTo(x)) return false;
  if (!point_.whitened()) {
    rows_.Jacobian(point_.last(), values);
    return true;
  }
  rows_.Jacobian(point_.last(), jacobian_.data());
  for (int r = 0; r < m; ++r) {
    std::fill(dense_row_.begin(), dense_row_.end(), 0.0);
    for (int k = rows_.start(r); k < rows_.start(r + 1); ++k) {
      dense_row_[rows_.column(k)] = jacobian_[k];
    }
    point_.RowToWhite(dense_row_.data());
    values = std::copy(dense_row_.begin() + rows_.column(rows_.start(r)), dense_row_.end(), values);
  }
  return true;
}

bool IpoptNlp::eval_h(Index /*n*/, const Number* x, bool /*new_x*/, Number objective_factor,
                      Index /*m*/, const Number* lambda, bool /*new_lambda*/, Index /*nonzeros*/,
                      Index* row, Index* column, Number* values) {
  if (!exact_hessian_) return false;
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (!values) {
    ForEachLower(point_.last().hessian, [&](int i, int j, double) {
      *row++ = i;
      *column++ = j;
    });
    return true;
  }
  if (evaluator_->must_stop() && !ending_) throw Ended{};
  if (rows_.size() > 0) rows_.Spread(lambda, &multipliers_);
  const Lagrangian lagrangian{.objective_factor = objective_factor, .rows = row_weights_.data()};
  if (!point_.EvaluateLagrangian(x, lagrangian)) return false;
  bool finite = true;
  ForEachLower(evaluator_->last().hessian, [&](int, int, double value) {
    finite = finite && std::isfinite(value);
    *values++ = value;
  });
  return finite;
}

bool IpoptNlp::intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number /*value*/,
                                     Number primal_infeasibility, Number dual_infeasibility,
                                     Number /*mu*/, Number step_norm, Number /*regularization*/,
                                     Number /*alpha_dual*/, Number /*alpha_primal*/,
                                     Index /*trials*/, const Ipopt::IpoptData* /*data*/,
                                     Ipopt::IpoptCalculatedQuantities* /*quantities*/) {
  const ShareScope scope(evaluator_, Share::kAdapter);
  if (mode == Ipopt::RegularMode) {  // the restoration phase solves another problem
    report_.told = true;
    report_.primal_infeasibility = primal_infeasibility;
    report_.dual_infeasibility = dual_infeasibility;
  }
  if (iteration > 0) evaluator_->FinishIteration(step_norm, dual_infeasibility);
  ending_ = evaluator_->CheckStop();
  return !ending_;
}

void IpoptNlp::finalize_solution(Ipopt::SolverReturn status, Index n, const Number* x,
                                 const Number* z_L, const Number* z_U, Index /*m*/,
                                 const Number* /*g*/, const Number* lambda, Number /*value*/,
                                 const Ipopt::IpoptData* /*data*/,
                                 Ipopt::IpoptCalculatedQuantities* /*quantities*/) {
  rows_.Spread(lambda, &multipliers_);
  report_.has_multipliers = true;
  for (int i = 0; i < n; ++i) bound_multipliers_[i] = z_U[i] - z_L[i];
  if (view_->free_interval()) bound_multipliers_[n - 1] *= point_.interval_scale();
  // An earlier point may have cost less only because it violated its rows.
  const bool solved = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
  if (solved && !evaluator_->must_stop() && point_.Evaluate(x, false)) {
    evaluator_->PreferLastIfFeasible();
  }
}

}  // namespace touchdown::solvers
