// SPDX-License-Identifier: BSD-3-Clause
#include "control/onboard/pad_search.h"

#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "control/test/toy_world.h"
#include "estimation/test/pad_image.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/control/onboard/onboard.h"

namespace touchdown::control {
namespace {

TEST(PadSearch, WhereThePadMayShow) {
  estimation::CameraIntrinsics camera{320, 240, 120.0, 160.0, 120.0};
  EXPECT_TRUE(MayShowPad({0, 0, 2}, 0.1, camera));
  EXPECT_TRUE(MayShowPad({0, 0, -0.05}, 0.1, camera));
  EXPECT_FALSE(MayShowPad({0, 0, -0.2}, 0.1, camera));
  EXPECT_FALSE(MayShowPad({0, 0, 14}, 1.0, camera));
  EXPECT_TRUE(MayShowPad({0, 2.1, 2}, 0.1, camera));   // 45 deg: 0.07 m beyond the border
  EXPECT_FALSE(MayShowPad({0, 2.2, 2}, 0.1, camera));  // 0.14 m beyond it
  EXPECT_FALSE(MayShowPad({-5, 0, 2}, 1.0, camera));
  EXPECT_TRUE(MayShowPad({-5, 0, 2}, 3.0, camera));
}

/// From 2 m above a pad that stands 0.3 m aside, by a camera that looks straight down.
estimation::PadImage Below(double t) {
  estimation::PadImage image;
  image.t = t;
  image.intrinsics = estimation::TestCamera();
  image.R_BC = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  image.gray =
      estimation::DrawPad(estimation::PadAhead(2.0, 0.0, 0.0, 0.4, {0.15, 0.0}), image.intrinsics);
  return image;
}

TEST(PadSearch, AnImageIsAMeasurement) {
  const OnboardOptions options = LandingOptions(ToyQuadrotor(), ToyWorld::kDeck);
  Onboard onboard(options, LandingParts(options));
  EXPECT_EQ(onboard.Take(Below(0.0)), Taken::kUnasked);
  estimation::VehicleState vehicle;
  vehicle.p_WB = {1.0, 2.0, ToyWorld::kDeck + 2.0};
  for (; vehicle.t < 0.3; vehicle.t += 0.01) onboard.Take(vehicle);
  EXPECT_EQ(onboard.Take(Below(0.1)), Taken::kUsed);
  EXPECT_LT((onboard.pad().Estimate(0.1).p_WP.head<2>() - Eigen::Vector2d(1.3, 2.0)).norm(), 0.01);
  EXPECT_EQ(onboard.Take(Below(0.1)), Taken::kDoubled);
  EXPECT_EQ(onboard.Take(Below(0.5)), Taken::kInvalid);

  estimation::PadImage image = Below(0.2);
  image.gray.pixels.assign(image.gray.pixels.size(), 128);
  EXPECT_EQ(onboard.Take(image), Taken::kEmpty);
}

TEST(PadSearch, AnImageThatCannotBeIsRefused) {
  const OnboardOptions options = LandingOptions(ToyQuadrotor(), ToyWorld::kDeck);
  Onboard onboard(options, LandingParts(options));
  onboard.Take(estimation::VehicleState{});
  const auto refused = [&](const std::function<void(estimation::PadImage*)>& spoil) {
    estimation::PadImage image = Below(0.0);
    spoil(&image);
    return onboard.Take(image) == Taken::kInvalid;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](auto* image) { image->gray.pixels.pop_back(); }));
  EXPECT_TRUE(refused([](auto* image) { image->gray.width += 1; }));
  EXPECT_TRUE(refused([](auto* image) { image->intrinsics.focal = 0.0; }));
  EXPECT_TRUE(refused([](auto* image) { image->R_BC *= 2.0; }));
  EXPECT_TRUE(refused([=](auto* image) { image->p_BC.z() = nan; }));
  EXPECT_TRUE(refused([=](auto* image) { image->t = nan; }));
  EXPECT_FALSE(refused([](auto*) {}));
}

}  // namespace
}  // namespace touchdown::control
