// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "planning/baselines/ego/bspline_fit.h"
#include "planning/baselines/ego/ego_grid.h"
#include "planning/baselines/ego/ego_options.h"
#include "solvers/lbfgs/lbfgs.h"

namespace touchdown::planning {

/// Largest ratio by which a component of a velocity control point exceeds the limit, or the root of
/// the acceleration's (Zhou et al., eq. 13). Feasible up to limit_tolerance beyond.
struct LimitExcess {
  bool feasible = true;
  double ratio = 1.0;  ///< as found, feasible or not
};
LimitExcess CheckLimits(const ControlPoints& q, double interval, const EgoOptions& options);

/// The curve with its inner knots stretched by `ratio`, sampled at the N - 2 knots of a uniform
/// spline of the same, longer duration. `ends` gives the derivatives that hold at both ends. Fills
/// points and interval of the result.
SampledPath StretchTime(const ControlPoints& q, double interval, double ratio,
                        const SampledPath& ends);

/// Anisotropic curve fitting (Zhou et al., section IV-B): L-BFGS on smoothness, fitness to the
/// stretched curve and feasibility, without obstacles. The first and last three control points never
/// move.
class Refinement : private solvers::LbfgsFunction {
 public:
  explicit Refinement(const EgoOptions& options) : options_(options) {}

  /// Slows *q down by `ratio`; *interval becomes the new one. kPlanned, kSolverFailed, or
  /// kRefinementHit where the first two thirds are blocked.
  EgoStatus Run(const EgoGrid& grid, double ratio, const SampledPath& ends, double* interval,
                ControlPoints* q);

  int iterations() const { return iterations_; }  ///< of the last Run

 private:
  double Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override;

  EgoOptions options_;
  solvers::Lbfgs lbfgs_;
  SampledPath reference_;
  ControlPoints q_, gradient_;
  Eigen::VectorXd x_;
  int iterations_ = 0;
};

}  // namespace touchdown::planning
