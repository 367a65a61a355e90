// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lbfgs/more_thuente.h"

namespace touchdown::solvers {

/// The defaults are those of EGO-Planner (Zhou et al., RA-L 2021), except the tolerance.
struct LbfgsOptions {
  double gradient_tolerance = 1e-5;  ///< converged at |g| <= this max(1, |x|)
  int max_iterations = 200;          ///< 0: no limit
  MoreThuenteOptions line_search;
};

enum class LbfgsStatus {
  kConverged,         ///< the gradient is below its tolerance
  kAlreadyMinimized,  ///< it was so at the start
  kIterationLimit,
  kCancelled,         ///< LbfgsFunction::Cancelled said so
  kLineSearchFailed,  ///< see line_search
  kEvaluationFailed,  ///< the start cannot be evaluated
};
const char* ToString(LbfgsStatus status);

struct LbfgsResult {
  LbfgsStatus status = LbfgsStatus::kConverged;
  LineSearchState line_search = LineSearchState::kConverged;  ///< of the last line search
  double value = 0.0;                                         ///< f(x)
  int iterations = 0;                                         ///< accepted steps
  int evaluations = 0;
};

/// What is minimised.
class LbfgsFunction {
 public:
  virtual ~LbfgsFunction() = default;
  /// f(x) and its gradient, both of the prepared size; not finite where it cannot be evaluated.
  virtual double Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) = 0;
  /// Asked before each evaluation: true ends the run at once.
  virtual bool Cancelled() { return false; }
  /// Told of every accepted step.
  virtual void Accepted(double /*value*/, const Eigen::VectorXd& /*gradient*/) {}
};

/// Limited-memory BFGS. Source: J. Nocedal and S. Wright, "Numerical Optimization", 2nd ed., alg.
/// 7.4 (two-loop recursion, eq. 7.20 for its scale) and 7.5; line search: more_thuente.h. The first
/// step has length 1. Deterministic. An exception of the function passes through.
class Lbfgs {
 public:
  /// Allocates for n variables and `memory` remembered steps; throws std::invalid_argument unless
  /// both are positive. The only call that allocates.
  void Prepare(int n, int memory = 16);

  /// Minimises from *x, which receives the last accepted point: also after a failed or cancelled
  /// line search. Throws std::invalid_argument if x does not have the prepared size.
  LbfgsResult Minimize(const LbfgsOptions& options, LbfgsFunction* function, Eigen::VectorXd* x);

 private:
  LineSearchState Search(const LbfgsOptions& options, double first_step, LbfgsFunction* function,
                         Eigen::VectorXd* x, LbfgsResult* result);
  void Remember(const Eigen::VectorXd& x);
  void SetDirection();

  int memory_ = 0;
  int stored_ = 0;               // pairs in use
  int newest_ = 0;               // column of the last
  Eigen::MatrixXd s_, y_;        // steps and changes of the gradient, a column each
  Eigen::VectorXd rho_, alpha_;  // 1 / y's; of the recursion
  Eigen::VectorXd x_before_, g_, g_before_, direction_;
};

}  // namespace touchdown::solvers
