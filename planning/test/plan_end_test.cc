// SPDX-License-Identifier: BSD-3-Clause
#include "planning/replan/plan_end.h"

#include <gtest/gtest.h>

#include "planning/replan/spaces.h"
#include "planning/test/replanner_fixtures.h"

namespace touchdown::planning {
namespace {

const Eigen::Vector3d kPad(2.05, 0.05, 0.35);

/// A roof over the pad.
OccupancyMap Roofed(double height) {
  OccupancyMap map = ObservedMap();
  for (double x = 0.05; x < 4.0; x += 0.1) {
    for (double y = -2.0; y < 2.0; y += 0.1) map.SetOccupied({x, y, height});
  }
  return map;
}

TEST(LowerUnderRoof, IsTheGreatestFreeHeight) {
  const ReplannerOptions options = Options(ArrivalMode::kFixed);
  for (const double roof : {2.05, 2.45, 2.95, 5.05}) {
    const OccupancyMap map = Roofed(roof);
    const FreeSpace space = SpaceFor(options, map);
    const double height = LowerUnderRoof(space, kPad, 1.5);
    const auto at = [&](double h) -> Eigen::Vector3d { return kPad + h * Eigen::Vector3d::UnitZ(); };
    EXPECT_FALSE(space.Blocked(at(height))) << roof;
    EXPECT_LE(height, 1.5);
    EXPECT_TRUE(height == 1.5 || space.Blocked(at(height + 0.1))) << roof;
  }
  const OccupancyMap low = Roofed(1.25);
  EXPECT_EQ(LowerUnderRoof(SpaceFor(options, low), kPad, 1.5), 1.5) << "there is none";
}

class PlanEnds : public ::testing::Test {
 protected:
  void Set(const Eigen::Vector3d& start, const estimation::PadPrediction& pad,
           std::optional<Eigen::Vector3d> look = {}) {
    ReplanInput input = Input(start, pad, 0.0);
    input.look_from_W = look;
    end_.Set(input, {start, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}, options_.limits);
  }

  const ReplannerOptions options_ = Options(ArrivalMode::kFixed);
  PlanEnd end_{options_};
};

TEST_F(PlanEnds, ThePadOrThePlaceToLookFrom) {
  const ArcPad pad(kPad, 0.0, 0.0, 0.0);
  Set({-3.0, 0.0, 1.5}, pad);
  EXPECT_EQ(&end_.pad(), &pad);
  EXPECT_FALSE(end_.is_look());
  const Eigen::Vector3d look(1.0, 2.0, 3.0);
  Set({-3.0, 0.0, 1.5}, pad, look);
  EXPECT_TRUE(end_.is_look());
  EXPECT_EQ(EndStateAt(end_.pad(), end_.target(), 1.0).state.p, look);
  end_.Forget();
  EXPECT_FALSE(end_.is_look());
}

TEST_F(PlanEnds, TooFarForOnePlanItIsOnTheStraightWay) {
  const Eigen::Vector3d start(0.0, 0.0, 1.5), goal(900.0, 0.0, 1.5);
  Set(start, GoalAt(goal));
  EXPECT_TRUE(end_.is_on_the_way());
  const Eigen::Vector3d end = EndStateAt(end_.pad(), end_.target(), 1.0).state.p;
  EXPECT_GT(end.x(), 10.0);
  EXPECT_LT(end.x(), options_.max_duration * options_.limits.speed);
  EXPECT_NEAR(end.y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace touchdown::planning
