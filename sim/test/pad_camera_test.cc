// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/pad_camera.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/sensors/frame_delivery.h"
#include "sim/test/scenes.h"
#include "touchdown/estimation/tags/pad_pose.h"
#include "touchdown/estimation/tags/tag_detector.h"

namespace touchdown::sim {
namespace {

estimation::PadState Pad() {
  estimation::PadState pad;
  pad.p_WP = {2.0, 1.0, 0.3};
  pad.yaw = 0.5;
  return pad;
}

estimation::VehicleState Above(double height) {
  estimation::VehicleState vehicle;
  vehicle.p_WB = {2.05, 0.9, 0.35 + height};
  vehicle.q_WB = Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.6, 0.8, 0.0));
  return vehicle;
}

PadCameraConfig Exact() {
  PadCameraConfig config;
  config.noise_sigma = 0.0;
  return config;
}

estimation::PadPose Solve(const PadCamera& camera, const estimation::GrayImage& image) {
  estimation::TagDetector detector;
  return estimation::SolvePadPose(detector.Detect(image.View()), camera.intrinsics());
}

TEST(PadCamera, SeesThePadWhereItIs) {
  PadCamera camera(Exact(), {}, 1);
  estimation::GrayImage image;
  for (const double height : {0.3, 1.0, 2.0, 3.0}) {
    const estimation::VehicleState vehicle = Above(height);
    camera.Capture(vehicle, Pad(), &image);
    const estimation::PadPose pose = Solve(camera, image);
    ASSERT_EQ(pose.status, estimation::PadPoseStatus::kSolved) << height;
    const estimation::PadSighting sighting =
        estimation::ToSighting(pose, 0.0, DownwardCameraAxes(), camera.config().p_BC);
    const Eigen::Vector3d p_WP = vehicle.p_WB + vehicle.q_WB * sighting.p_BP_B;
    EXPECT_LT((p_WP - Pad().p_WP).norm(), 0.002 * (1.0 + height * height)) << height;
  }
}

TEST(PadCamera, NoiseHasItsSpreadAndItsOwnStream) {
  PadCameraConfig config = Exact();
  PadCamera exact(config, {}, 7);
  config.noise_sigma = 4.0;
  PadCamera noisy(config, {}, 7);
  PadCamera again(config, {}, 7);
  estimation::GrayImage truth, image, same;
  estimation::PadState away = Pad();
  away.p_WP.x() = 60.0;  // the ground's greys are far from black and white
  exact.Capture(Above(2.0), away, &truth);
  noisy.Capture(Above(2.0), away, &image);
  again.Capture(Above(2.0), away, &same);
  EXPECT_EQ(image.pixels, same.pixels);
  double mean = 0.0;
  double square = 0.0;
  const double n = static_cast<double>(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double error = static_cast<double>(image.pixels[i]) - truth.pixels[i];
    mean += error / n;
    square += error * error / n;
  }
  EXPECT_NEAR(mean, 0.0, 0.1);
  EXPECT_NEAR(std::sqrt(square), 4.0, 0.1);
}

TEST(PadCamera, MotionBlursAboutTheTimeStamp) {
  PadCameraConfig config = Exact();
  PadCamera sharp(config, {}, 1);
  config.exposure_ms = 20.0;
  PadCamera blurred(config, {}, 1);
  estimation::VehicleState vehicle = Above(1.5);
  estimation::GrayImage still, moving;
  sharp.Capture(vehicle, Pad(), &still);
  blurred.Capture(vehicle, Pad(), &moving);
  EXPECT_EQ(still.pixels, moving.pixels);  // nothing moves: nothing is blurred

  vehicle.v_WB = {2.0, 0.0, 0.0};  // 3.2 pixels
  vehicle.w_WB_B = {0.0, 0.3, 0.2};
  blurred.Capture(vehicle, Pad(), &moving);
  EXPECT_NE(still.pixels, moving.pixels);
  const estimation::PadPose pose = Solve(blurred, moving);
  ASSERT_EQ(pose.status, estimation::PadPoseStatus::kSolved);
  // 4 cm are passed in the exposure; the pose is that of its middle.
  EXPECT_LT((pose.p_CP - Solve(sharp, still).p_CP).norm(), 0.006);
  // What moves along with the camera is sharp.
  estimation::PadState along = Pad();
  along.v_WP = {2.0, 0.0, 0.0};
  vehicle.w_WB_B.setZero();
  blurred.Capture(vehicle, along, &moving);
  EXPECT_EQ(still.pixels, moving.pixels);
}

