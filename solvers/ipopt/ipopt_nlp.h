// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <IpTNLP.hpp>

#include <vector>

#include "solvers/backend/whitened_point.h"
#include "touchdown/solvers/backend/constraint_rows.h"

namespace touchdown::solvers {

/// A view as Ipopt sees it: either in its own variables with the exact Hessian, or whitened without
/// one. Included by ipopt_*.cc only.
class IpoptNlp : public Ipopt::TNLP {
 public:
  /// Thrown through Ipopt where a budget ends in the middle of an iteration: Ipopt itself only asks
  /// after one.
  struct Ended {};

  /// Ipopt's own report at its end or, if it was stopped, after its last iteration.
  struct Report {
    bool told = false;  ///< it has made an iteration
    double primal_infeasibility = 0.0;
    double dual_infeasibility = 0.0;
    bool has_multipliers = false;
  };

  explicit IpoptNlp(bool exact_hessian) : exact_hessian_(exact_hessian) {}

  /// Allocates for views of this structure.
  void Prepare(const View& view);
  /// Starts a solve; false if a term cannot be evaluated at the start. All arguments outlive it.
  bool Begin(const View& view, const WarmStart& warm, Evaluator* evaluator);

  /// Multipliers of the warm start fit the rows.
  bool has_warm_multipliers() const { return warm_multipliers_; }
  const ConstraintRows& rows() const { return rows_; }
  const Report& report() const { return report_; }
  /// [term][row].
  const std::vector<std::vector<double>>& multipliers() const { return multipliers_; }
  /// [variable].
  const std::vector<double>& bound_multipliers() const { return bound_multipliers_; }

 private:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override;
  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                       Number* g_u) override;
  bool get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_L, Number* z_U,
                          Index m, bool init_lambda, Number* lambda) override;
  bool eval_f(Index n, const Number* x, bool new_x, Number& value) override;
  bool eval_grad_f(Index n, const Number* x, bool new_x, Number* gradient) override;
  bool eval_g(Index n, const Number* x, bool new_x, Index m, Number* g) override;
  bool eval_jac_g(Index n, const Number* x, bool new_x, Index m, Index nonzeros, Index* row,
                  Index* column, Number* values) override;
  bool eval_h(Index n, const Number* x, bool new_x, Number objective_factor, Index m,
              const Number* lambda, bool new_lambda, Index nonzeros, Index* row, Index* column,
              Number* values) override;
  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number value,
                             Number primal_infeasibility, Number dual_infeasibility, Number mu,
                             Number step_norm, Number regularization, Number alpha_dual,
                             Number alpha_primal, Index trials, const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override;
  void finalize_solution(Ipopt::SolverReturn status, Index n, const Number* x, const Number* z_L,
                         const Number* z_U, Index m, const Number* g, const Number* lambda,
                         Number value, const Ipopt::IpoptData* data,
                         Ipopt::IpoptCalculatedQuantities* quantities) override;

  /// Moves to x, with gradients.
  bool MoveTo(const Number* x);
  int JacobianNonzeros() const;

  bool exact_hessian_;
  WhitenedPoint point_;
  ConstraintRows rows_;
  const View* view_ = nullptr;
  Evaluator* evaluator_ = nullptr;
  bool warm_multipliers_ = false;
  bool ending_ = false;  // Ipopt is on its way out: let it evaluate what it wants
  Report report_;
  std::vector<double> lambda_, jacobian_, dense_row_, bound_multipliers_;
  std::vector<std::vector<double>> multipliers_;
  std::vector<RowWeights> row_weights_;
};

}  // namespace touchdown::solvers
