// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/depth_camera.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/world/world_mjcf.h"

namespace touchdown::sim {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

float Pixel(const estimation::DepthFrame& frame, int row, int column) {
  return frame.depth[static_cast<std::size_t>(row * frame.intrinsics.width + column)];
}

estimation::PadState PadAt(double x, double y, double yaw) {
  estimation::PadState pad;
  pad.p_WP = {x, y, 0.3};
  pad.yaw = yaw;
  return pad;
}

/// A world's text with its obstacles as geoms, which it has none of, for mj_ray.
std::string WithObstacles(const WorldConfig& config) {
  std::string xml = WorldMjcf(config), assets, geoms;
  const std::vector<Obstacle>& obstacles = config.obstacles.obstacles();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string name = "obstacle " + std::to_string(i);
    if (const auto* mesh = std::get_if<Mesh>(&obstacles[i])) {
      assets += MeshAssetText(mesh->surface->corners(), mesh->surface->triangles(), name);
    }
    geoms += "<geom " + GeomText(obstacles[i], name, "mj_ray") + "/>\n";
  }
  const std::string end = "</worldbody>";
  xml.insert(xml.find(end), geoms);
  xml.insert(xml.find("<worldbody>"), "<asset>" + assets + "</asset>\n");
  return xml;
}

// The compiled scene with the pad where the camera is told it is.
class MujocoScene {
 public:
  MujocoScene(const WorldConfig& config, const estimation::PadState& pad)
      : model_(CompileMjcf(WithObstacles(config), DefaultVehicleMjcf())),
        data_(MakeMujocoData(*model_)),
        vehicle_(mj_name2id(model_.get(), mjOBJ_BODY, "vehicle")) {
    Joint("pad_x") = pad.p_WP.x();
    Joint("pad_y") = pad.p_WP.y();
    Joint("pad_yaw") = pad.yaw;
    mj_forward(model_.get(), data_.get());
  }

  double Ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    int geom = -1;
    const double s = mj_ray(model_.get(), data_.get(), origin.data(), direction.data(), nullptr, 1,
                            vehicle_, &geom);
    return s < 0.0 ? std::numeric_limits<double>::infinity() : s;
  }

 private:
  double& Joint(const char* name) {
    return data_->qpos[model_->jnt_qposadr[mj_name2id(model_.get(), mjOBJ_JOINT, name)]];
  }

  MujocoModel model_;
  MujocoData data_;
  int vehicle_;
};

TEST(DepthCamera, AgreesWithMujocoOnRandomScenes) {
  RandomStream random(17, "depth scenes");
  DepthCameraConfig camera_config;
  camera_config.pitch_deg = 10.0;
  long compared = 0;
  long seen = 0;
  long different = 0;
  for (int scene = 0; scene < 12; ++scene) {
    WorldConfig config = test::OpenSky();
    config.obstacles = test::RandomField(14, 5.0, &random);
    const double x = random.Uniform(-4, 4), y = random.Uniform(-4, 4);
    const estimation::PadState pad = PadAt(x, y, random.Uniform(-3, 3));
    const MujocoScene mujoco(config, pad);
    DepthCamera camera(camera_config, config.obstacles, config.pad, 1);
    estimation::DepthFrame frame;
    for (int view = 0; view < 3; ++view) {
      estimation::VehicleState vehicle;
      vehicle.p_WB = test::RandomPoint({-5, -5, 0.5}, {5, 5, 4}, &random);
      vehicle.q_WB = test::RandomAttitude(0.6, &random);
      camera.Capture(vehicle, pad, &frame);
      const estimation::CameraIntrinsics& k = frame.intrinsics;
      for (int row = 0; row < k.height; ++row) {
        for (int column = 0; column < k.width; ++column) {
          const Eigen::Vector3d ray_C((column + 0.5 - k.cx) / k.focal, (row + 0.5 - k.cy) / k.focal,
                                      1.0);
          const double expected = mujoco.Ray(frame.p_WC, frame.R_WC * ray_C);
          const double depth = Pixel(frame, row, column);
          ++compared;
          if (expected * ray_C.norm() > camera_config.max_range) {
            if (depth != kNone) ++different;
            continue;
          }
          ++seen;
          if (!(std::abs(depth - expected) < 1e-6)) ++different;
        }
      }
    }
  }
  EXPECT_GT(seen, compared / 4);
  EXPECT_LE(different, compared / 50000);  // a ray through an edge, to rounding
}

