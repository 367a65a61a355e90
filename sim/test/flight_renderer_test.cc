// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/flight_renderer.h"

#include <cmath>
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

// A long line loses its end; a short line and the mark are drawn whole.
TEST(FlightRenderer, OfTooManyPiecesTheLastAreLeftOut) {
  FlightRenderer renderer({}, DefaultVehicleMjcf(), SmallView());
  FlightMoment moment = FromAbove();
  const std::array<float, 4> red = {1.0F, 0.0F, 0.0F, 1.0F};
  moment.lines = {{{{-3.0, -2.0, 0.5}, {-1.0, -2.0, 0.5}}, 0.4, red}, {{}, 0.4, red}};
  for (int i = 0; i < FlightRenderer::kMostPieces + 1000; ++i) {
    moment.lines[1].points_W.emplace_back(0.001 * i, -2.0, 0.5);
  }
  moment.marks = {{{0.0, 2.0, 0.5}, 0.4, {0.0F, 1.0F, 0.0F, 1.0F}}};
  std::vector<std::uint8_t> rgb;
  renderer.Render(moment, &rgb);
  // 5.5 m below the camera, 10.9 pixels a metre.
  const auto red_at = [&](double x) {
    const int u = 80 + static_cast<int>(10.9 * x);
    for (int v = 79; v < 85; ++v) {
      if (Pixel(rgb, u, v)[0] > 100 && Pixel(rgb, u, v)[1] < 30) return true;
    }
    return false;
  };
  EXPECT_TRUE(red_at(-2.0));
  EXPECT_TRUE(red_at(0.5));
  EXPECT_TRUE(red_at(3.5));
  EXPECT_FALSE(red_at(4.5));
  EXPECT_GT(Pixel(rgb, 80, 60 - 22)[1], 130);
}

// The default's text with `from` replaced by `to` wherever it stands.
std::string With(const std::string& from, const std::string& to) {
  std::string text = DefaultVehicleMjcf();
  EXPECT_NE(text.find(from), text.npos) << from;
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::size_t DiscsIn(const std::string& geoms, const std::string& radius) {
  const std::string disc = "type='cylinder' size='" + radius + " 0.004 0'";
  std::size_t discs = 0;
  for (std::size_t at = 0; (at = geoms.find(disc, at)) != geoms.npos; ++at) ++discs;
  return discs;
}

TEST(VehicleLooks, LeaveOutTheHull) {
  const VehicleLooks looks = LooksOf(DefaultVehicleMjcf());
  EXPECT_EQ(looks.assets, "");
  EXPECT_THAT(looks.geoms, ::testing::Not(HasSubstr("size='0.3 ")));
  EXPECT_THAT(looks.geoms, HasSubstr("type='box' size='0.08 0.08 0.03'"));
}

// As on the replay page: all have the least radius, or an assumed one.
TEST(VehicleLooks, DiscsHaveTheModelsRadius) {
  EXPECT_EQ(DiscsIn(LooksOf(DefaultVehicleMjcf()).geoms, "0.127"), 4U);
  const std::string without = With(" type=\"cylinder\" size=\"0.127 0.004\"", "");
  ASSERT_EQ(LoadVehicleModel(without).rotor_radius, 0.0);
  EXPECT_EQ(DiscsIn(LooksOf(without).geoms, "0.1"), 4U);
}

TEST(VehicleLooks, OfNoVehicleThereAreNone) {
  EXPECT_THAT(
      test::MessageOf<std::invalid_argument>([] { LooksOf("<mujoco><worldbody/></mujoco>"); }),
      HasSubstr("lacks the body"));
}

// A red plate of 1.2 m by 0.4 m as a mesh. The middle of its corners is off its geom's origin.
TEST(FlightRenderer, DrawsAMeshOfTheVehicle) {
  std::string mjcf = With(
      "<worldbody>",
      "<asset><mesh name='plate' vertex='0 0 0  1.2 0 0  0 0.4 0  1.2 0.4 0  0 0 0.1  1.2 0 0.1  "
      "0 0.4 0.1  1.2 0.4 0.1'/></asset><worldbody>");
  const std::size_t at = mjcf.find("<geom name=\"hull\"");
  ASSERT_NE(at, mjcf.npos);
  mjcf.insert(at,
              "<geom type='mesh' mesh='plate' pos='0.5 -0.2 0.2' rgba='1 0 0 1' mass='0' "
              "contype='0' conaffinity='0'/>");
  FlightRenderer renderer({}, mjcf, SmallView());
  FlightMoment moment = FromAbove();
  std::vector<std::uint8_t> rgb;
  renderer.Render(moment, &rgb);
  const auto red = [&](double x, double y) {
    // The plate's upper face is 3.7 m below the camera: 16.2 pixels a metre.
    const double per_metre = 60.0 / 3.7;
    const std::array<int, 3> pixel =
        Pixel(rgb, 80 + static_cast<int>(std::lround(per_metre * (-2.0 + x))),
              60 - static_cast<int>(std::lround(per_metre * y)));
    return pixel[0] > 90 && pixel[1] < 60 && pixel[2] < 60;
  };
  EXPECT_TRUE(red(0.7, 0.0));
  EXPECT_TRUE(red(1.5, 0.1));
  EXPECT_TRUE(red(1.5, -0.1));
  EXPECT_FALSE(red(1.5, 0.5));
  EXPECT_FALSE(red(1.9, 0.0));
}

}  // namespace
}  // namespace touchdown::sim