TEST(PadCamera, RefusesBadConfigurations) {
  const auto message = [](auto change) {
    PadCameraConfig config;
    change(&config);
    return test::MessageOf<std::invalid_argument>([&] { PadCamera(config, {}, 1); });
  };
  EXPECT_THAT(message([](PadCameraConfig* c) { c->width = 7; }),
              ::testing::HasSubstr("pad_camera.width is 7; allowed is [8, 4096]"));
  EXPECT_THAT(message([](PadCameraConfig* c) { c->noise_sigma = std::nan(""); }),
              ::testing::HasSubstr("pad_camera.noise_sigma"));
  EXPECT_THAT(message([](PadCameraConfig* c) { c->exposure_ms = 101.0; }),
              ::testing::HasSubstr("pad_camera.exposure_ms is 101"));
  EXPECT_THAT(message([](PadCameraConfig* c) { c->max_subframes = 0; }),
              ::testing::HasSubstr("pad_camera.max_subframes is 0"));
}

TEST(FrameDelivery, HoldsFramesBackInOrder) {
  FrameDelivery<int> delivery({.latency_ms = 30.0}, 1, "camera frames");
  delivery.Hold(0.0, 1);
  delivery.Hold(0.02, 2);
  EXPECT_FALSE(delivery.Poll(0.028).has_value());
  EXPECT_EQ(delivery.Poll(0.030), 1);
  EXPECT_FALSE(delivery.Poll(0.030).has_value());
  delivery.Hold(0.04, 3);
  EXPECT_EQ(delivery.Poll(1.0), 2);
  EXPECT_EQ(delivery.Poll(1.0), 3);
  EXPECT_FALSE(delivery.Poll(1.0).has_value());
}

TEST(FrameDelivery, DropsItsShareAndTheSameOnesAgain) {
  FrameDelivery<int> one({.drop_probability = 0.3}, 4, "camera frames");
  FrameDelivery<int> twin({.drop_probability = 0.3}, 4, "camera frames");
  FrameDelivery<int> none({}, 4, "camera frames");
  FrameDelivery<int> all({.drop_probability = 1.0}, 4, "camera frames");
  int admitted = 0;
  for (int i = 0; i < 10000; ++i) {
    const bool admits = one.Admit(0.0);
    EXPECT_EQ(admits, twin.Admit(0.0));
    EXPECT_TRUE(none.Admit(0.0));
    EXPECT_FALSE(all.Admit(0.0));
    admitted += admits ? 1 : 0;
  }
  EXPECT_NEAR(admitted, 7000, 200);
  EXPECT_THROW(FrameDelivery<int>({.latency_ms = -1.0}, 1, "x"), std::invalid_argument);
  EXPECT_THROW(FrameDelivery<int>({.drop_probability = 1.5}, 1, "x"), std::invalid_argument);
}

TEST(FrameDelivery, AnOutageTakesNothingElse) {
  FrameDelivery<int> whole({.drop_probability = 0.3}, 4, "camera frames");
  FrameDelivery<int> out({.drop_probability = 0.3, .outage_begin_s = 2.0, .outage_end_s = 5.0}, 4,
                         "camera frames");
  int admitted = 0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    const bool admits = whole.Admit(t);
    EXPECT_EQ(out.Admit(t), admits && !(t >= 2.0 && t < 5.0)) << "at " << t;
    admitted += admits ? 1 : 0;
  }
  EXPECT_GT(admitted, 50);
}

}  // namespace
}  // namespace touchdown::sim
