// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/tag_sensor.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

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

TEST(TagSensor, WhichTagsAreInViewByHeight) {
  const TagSensor sensor({}, {}, 1);
  EXPECT_NEAR(sensor.intrinsics().focal, 120.0, 1e-9);
  // Outer tags reach to 0.56 m: with 45 deg up and down they are whole from that height on.
  EXPECT_EQ(Count(sensor.Visible(Above(0.57), Pad())), 5);
  EXPECT_EQ(Count(sensor.Visible(Above(0.55), Pad())), 1);
  EXPECT_TRUE(sensor.Visible(Above(0.55), Pad())[0]);
  EXPECT_TRUE(sensor.Visible(Above(0.08), Pad())[0]);
  EXPECT_EQ(Count(sensor.Visible(Above(0.07), Pad())), 0);  // the centre tag is cut
}

// Share of images in which a tag is found.
double ShareFound(std::size_t id, double height) {
  TagSensor sensor({}, {}, 2);
  int found = 0;
  for (int i = 0; i < 1000; ++i)
    found += sensor.Look(Above(height), Pad(), Above(height).q_WB).found[id] ? 1 : 0;
  return found / 1000.0;
}

TEST(TagSensor, SmallTagsAreFoundLessOften) {
  const TagModel model;
  // A tag of 0.4 m is model.half_size pixels long at 120 * 0.4 / half_size.
  EXPECT_NEAR(ShareFound(1, 48.0 / model.half_size), 0.5, 0.05);
  EXPECT_GT(ShareFound(1, 48.0 / (model.half_size + 3.0 * model.spread)), 0.99);
  EXPECT_LT(ShareFound(1, 48.0 / (model.half_size - 3.0 * model.spread)), 0.01);
  EXPECT_NEAR(ShareFound(0, 18.0 / model.half_size), 0.5, 0.05);
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

  // A plate in between hides everything under it.
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
    EXPECT_LT((vehicle.p_WB + vehicle.q_WB * sighting->p_BP_B - pad.p_WP).norm(), 1e-6);
    const Eigen::Vector3d x_P =
        vehicle.q_WB.conjugate() * Eigen::Vector3d(std::cos(pad.yaw), std::sin(pad.yaw), 0.0);
    EXPECT_NEAR(sighting->yaw_BP, std::atan2(x_P.y(), x_P.x()), 1e-6);
  }
}

// Errors of many sightings from one place over their claimed errors, and their mean size.
struct Errors {
  double position = 0.0;  ///< mean square over the variances
  double yaw = 0.0;
  double mean_norm = 0.0;  ///< [m]
};

Errors Measure(const VehicleState& vehicle, const PadState& pad) {
  TagSensor sensor({}, {}, 3);
  Errors errors;
  int n = 0;
  const Eigen::Vector3d truth = vehicle.q_WB.conjugate() * (pad.p_WP - vehicle.p_WB);
  for (int i = 0; i < 3000; ++i) {
    const auto sighting = sensor.Poll(0.05 * i, vehicle, pad);
    if (!sighting.has_value()) continue;
    ++n;
    const Eigen::Vector3d error = sighting->p_BP_B - truth;
    errors.mean_norm += error.norm();
    errors.position += (error.array() / sighting->sigma_p.array()).square().mean();
    errors.yaw += std::pow(sighting->yaw_BP / sighting->sigma_yaw, 2);
  }
  errors.mean_norm /= n;
  errors.position /= n;
  errors.yaw /= n;
  return errors;
}

TEST(TagSensor, NoiseIsWhatItSays) {
  double before = 0.0;
  for (const double height : {0.6, 2.0, 3.0, 5.0}) {
    const Errors errors = Measure(Above(height), Pad());
    // The attitude is exact here, but one degree of error is claimed. So the claims are never too
    // small.
    EXPECT_LT(errors.position, 1.1) << height;
    EXPECT_GT(errors.position, 0.5) << height;
    EXPECT_NEAR(errors.yaw, 1.0, 0.15) << height;
    EXPECT_LT(errors.mean_norm, 0.02) << height;
    if (height > 2.0) {
      EXPECT_GT(errors.mean_norm, before) << height;
    }
    before = errors.mean_norm;
  }
  // One tag alone, of a pad that is cut by the image's edge, is much worse than the whole pad.
  EXPECT_GT(Measure(Above(0.45), Pad()).mean_norm, 2.0 * Measure(Above(0.6), Pad()).mean_norm);
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
