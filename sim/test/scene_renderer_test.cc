// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/scene_renderer.h"

#include <cmath>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimation/tags/pad_sheet.h"
#include "sim/sensors/pad_camera.h"
#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

VisualScene SmallScene() {
  VisualScene scene;
  scene.obstacles = ObstacleField(
      {Box{{2.0, 0.0, 0.5}, {0.5, 0.5, 0.5}, 0.3}, Cylinder{{-2.0, 1.0, 0.5}, 0.4, 1.0}});
  return scene;
}

CameraPose Above(double x, double y, double z) {
  return {{x, y, z}, DownwardCameraAxes()};  // the image's right is x_W, its up y_W
}

estimation::PadState Pad(double x = 0.0, double y = 0.0, double yaw = 0.0) {
  estimation::PadState pad;
  pad.p_WP = {x, y, 0.3};
  pad.yaw = yaw;
  return pad;
}

int Level(const std::vector<std::uint8_t>& rgb, int u, int v) {
  return rgb[static_cast<std::size_t>(3 * (v * 320 + u))];
}

TEST(PadSheet, CellsFallOnTexels) {
  const estimation::GrayImage sheet = estimation::PadSheet();
  ASSERT_EQ(sheet.width, 1024);
  int black = 0;
  for (const std::uint8_t level : sheet.pixels) {
    ASSERT_TRUE(level == 0 || level == 255);
    if (level == 0) ++black;
  }
  // The corner of an outer tag's black border is at 0.56 m, of the centre tag's at 0.075 m.
  const auto at = [&](double x, double y) {
    const int column = static_cast<int>(std::floor((x + 0.64) / 0.00125));
    const int row = static_cast<int>(std::floor((0.64 - y) / 0.00125));
    return sheet.pixels[static_cast<std::size_t>(row * 1024 + column)];
  };
  EXPECT_EQ(at(0.5595, 0.5595), 0);
  EXPECT_EQ(at(0.5605, 0.5595), 255);
  EXPECT_EQ(at(-0.0745, 0.0), 0);
  EXPECT_EQ(at(-0.0755, 0.0), 255);
  EXPECT_GT(black, 1024 * 1024 / 5);
}

TEST(SceneRenderer, SameInputSameBitsInAnyContextAndThread) {
  SceneRenderer one(SmallScene(), {});
  std::vector<std::uint8_t> first, again, elsewhere;
  std::vector<float> depth;
  one.RenderColor(Above(0.2, 0.1, 2.0), Pad(0.0, 0.0, 0.4), &first);
  one.RenderDepth(Above(1.0, 0.0, 3.0), Pad(1.0, 0.0, 0.4), &depth);
  one.RenderColor(Above(0.2, 0.1, 2.0), Pad(0.0, 0.0, 0.4), &again);
  EXPECT_EQ(first, again);
  std::thread([&elsewhere] {
    SceneRenderer two(SmallScene(), {});
    two.RenderColor(Above(0.2, 0.1, 2.0), Pad(0.0, 0.0, 0.4), &elsewhere);
  }).join();
  EXPECT_EQ(first, elsewhere);
  SceneRenderer beside(SmallScene(), {});  // two contexts of one thread, by turns
  beside.RenderColor(Above(0.2, 0.1, 2.0), Pad(0.0, 0.0, 0.4), &elsewhere);
  one.RenderColor(Above(0.2, 0.1, 2.0), Pad(0.0, 0.0, 0.4), &again);
  EXPECT_EQ(first, elsewhere);
  EXPECT_EQ(first, again);
}

TEST(SceneRenderer, ImageAxesAndIntrinsics) {
  SceneRenderer renderer({}, {});
  EXPECT_NEAR(renderer.intrinsics().focal, 120.0, 1e-9);
  std::vector<std::uint8_t> rgb;
  // From 1.2 m above the deck a pixel is 1 cm; of the ground beyond the deck it is a bit more.
  renderer.RenderColor(Above(0.0, 0.0, 1.5), Pad(), &rgb);
  EXPECT_GT(Level(rgb, 160 - 62, 120), 200);      // the sheet's white edge
  EXPECT_LT(Level(rgb, 160 + 18, 120 - 40), 60);  // the black border of the tag at +x, +y
  EXPECT_LT(Level(rgb, 160 + 54, 120 - 54), 60);
  // Moved along x, the pad comes to lie to the right; along y, up.
  renderer.RenderColor(Above(0.0, 0.0, 1.5), Pad(0.5, 0.3), &rgb);
  EXPECT_LT(Level(rgb, 160 + 50 + 18, 120 - 30 - 40), 60);
  EXPECT_LT(Level(rgb, 160 + 50 - 54, 120 - 30 - 54), 60);
}

TEST(SceneRenderer, DepthOfWhatIsThere) {
  SceneRenderer renderer(SmallScene(), {});
  std::vector<float> depth;
  renderer.RenderDepth(Above(0.0, 0.0, 3.0), Pad(), &depth);
  ASSERT_EQ(depth.size(), 320U * 240U);
  EXPECT_NEAR(depth[120 * 320 + 160], 2.7, 2e-4);                // the deck
  EXPECT_NEAR(depth[120 * 320 + 160 + 120 * 2 / 2], 2.0, 2e-4);  // the box, 1 m high at x = 2
  EXPECT_NEAR(depth[10 * 320 + 160], 3.0, 2e-4);                 // the ground
  renderer.RenderDepth({{0.0, 0.0, 3.0}, Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal()}, Pad(),
                       &depth);  // up
  EXPECT_EQ(depth[120 * 320 + 160], std::numeric_limits<float>::infinity());
}

TEST(SceneRenderer, RefusesBadInput) {
  const auto message = [](auto change) {
    VisualScene scene;
    ViewConfig view;
    change(&scene, &view);
    return test::MessageOf<std::invalid_argument>([&] { SceneRenderer(scene, view); });
  };
  EXPECT_THAT(message([](VisualScene* s, ViewConfig*) { s->pad.deck_half_size = 0.5; }),
              ::testing::HasSubstr("rendered pad is 0.5; allowed is [0.64, 5]"));
  EXPECT_THAT(message([](VisualScene*, ViewConfig* v) { v->width = 0; }),
              ::testing::HasSubstr("view.width is 0"));
  EXPECT_THAT(message([](VisualScene*, ViewConfig* v) { v->far = 0.01; }),
              ::testing::HasSubstr("view.far"));
  EXPECT_THAT(message([](VisualScene* s, ViewConfig*) { s->obstacles = ObstacleField({Ring{}}); }),
              ::testing::HasSubstr("a rendered scene"));
}

}  // namespace
}  // namespace touchdown::sim
