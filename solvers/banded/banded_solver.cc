// SPDX-License-Identifier: BSD-3-Clause
// The backend `banded`: Newton's method or the interior point, whichever the problem needs.

#include "solvers/banded/banded_solver.h"

#include <algorithm>

#include "solvers/banded/banded_interior_point.h"
#include "solvers/banded/banded_newton.h"

namespace touchdown::solvers {

namespace {

/// Of the gap, where the point is to be confirmed: so that it is.
constexpr double kConfirmedShare = 1e-2;

/// In the result where a solve does not end as it should.
const char* Words(SolveStatus status, bool constrained) {
  switch (status) {
    case SolveStatus::kInfeasible:
      return "the rows contradict each other near the least violation that was found";
    case SolveStatus::kUnconfirmed:
      return "the steps stalled, at a point that may be the optimum";
    case SolveStatus::kNumericalFailure:
      return constrained ? "fast, elastic and careful steps stalled, all of them"
                         : "no step along a descent direction lowers the cost";
    default:
      return "";
  }
}

class BandedSolver : public SolverBackend {
 public:
  BandedSolver()
      : SolverBackend("banded",
                      SolverOptions({
                          {"gap_tolerance", 1e-7, 1e-15, 1.0, false,
                           "expected distance to the optimum that ends a solve, share of the cost"},
                          {"violation_tolerance", 1e-8, 1e-14, Evaluator::kFeasible, false,
                           "violation of a hard row at which a solve may end"},
                      })) {}

  Capabilities capabilities() const override {
    return {.hard_rows = true, .equality_rows = true, .variable_bounds = true};
  }

 private:
  bool measures_gap() const override { return true; }

  void DoPrepare(const View& view) override {
    if (view.constrained()) {
      interior_point_.Prepare(view);
    } else {
      newton_.Prepare(view);
    }
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& stop, Evaluator* evaluator,
               SolverResult* result) override {
    const ShareScope scope(evaluator, Share::kNative);
    const bool confirmed = stop.confirm && stop.gap == 0.0;
    const double own = (confirmed ? kConfirmedShare : 1.0) * options().Get("gap_tolerance");
    const double gap = std::max(own, stop.gap);
    if (!view.constrained()) {
      result->status = newton_.Run(view, warm.y.data(), {gap, own, confirmed}, evaluator);
      if (newton_.ended_near()) evaluator->EndNear();
      result->message = Words(result->status, false);
      return;
    }
    result->status =
        interior_point_.Run(view, warm.y.data(), warm.multipliers,
                            {gap, options().Get("violation_tolerance"), confirmed}, evaluator);
    result->message = Words(result->status, true);
    if (gap > own && result->status == SolveStatus::kConverged) evaluator->EndNear();
    result->multipliers.resize(static_cast<std::size_t>(view.problem().num_terms()));
    for (int i = 0; i < view.problem().num_terms(); ++i) {
      result->multipliers[i] = interior_point_.multipliers(i);
    }
    interior_point_.BoundMultipliers(&result->bound_multipliers);
  }

  BandedNewton newton_;
  BandedInteriorPoint interior_point_;
};

}  // namespace

std::unique_ptr<SolverBackend> MakeBandedSolver() { return std::make_unique<BandedSolver>(); }

}  // namespace touchdown::solvers
