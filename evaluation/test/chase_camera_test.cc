// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/chase_camera.h"

#include <cmath>

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

constexpr double kStep = 0.04;  // [s]

estimation::CameraIntrinsics Wide() {
  estimation::CameraIntrinsics camera;
  camera.width = 1280;
  camera.height = 720;
  camera.focal = 740.0;
  camera.cx = 640.0;
  camera.cy = 360.0;
  return camera;
}

// At 2 m/s along x, to a pad that stands 12 m away.
std::vector<ChaseSubject> Straight() {
  std::vector<ChaseSubject> subjects;
  for (int i = 0; i <= 150; ++i)
    subjects.push_back({{2.0 * kStep * i, 0.0, 2.0}, {12.0, 0.0, 0.5}});
  return subjects;
}

// Where in the picture, as shares of its size; the depth is positive.
Eigen::Vector2d ShareOf(const sim::CameraPose& pose, const Eigen::Vector3d& p_W) {
  const estimation::CameraIntrinsics camera = Wide();
  const Eigen::Vector3d p = pose.R_WC.transpose() * (p_W - pose.p_WC);
  EXPECT_GT(p.z(), 0.5);
  return {(camera.cx + camera.focal * p.x() / p.z()) / camera.width,
          (camera.cy + camera.focal * p.y() / p.z()) / camera.height};
}

bool InFrame(const Eigen::Vector2d& share) {
  const ChaseFrame frame;
  return share.x() > frame.left && share.x() < frame.right && share.y() > frame.top &&
         share.y() < frame.bottom;
}

TEST(ChaseCamera, IsBehindAndAboveAndUpright) {
  const auto subjects = Straight();
  const auto poses = ChaseFlight(subjects, kStep, {}, Wide());
  ASSERT_EQ(poses.size(), subjects.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(poses[i].p_WC.x(), subjects[i].vehicle_W.x() - 0.6);
    EXPECT_GT(poses[i].p_WC.z(), subjects[i].vehicle_W.z());
    EXPECT_TRUE(InFrame(ShareOf(poses[i], subjects[i].vehicle_W))) << i;
    EXPECT_TRUE(InFrame(ShareOf(poses[i], subjects[i].target_W))) << i;
    EXPECT_NEAR((poses[i].R_WC.transpose() * poses[i].R_WC - Eigen::Matrix3d::Identity()).norm(),
                0.0, 1e-9);
    EXPECT_GT(poses[i].R_WC(2, 1), -1.0);
    EXPECT_LT(poses[i].R_WC(2, 1), -0.5);  // the picture's down is the world's
  }
}

TEST(ChaseCamera, MovesSmoothly) {
  // A vehicle that turns about at once.
  auto subjects = Straight();
  for (std::size_t i = 80; i < subjects.size(); ++i) subjects[i].target_W = {-12.0, 0.0, 0.5};
  const auto poses = ChaseFlight(subjects, kStep, {}, Wide());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_LT((poses[i].p_WC - poses[i - 1].p_WC).norm(), 15.0 * kStep) << i;
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(poses[i - 1].R_WC.transpose() * poses[i].R_WC));
    EXPECT_LT(turn.angle(), 3.0 * kStep) << i;
  }
}

TEST(ChaseCamera, KeepsOutOfObstaclesAndTheVehicleInSight) {
  // A lane of 2.4 m between walls of 6 m height; behind the start it is closed.
  const sim::ObstacleField walls({sim::Box{{6.0, 2.2, 3.0}, {9.0, 1.0, 3.0}, 0.0},
                                  sim::Box{{6.0, -2.2, 3.0}, {9.0, 1.0, 3.0}, 0.0},
                                  sim::Box{{-2.5, 0.0, 3.0}, {0.5, 3.0, 3.0}, 0.0}});
  const auto subjects = Straight();
  const auto poses = ChaseFlight(subjects, kStep, walls, Wide());
  int seen = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d& p = poses[i].p_WC;
    EXPECT_GT(walls.SignedDistance(p), 0.2) << i;
    if (walls.RayDistance(p, subjects[i].vehicle_W - p) >= 1.0) ++seen;
  }
  EXPECT_GT(seen, 0.95 * static_cast<double>(poses.size()));
}

TEST(ChaseCamera, OfNothingThereIsNothing) {
  EXPECT_TRUE(ChaseFlight({}, kStep, {}, Wide()).empty());
  EXPECT_EQ(ChaseFlight({{{0.0, 0.0, 1.0}, {0.0, 0.0, 0.5}}}, kStep, {}, Wide()).size(), 1U);
}

}  // namespace
}  // namespace touchdown::evaluation
