// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/flight_renderer.h"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/rendering/vehicle_looks.h"
#include "sim/sensors/pad_camera.h"
#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;

ViewConfig SmallView() {
  ViewConfig view;
  view.width = 160;
  view.height = 120;
  view.far = 100.0;
  return view;
}

// Everything from 6 m above the pad: half a picture's height is 6 m at the ground.
FlightMoment FromAbove() {
  FlightMoment moment;
  moment.camera = {{0.0, 0.0, 6.0}, DownwardCameraAxes()};
  moment.pad.p_WP = {2.0, 0.0, 0.3};
  moment.vehicle.p_WB = {-2.0, 0.0, 2.0};
  return moment;
}

std::array<int, 3> Pixel(const std::vector<std::uint8_t>& rgb, int u, int v) {
  const auto at = rgb.begin() + 3 * (160 * v + u);
  return {at[0], at[1], at[2]};
}

int Brightness(const std::vector<std::uint8_t>& rgb, int u, int v) {
  const std::array<int, 3> pixel = Pixel(rgb, u, v);
  return pixel[0] + pixel[1] + pixel[2];
}

TEST(FlightRenderer, DrawsTheVehicleWhereItIsAndItsShadow) {
  FlightRenderer renderer({}, DefaultVehicleMjcf(), SmallView());
  FlightMoment moment = FromAbove();
  std::vector<std::uint8_t> here, away, again;
  renderer.Render(moment, &here);
  moment.vehicle.p_WB.y() = 40.0;
  renderer.Render(moment, &away);
  // The body is blue, 4 m below the camera, 15 pixels a metre.
  const std::array<int, 3> body = Pixel(here, 80 - 30, 60);
  EXPECT_GT(body[2], body[0] + 20);
  const std::array<int, 3> ground = Pixel(away, 80 - 30, 60);
  EXPECT_LT(ground[2], ground[0] + 12);
  // The shadow falls along the sun's rays, 2 m down to the ground, which is 6 m below: 10 pixels a metre.
  const int u = 80 + static_cast<int>(10.0 * (-2.0 + 0.42 * 2.0));
  const int v = 60 - static_cast<int>(10.0 * 0.30 * 2.0);
  EXPECT_LT(Brightness(here, u, v), Brightness(away, u, v) - 60);
  moment = FromAbove();
  renderer.Render(moment, &again);
  EXPECT_EQ(again, here);
}

TEST(FlightRenderer, DrawsLinesAndMarksInTheirColors) {
  FlightRenderer renderer({}, DefaultVehicleMjcf(), SmallView());
  FlightMoment moment = FromAbove();
  moment.lines = {{{{-1.0, 2.0, 0.5}, {1.0, 2.0, 0.5}}, 0.4, {1.0F, 0.0F, 0.0F, 1.0F}},
                  {{}, 0.4, {1.0F, 1.0F, 1.0F, 1.0F}}};
  moment.marks = {{{0.0, -2.0, 0.5}, 0.4, {0.0F, 1.0F, 0.0F, 1.0F}}};
  std::vector<std::uint8_t> rgb;
  renderer.Render(moment, &rgb);
  const std::array<int, 3> line = Pixel(rgb, 80, 60 - 22), mark = Pixel(rgb, 80, 60 + 22);
  EXPECT_GT(line[0], 130);
  EXPECT_LT(line[1], 20);
  EXPECT_GT(mark[1], 130);
  EXPECT_LT(mark[0], 20);
}

TEST(FlightRenderer, ThePrintedSheetIsNotInItsOwnShadow) {
  FlightRenderer renderer({}, DefaultVehicleMjcf(), SmallView());
  FlightMoment moment = FromAbove();
  moment.camera.p_WC = {2.0, 0.0, 2.3};  // 30 pixels a metre; white between the tags
  std::vector<std::uint8_t> rgb;
  renderer.Render(moment, &rgb);
  for (int v = 45; v < 75; ++v) EXPECT_GT(Brightness(rgb, 83, v), 600) << v;
}

TEST(FlightRenderer, HasRoomForSoManyPiecesAndNoMore) {
  FlightRenderer renderer({}, DefaultVehicleMjcf(), SmallView());
  FlightMoment moment = FromAbove();
  moment.lines.resize(1);
  for (int i = 0; i < FlightRenderer::kMostPieces + 100; ++i) {
    moment.lines[0].points_W.emplace_back(0.001 * i, -2.0, 0.5);
  }
  std::vector<std::uint8_t> rgb;
  EXPECT_NO_THROW(renderer.Render(moment, &rgb));
}

TEST(VehicleLooks, LeavesOutTheHull) {
  const std::string looks = VehicleLooks(DefaultVehicleMjcf());
  EXPECT_THAT(looks, ::testing::Not(HasSubstr("size='0.3 ")));
  EXPECT_THAT(looks, HasSubstr("type='box' size='0.08 0.08 0.03 '"));
  std::size_t discs = 0;
  for (std::size_t at = 0; (at = looks.find("type='cylinder' size='0.127", at)) != looks.npos;
       ++at) {
    ++discs;
  }
  EXPECT_EQ(discs, 4U);
}

TEST(VehicleLooks, OfAVehicleWithoutGeomsForTheEyeThereAreArms) {
  const std::string looks = VehicleLooks(
      "<mujoco><worldbody><body name='vehicle'><freejoint/><inertial pos='0 0 0' mass='1' "
      "diaginertia='1 1 1'/><geom name='hull' type='cylinder' size='0.3 0.1' group='3'/>"
      "<geom name='foot0' type='sphere' size='0.01' pos='0 0.1 -0.1'/>"
      "<site name='rotor0' pos='0.2 0 0'/><site name='rotor1' pos='-0.2 0 0'/>"
      "</body></worldbody></mujoco>");
  EXPECT_THAT(looks, HasSubstr("type='capsule' size='0.012 0.1 0 ' pos='0.1 0 0 '"));
  EXPECT_THAT(looks, HasSubstr("pos='0 0.05 -0.05 '"));
  EXPECT_THAT(looks, HasSubstr("type='cylinder' size='0.192 "));
  EXPECT_THAT(
      test::MessageOf<std::invalid_argument>([] { VehicleLooks("<mujoco><worldbody/></mujoco>"); }),
      HasSubstr("lacks the body"));
}

}  // namespace
}  // namespace touchdown::sim
