// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/sim/tag_sensor.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "touchdown/sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using estimation::PadState;
using estimation::VehicleState;

PadState Pad(double yaw = 0.0) {
  PadState pad;
  pad.p_WP = {2.0, 1.0, 0.3};
  pad.yaw = yaw;
  return pad;
}

// Level, its camera `height` above the deck, over a point of the pad.
VehicleState Above(double height, double dx = 0.0, double dy = 0.0) {
  VehicleState vehicle;
  vehicle.p_WB = {2.0 + dx, 1.0 + dy, 0.3 + height + 0.05};
  return vehicle;
}

int Count(const std::array<bool, 5>& visible) {
  return std::accumulate(visible.begin(), visible.end(), 0);
}

TEST(TagSensor, WhichTagsAreSeenByHeight) {
  const TagSensor sensor({}, {}, 1);
  EXPECT_NEAR(sensor.intrinsics().focal, 240.0, 1e-9);
  // Outer tags reach to 0.56 m: with 45 deg up and down they are whole from that height on.
  EXPECT_EQ(Count(sensor.Visible(Above(0.57), Pad())), 5);
  EXPECT_EQ(Count(sensor.Visible(Above(0.55), Pad())), 1);
  EXPECT_TRUE(sensor.Visible(Above(0.55), Pad())[0]);
  EXPECT_TRUE(sensor.Visible(Above(0.08), Pad())[0]);
  EXPECT_EQ(Count(sensor.Visible(Above(0.07), Pad())), 0);  // the centre tag is cut
  const double scale = 240.0 / 207.8;
  EXPECT_TRUE(sensor.Visible(Above(2.99 * scale), Pad())[0]);
  EXPECT_FALSE(sensor.Visible(Above(3.01 * scale), Pad())[0]);
  EXPECT_EQ(Count(sensor.Visible(Above(5.9 * scale), Pad())), 4);
  EXPECT_EQ(Count(sensor.Visible(Above(6.1 * scale), Pad())), 0);
}

TEST(TagSensor, ImageAxesAreTheVehiclesAxes) {
  const TagSensor sensor({}, {}, 1);
  // From 0.5 m the image holds 0.5 m up and down and 0.667 m to each side. Moved 0.1 m back in y,
  // the two tags in front would need 0.66 m; the width is enough for both sides.
  const std::array<bool, 5> behind = sensor.Visible(Above(0.5, 0.0, -0.1), Pad());
  EXPECT_EQ(behind, (std::array<bool, 5>{true, false, false, true, true}));
  const std::array<bool, 5> left = sensor.Visible(Above(0.6, -0.3, 0.0), Pad());
  EXPECT_EQ(left, (std::array<bool, 5>{true, false, true, true, false}));
  // Turned by 90 deg, up is to the left.
  VehicleState turned = Above(0.5, 0.1, 0.0);
  turned.q_WB = Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ());
  const std::array<bool, 5> right = sensor.Visible(turned, Pad());
  EXPECT_EQ(right, (std::array<bool, 5>{true, true, false, false, true}));
}

TEST(TagSensor, TiltAngleAndObstaclesHideThePad) {
  const TagSensor sensor({}, {}, 1);
  VehicleState tilted = Above(0.6);
  tilted.q_WB = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX());
  EXPECT_LT(Count(sensor.Visible(tilted, Pad())), 5);
  tilted.q_WB = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  EXPECT_EQ(Count(sensor.Visible(tilted, Pad())), 0);  // looks at the sky

  // Tilted towards a pad at the side: in the image, but seen at a grazing angle.
  VehicleState side = Above(0.4, -2.0, 0.0);
  side.q_WB = Eigen::AngleAxisd(-1.3, Eigen::Vector3d::UnitY());
  EXPECT_EQ(Count(sensor.Visible(side, Pad())), 0);
  TagSensorConfig any_angle;
  any_angle.max_view_angle_deg = 89.0;
  EXPECT_GT(Count(TagSensor(any_angle, {}, 1).Visible(side, Pad())), 0);

  // A plate between hides what is under it.
  const ObstacleField plate({Box{{2.0, 1.36, 1.0}, {1.0, 0.2, 0.05}, 0.0}});
  const std::array<bool, 5> visible = TagSensor({}, plate, 1).Visible(Above(2.0), Pad());
  EXPECT_EQ(visible, (std::array<bool, 5>{true, false, false, true, true}));
}

