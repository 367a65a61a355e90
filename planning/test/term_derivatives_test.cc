// SPDX-License-Identifier: BSD-3-Clause
// Every registered term, on every view and both arrival modes, against central differences. A new
// term is covered by being registered.

#include <gtest/gtest.h>

#include "touchdown/planning/boundary_lift.h"
#include "touchdown/planning/term_registry.h"
#include "touchdown/planning/test/planning_fixtures.h"
#include "touchdown/solvers/derivative_check.h"

namespace touchdown::planning {
namespace {

constexpr int kSegments = 9;
constexpr double kTolerance = 2e-5;

struct Case {
  solvers::TermFactory factory;
  bool reduced;
  bool free_interval;
};

void CheckAtRandomPoints(const Case& c, bool free_end_acceleration) {
  Draw draw(17);
  for (int trial = 0; trial < 8; ++trial) {
    solvers::ProblemShape shape;
    shape.blocks = kSegments + 3;
    shape.free_interval = c.free_interval;
    solvers::Problem problem(shape);
    problem.set_interval(draw.Uniform(0.2, 0.5));
    problem.AddTerm(c.factory.sample(shape.blocks, draw.engine()), solvers::Role::kCost);

    const ArcPad pad = draw.Pad();
    auto lift = std::make_shared<BoundaryLift>(kSegments, free_end_acceleration);
    lift->Set(draw.State(3.0, 2.0, 2.0), 1.5, pad, {1.5, 2.0, 0.1, 0.5});
    solvers::AffineLift structure = solvers::AffineLift::Identity(shape.blocks);
    if (c.reduced) {
      structure = lift->Structure();
      structure.offset = lift;
    }
    const solvers::View view(problem, structure);
    Eigen::VectorXd y(view.num_variables());
    for (int i = 0; i < y.size(); ++i) y[i] = draw.Uniform(-1.0, 1.0);
    if (c.free_interval) y[y.size() - 1] = problem.interval();

    const solvers::DerivativeErrors errors = solvers::CheckDerivatives(view, y);
    ASSERT_TRUE(errors.evaluated);
    EXPECT_LT(errors.gradient, kTolerance);
    EXPECT_LT(errors.residual_jacobian, kTolerance);
    EXPECT_LT(errors.row_jacobian, kTolerance);
    EXPECT_LT(errors.hessian, kTolerance);
  }
}

TEST(TermDerivatives, EveryTermOnEveryView) {
  for (const solvers::TermFactory& factory : StandardTerms()) {
    for (const bool reduced : {false, true}) {
      for (const bool free_interval : {false, true}) {
        SCOPED_TRACE(factory.info.name + (reduced ? " reduced" : " full") +
                     (free_interval ? " free" : " fixed"));
        CheckAtRandomPoints({factory, reduced, free_interval}, true);
      }
    }
  }
}

TEST(TermDerivatives, FixedEndAccelerationKeepsTheGradientExact) {
  // The pad's snap is not predicted, so only the first derivatives are exact here, and the Hessian
  // where the interval is fixed.
  for (const solvers::TermFactory& factory : StandardTerms()) {
    SCOPED_TRACE(factory.info.name);
    CheckAtRandomPoints({factory, true, false}, false);
  }
}

}  // namespace
}  // namespace touchdown::planning
