// SPDX-License-Identifier: BSD-3-Clause
// Options that studies switch off (end velocity, warm start), and answers that come late.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"

namespace touchdown::planning {
namespace {

const Eigen::Vector3d kStart(-4.0, 0.0, 1.5);

TEST(ReplannerVariants, AnEndAtRestStandsWhereThePadWillBe) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.8, 0.4, 0.1);
  for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
    ReplannerOptions options = Options(arrival);
    options.reaction =
        60.0;  // the plan itself is flown to its end, not the stop that comes with it
    Replanner replanner(options, solvers::StandardBackends());
    replanner.CommitHover(kStart, 0.0);
    ReplanInput input = Input(kStart, pad, 0.0);
    input.endpoint.at_rest = true;
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned);
    EXPECT_TRUE(result.certificate.passed());
    const double t_end = result.curve.t_end();
    const FlatState end = result.curve.Evaluate(t_end);
    EXPECT_LT((end.p_WB - pad.At(t_end).p_WP - Eigen::Vector3d(0, 0, 1.3)).norm(), 1e-9);
    EXPECT_LT(end.v_WB.norm(), 1e-9);
    EXPECT_LT((replanner.Reference(t_end + 1.0).p_WB - end.p_WB).norm(), 1e-9) << "it stays there";
  }
}

/// Notes how far its first guess is from the curve between the ends alone, and answers a little off it.
class NotingBackend : public solvers::SolverBackend {
 public:
  explicit NotingBackend(std::vector<double>* guesses)
      : SolverBackend("noting", {}), guesses_(guesses) {}
  solvers::Capabilities capabilities() const override { return {}; }

 private:
  void DoPrepare(const solvers::View& /*view*/) override {}
  void DoSolve(const solvers::View& /*view*/, const solvers::WarmStart& warm,
               const solvers::Stop& /*stop*/, solvers::Evaluator* evaluator,
               solvers::SolverResult* result) override {
    guesses_->push_back(warm.y.norm());
    const Eigen::VectorXd y = (warm.y.array() + 0.02).matrix();
    evaluator->Evaluate(y.data(), {});
    result->status = solvers::SolveStatus::kConverged;
  }
  std::vector<double>* guesses_;
};

TEST(ReplannerVariants, WithoutAWarmStartEverySolveBeginsBetweenTheEndsAlone) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  for (const bool warm : {true, false}) {
    std::vector<double> guesses;
    ReplannerOptions options = Options(ArrivalMode::kFixed);
    options.backend = "noting";
    options.warm_start = warm;
    Replanner replanner(
        options, {{"noting", "", [&] { return std::make_unique<NotingBackend>(&guesses); }}});
    replanner.CommitHover(kStart, 0.0);
    ASSERT_EQ(replanner.Replan(Input(kStart, pad, 0.0), map).status, ReplanStatus::kPlanned);
    const std::size_t first_step = guesses.size();
    EXPECT_EQ(guesses.front(), 0.0);
    const FlatState at = replanner.Reference(0.1);
    ReplanInput input = Input(at.p_WB, pad, 0.1);
    input.vehicle.v_WB = at.v_WB;
    replanner.Replan(input, map);
    ASSERT_GT(guesses.size(), first_step);
    EXPECT_EQ(guesses[first_step] > 0.0, warm);
  }
}

TEST(ReplannerVariants, ALateAnswerTakesOverLate) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.reaction = 2.0;  // its stop begins after all that is asked here
  Replanner replanner(options, solvers::StandardBackends());
  replanner.CommitHover(kStart, 0.0);
  ASSERT_EQ(replanner.Replan(Input(kStart, pad, 0.0), map).status, ReplanStatus::kPlanned);
  replanner.TakeOverAt(0.3);
  EXPECT_LT((replanner.Reference(0.29).p_WB - kStart).norm(), 1e-12) << "it hovers on";
  EXPECT_GT((replanner.Reference(0.31).p_WB - kStart).norm(), 1e-3);
  const Eigen::Vector3d promised = replanner.Reference(1.0).p_WB;
  EXPECT_EQ(replanner.Replan(Input(kStart, pad, 0.2), map).reason, ReplanReason::kInvalidInput);
  EXPECT_EQ(replanner.Reference(1.0).p_WB, promised);
  // Nothing was committed by that step: there is nothing to postpone.
  replanner.TakeOverAt(0.9);
  EXPECT_EQ(replanner.Reference(0.8).p_WB, replanner.state().next.curve.Evaluate(0.8).p_WB);
}

}  // namespace
}  // namespace touchdown::planning
