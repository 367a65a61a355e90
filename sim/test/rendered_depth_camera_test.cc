// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/rendered_depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

TEST(RenderedDepthCamera, AgreesWithTheAnalyticOne) {
  RandomStream random(23, "rendered depth scenes");
  DepthCameraConfig config;
  config.width = 160;
  config.height = 120;
  config.pitch_deg = 10.0;
  for (int trial = 0; trial < 4; ++trial) {
    VisualScene scene;
    scene.obstacles = test::RandomField(16, 5.0, &random);
    RenderedDepthCamera rendered(config, scene, 1);
    DepthCamera analytic(config, scene.obstacles, scene.pad, 1);
    std::vector<double> differences;
    long apart = 0;
    long all = 0;
    for (int view = 0; view < 4; ++view) {
      estimation::PadState pad;
      pad.p_WP = {random.Uniform(-3, 3), random.Uniform(-3, 3), scene.deck_height};
      pad.yaw = random.Uniform(-3, 3);
      estimation::VehicleState vehicle;
      vehicle.t = view;
      do {
        vehicle.p_WB = test::RandomPoint({-5, -5, 1.0}, {5, 5, 4}, &random);
      } while (scene.obstacles.SignedDistance(vehicle.p_WB) < 0.3);
      vehicle.q_WB = test::RandomAttitude(0.4, &random);
      estimation::DepthFrame exact, image;
      analytic.Capture(vehicle, pad, &exact);
      rendered.Capture(vehicle, pad, &image);
      EXPECT_EQ(image.t, exact.t);
      EXPECT_EQ(image.p_WC, exact.p_WC);
      EXPECT_EQ(image.R_WC, exact.R_WC);
      EXPECT_EQ(image.intrinsics.focal, exact.intrinsics.focal);
      EXPECT_EQ(image.max_range, exact.max_range);
      ASSERT_EQ(image.depth.size(), exact.depth.size());
      for (std::size_t i = 0; i < image.depth.size(); ++i) {
        ++all;
        const bool seen = std::isfinite(image.depth[i]);
        if (seen != static_cast<bool>(std::isfinite(exact.depth[i]))) {
          ++apart;
        } else if (seen) {
          differences.push_back(std::abs(image.depth[i] - exact.depth[i]));
          if (differences.back() > 0.2) ++apart;
        }
      }
    }
    ASSERT_GT(static_cast<long>(differences.size()), all / 5);
    std::nth_element(differences.begin(), differences.begin() + differences.size() / 2,
                     differences.end());
    EXPECT_LT(differences[differences.size() / 2], 1e-3) << trial;
    EXPECT_LT(static_cast<double>(apart), 0.01 * static_cast<double>(all)) << trial;
  }
}

TEST(RenderedDepthCamera, NoiseHasItsSpreadAndRangeItsLimit) {
  DepthCameraConfig config;
  config.pitch_deg = 90.0;
  config.range_noise = 0.02;
  config.max_range = 3.0;
  RenderedDepthCamera camera(config, {}, 5);
  estimation::VehicleState vehicle;
  vehicle.p_WB = {0.0, 0.0, 2.5};
  estimation::PadState pad;
  pad.p_WP = {50.0, 0.0, 0.3};
  estimation::DepthFrame frame;
  camera.Capture(vehicle, pad, &frame);
  double square = 0.0;
  int seen = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double u = (static_cast<double>(i % 80) + 0.5 - 40.0) / 40.0;
    const double v = (static_cast<double>(i / 80) + 0.5 - 30.0) / 40.0;
    const bool expected = 2.5 * std::sqrt(1.0 + u * u + v * v) < 3.0;
    ASSERT_EQ(static_cast<bool>(std::isfinite(frame.depth[i])), expected) << i;
    if (!expected) continue;
    ++seen;
    square += std::pow(frame.depth[i] / 2.5 - 1.0, 2);
  }
  EXPECT_GT(seen, 1000);
  EXPECT_NEAR(std::sqrt(square / seen), 0.02, 0.0015);
}

}  // namespace
}  // namespace touchdown::sim