TEST(TagSensor, PoseIsInTheBodyFrame) {
  TagSensorConfig config;
  config.noise_scale = 0.0;
  TagSensor sensor(config, {}, 1);
  RandomStream random(2, "tag poses");
  for (int i = 0; i < 50; ++i) {
    VehicleState vehicle = Above(random.Uniform(1.0, 2.0));
    vehicle.q_WB = test::RandomAttitude(0.3, &random);
    const PadState pad = Pad(random.Uniform(-3.0, 3.0));
    const auto sighting = sensor.Poll(0.05 * i, vehicle, pad);
    ASSERT_TRUE(sighting.has_value());
    EXPECT_LT((vehicle.p_WB + vehicle.q_WB * sighting->p_BP_B - pad.p_WP).norm(), 1e-12);
    const Eigen::Vector3d x_P =
        vehicle.q_WB.conjugate() * Eigen::Vector3d(std::cos(pad.yaw), std::sin(pad.yaw), 0.0);
    EXPECT_NEAR(sighting->yaw_BP, std::atan2(x_P.y(), x_P.x()), 1e-12);
  }
}

// Mean position error of many sightings from one place [m], and the reported sigma.
struct Errors {
  double mean_norm = 0.0;
  double sigma = 0.0;
  double yaw_spread = 0.0;
  double sigma_yaw = 0.0;
};

Errors Measure(const VehicleState& vehicle, const PadState& pad) {
  TagSensor sensor({}, {}, 3);
  Errors errors;
  const int n = 4000;
  const Eigen::Vector3d truth = vehicle.q_WB.conjugate() * (pad.p_WP - vehicle.p_WB);
  for (int i = 0; i < n; ++i) {
    const auto sighting = sensor.Poll(0.05 * i, vehicle, pad);
    if (!sighting.has_value()) return {};
    errors.mean_norm += (sighting->p_BP_B - truth).norm() / n;
    errors.yaw_spread += sighting->yaw_BP * sighting->yaw_BP / n;
    errors.sigma = sighting->sigma_p.x();
    errors.sigma_yaw = sighting->sigma_yaw;
  }
  errors.yaw_spread = std::sqrt(errors.yaw_spread);
  return errors;
}

TEST(TagSensor, NoiseIsWhatItSaysAndFollowsTheTable) {
  const double scale = 240.0 / 207.8;
  // Heights and mean bundle errors of the table (320x240), doubled for images with noise.
  struct Row {
    double height, low_mm, high_mm;
  };
  for (const Row& row :
       {Row{0.6, 0.5, 3.0}, Row{2.0, 1.0, 5.0}, Row{4.0, 4.0, 12.0}, Row{5.9, 8.0, 20.0}}) {
    const Errors errors = Measure(Above(row.height * scale), Pad());
    EXPECT_GT(errors.mean_norm, row.low_mm * 1e-3) << row.height;
    EXPECT_LT(errors.mean_norm, row.high_mm * 1e-3) << row.height;
    EXPECT_NEAR(errors.mean_norm, 1.596 * errors.sigma, 0.05 * errors.mean_norm);
    EXPECT_NEAR(errors.yaw_spread, errors.sigma_yaw, 0.05 * errors.sigma_yaw);
  }
  // One far outer tag alone is much worse than the bundle from the same distance.
  VehicleState far = Above(3.0, -4.0, -3.0);
  const TagSensor sensor({}, {}, 1);
  ASSERT_EQ(Count(sensor.Visible(far, Pad())), 1);
  const double distance = (far.p_WB - Pad().p_WP).norm();
  EXPECT_GT(Measure(far, Pad()).mean_norm, 5.0 * Measure(Above(distance), Pad()).mean_norm);
}

TEST(TagSensor, KeepsItsRateAndItsDraws) {
  TagSensor sensor({}, {}, 4);
  TagSensor twin({}, {}, 4);
  int images = 0;
  for (int step = 0; step < 1000; ++step) {
    const auto sighting = sensor.Poll(0.002 * step, Above(1.0), Pad());
    const auto other = twin.Poll(0.002 * step, Above(1.0), Pad());
    ASSERT_EQ(sighting.has_value(), other.has_value());
    if (!sighting.has_value()) continue;
    EXPECT_EQ(sighting->p_BP_B, other->p_BP_B);
    ++images;
  }
  EXPECT_EQ(images, 40);
  EXPECT_FALSE(sensor.Poll(3.0, Above(30.0), Pad()).has_value());
}

TEST(TagSensor, RefusesBadConfigurations) {
  TagSensorConfig config;
  config.noise_scale = -1.0;
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] { TagSensor(config, {}, 1); }),
              ::testing::HasSubstr("tag_camera.noise_scale is -1; allowed is [0, 100]"));
  config = {};
  config.fov_y_deg = std::nan("");
  EXPECT_THROW(TagSensor(config, {}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