TEST(DepthCamera, GeometryByHand) {
  const ObstacleField wall({Box{{4.0, 0.0, 2.0}, {0.5, 0.3, 2.0}, 0.0}});
  DepthCamera camera({}, wall, {}, 1);
  estimation::VehicleState vehicle;
  vehicle.t = 1.5;
  vehicle.p_WB = {0.0, 0.0, 2.0};
  estimation::DepthFrame frame;
  camera.Capture(vehicle, PadAt(-20, 0, 0), &frame);
  EXPECT_EQ(frame.t, 1.5);
  EXPECT_NEAR(frame.intrinsics.focal, 40.0, 1e-12);  // 90 deg over 80 pixels
  EXPECT_TRUE(frame.p_WC.isApprox(Eigen::Vector3d(0.1, 0.0, 2.0)));
  // The optical axis is forward, x_C to the right, y_C down.
  EXPECT_TRUE(frame.R_WC.col(2).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(frame.R_WC.col(0).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(frame.R_WC.col(1).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_FLOAT_EQ(Pixel(frame, 30, 40), 3.4F);
  EXPECT_EQ(Pixel(frame, 5, 10), kNone);  // sky
  // The lowest row looks down by (59.5 - 30) / 40 and sees the ground 2 m below.
  EXPECT_NEAR(Pixel(frame, 59, 0), 2.0 * 40.0 / 29.5, 1e-5);
}

TEST(DepthCamera, SeesThePadAndNothingBeyondItsRange) {
  DepthCameraConfig config;
  config.max_range = 3.0;
  config.pitch_deg = 90.0;
  DepthCamera camera(config, {}, {}, 1);
  estimation::VehicleState vehicle;
  vehicle.p_WB = {0.0, 0.0, 2.3};
  estimation::DepthFrame frame;
  camera.Capture(vehicle, PadAt(0.1, 0.0, 0.5), &frame);
  EXPECT_FLOAT_EQ(Pixel(frame, 30, 40), 2.0F);   // the deck
  EXPECT_NEAR(Pixel(frame, 30, 70), 2.3, 1e-5);  // the ground beside it
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (frame.depth[i] == kNone) continue;
    const double u = (static_cast<double>(i % 80) + 0.5 - 40.0) / 40.0;
    const double v = (static_cast<double>(i / 80) + 0.5 - 30.0) / 40.0;
    EXPECT_LE(frame.depth[i] * std::sqrt(1.0 + u * u + v * v), 3.0 + 1e-6);
  }
  vehicle.p_WB.z() = 3.5;
  camera.Capture(vehicle, PadAt(0.1, 0.0, 0.5), &frame);
  EXPECT_EQ(*std::min_element(frame.depth.begin(), frame.depth.end()), kNone);
}

TEST(DepthCamera, RangeNoiseHasItsSpreadAndItsOwnStream) {
  DepthCameraConfig config;
  config.pitch_deg = 90.0;
  DepthCamera exact(config, {}, {}, 5);
  config.range_noise = 0.02;
  DepthCamera noisy(config, {}, {}, 5);
  DepthCamera again(config, {}, {}, 5);
  estimation::VehicleState vehicle;
  vehicle.p_WB = {0.0, 0.0, 2.0};
  estimation::DepthFrame truth;
  estimation::DepthFrame frame;
  estimation::DepthFrame same;
  exact.Capture(vehicle, PadAt(50, 0, 0), &truth);
  noisy.Capture(vehicle, PadAt(50, 0, 0), &frame);
  again.Capture(vehicle, PadAt(50, 0, 0), &same);
  EXPECT_EQ(frame.depth, same.depth);
  double mean = 0.0;
  double square = 0.0;
  const double n = static_cast<double>(frame.depth.size());
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double error = frame.depth[i] / truth.depth[i] - 1.0;
    mean += error / n;
    square += error * error / n;
  }
  EXPECT_LT(std::abs(mean), 4.0 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square), 0.02, 0.001);
}

TEST(DepthCamera, KeepsTheFramesMemory) {
  DepthCamera camera({}, {}, {}, 1);
  estimation::DepthFrame frame;
  estimation::VehicleState vehicle;
  vehicle.p_WB = {0.0, 0.0, 2.0};
  camera.Capture(vehicle, PadAt(0, 0, 0), &frame);
  const float* const memory = frame.depth.data();
  camera.Capture(vehicle, PadAt(1, 0, 0), &frame);
  EXPECT_EQ(frame.depth.data(), memory);
}

TEST(DepthCamera, RefusesBadConfigurations) {
  const auto message = [](auto change) {
    DepthCameraConfig config;
    change(&config);
    return test::MessageOf<std::invalid_argument>([&] { DepthCamera(config, {}, {}, 1); });
  };
  EXPECT_EQ(message([](DepthCameraConfig*) {}), "");
  EXPECT_THAT(message([](DepthCameraConfig* c) { c->fov_x_deg = 180.0; }),
              ::testing::HasSubstr("depth_camera.fov_x_deg is 180; allowed is (0, 170]"));
  EXPECT_THAT(message([](DepthCameraConfig* c) { c->width = 0; }), ::testing::HasSubstr("width"));
  EXPECT_THAT(message([](DepthCameraConfig* c) { c->range_noise = -0.1; }),
              ::testing::HasSubstr("range_noise is -0.1"));
}

}  // namespace
}  // namespace touchdown::sim
