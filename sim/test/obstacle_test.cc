// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/obstacle.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/obstacles/obstacle_field.h"
#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using test::MessageOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Obstacle, SignedDistanceToBoxByHand) {
  const Box box{{1.0, 2.0, 3.0}, {0.5, 1.0, 1.5}, 0.0};
  EXPECT_DOUBLE_EQ(SignedDistance(box, {2.5, 2.0, 3.0}), 1.0);
  EXPECT_DOUBLE_EQ(SignedDistance(box, {1.0, 2.0, 3.0}), -0.5);
  EXPECT_NEAR(SignedDistance(box, {1.8, 3.4, 4.5}), 0.5, 1e-12);  // off an edge by 0.3, 0.4
  const Box turned{{0.0, 0.0, 0.0}, {2.0, 0.5, 1.0}, std::numbers::pi / 2.0};
  EXPECT_NEAR(SignedDistance(turned, {0.0, 3.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(SignedDistance(turned, {1.0, 0.0, 0.0}), 0.5, 1e-12);
}

TEST(Obstacle, SignedDistanceToCylinderByHand) {
  const Cylinder cylinder{{1.0, 0.0, 1.0}, 0.5, 2.0};
  EXPECT_DOUBLE_EQ(SignedDistance(cylinder, {3.0, 0.0, 1.0}), 1.5);
  EXPECT_DOUBLE_EQ(SignedDistance(cylinder, {1.0, 0.0, 1.0}), -0.5);
  EXPECT_DOUBLE_EQ(SignedDistance(cylinder, {1.0, 0.0, 5.0}), 3.0);
  EXPECT_NEAR(SignedDistance(cylinder, {1.8, 0.0, 2.4}), 0.5, 1e-12);
}

// A ray ends on the surface, and nothing of it before is inside. Sphere tracing along it with the
// signed distance arrives at the same place. The two computations share nothing.
TEST(Obstacle, RaysAgreeWithSphereTracing) {
  RandomStream random(3, "obstacle rays");
  int hits = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const ObstacleField field = test::RandomField(6, 4.0, &random);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d origin = test::RandomPoint({-6, -6, 0}, {6, 6, 5}, &random);
      if (field.SignedDistance(origin) <= 0.0) continue;
      const Eigen::Vector3d direction =
          test::RandomPoint({-1, -1, -1}, {1, 1, 1}, &random).normalized();
      const double s = field.RayDistance(origin, direction);
      double traced = 0.0;
      for (int step = 0; step < 2000 && traced < 20.0; ++step) {
        const double clear = field.SignedDistance(origin + traced * direction);
        if (clear < 1e-9) break;
        traced += clear;
      }
      if (s > 20.0) {
        EXPECT_GE(traced, 20.0);
        continue;
      }
      ++hits;
      EXPECT_NEAR(field.SignedDistance(origin + s * direction), 0.0, 1e-9);
      EXPECT_LE(traced, s + 1e-6);
      // A grazing ray is traced in ever smaller steps and may not arrive.
      if (field.SignedDistance(origin + traced * direction) < 1e-9) {
        EXPECT_NEAR(traced, s, 1e-4);
      }
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(Obstacle, RayCountsInUnitsOfItsDirectionAndLeavesFromInside) {
  const Box box{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 0.0};
  EXPECT_DOUBLE_EQ(RayDistance(box, {-5.0, 0.0, 0.0}, {2.0, 0.0, 0.0}), 2.0);
  EXPECT_DOUBLE_EQ(RayDistance(box, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}), 0.5);
  EXPECT_EQ(RayDistance(box, {5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), kInfinity);
  EXPECT_EQ(RayDistance(box, {-5.0, 2.0, 0.0}, {1.0, 0.0, 0.0}), kInfinity);
  const Cylinder cylinder{{0.0, 0.0, 0.0}, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(RayDistance(cylinder, {0.5, 0.0, 4.0}, {0.0, 0.0, -1.0}), 3.0);
  EXPECT_EQ(RayDistance(cylinder, {1.5, 0.0, 4.0}, {0.0, 0.0, -1.0}), kInfinity);
  EXPECT_DOUBLE_EQ(RayDistance(cylinder, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 1.0);
}

// The same two computations for the shapes made of pieces.
TEST(Obstacle, RaysAtCompoundShapesAgreeWithSphereTracing) {
  VoxelColumns columns;
  columns.corner = {-0.4, -0.3, 0.1};
  columns.cell = 0.25;
  columns.count_x = 3;
  columns.count_y = 2;
  columns.heights = {1.0, 0.4, 0.0, 0.7, 1.3, 0.9};
  const Ring ring{{0.1, 0.2, 0.3}, 0.6, 0.9, 0.08, 0.4};
  RandomStream random(9, "compound rays");
  int hits = 0;
  for (const Obstacle& obstacle : {Obstacle(columns), Obstacle(ring)}) {
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d origin = test::RandomPoint({-3, -3, -3}, {3, 3, 3}, &random);
      const Eigen::Vector3d aim = test::RandomPoint({-1, -1, -1}, {1, 1, 1}, &random);
      const Eigen::Vector3d direction = (aim - origin).normalized();
      if (SignedDistance(obstacle, origin) <= 0.0) continue;
      const double s = RayDistance(obstacle, origin, direction);
      double traced = 0.0;
      for (int step = 0; step < 2000 && traced < 20.0; ++step) {
        const double clear = SignedDistance(obstacle, origin + traced * direction);
        if (clear < 1e-9) break;
        traced += clear;
      }
      EXPECT_EQ(s > 20.0, traced >= 20.0) << i;
      if (s > 20.0) continue;
      ++hits;
      EXPECT_NEAR(traced, s, 1e-4);
      EXPECT_NEAR(SignedDistance(obstacle, origin + s * direction), 0.0, 1e-9);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(Obstacle, BoundsAreTight) {
  RandomStream random(4, "obstacle bounds");
  std::vector<Obstacle> obstacles = test::RandomField(20, 4.0, &random).obstacles();
  VoxelColumns columns;
  columns.count_x = 4;
  columns.count_y = 3;
  columns.heights = {0, 0, 0, 0, 0, 0.2, 0.3, 0, 0, 0, 0, 0};  // only its middle stands
  obstacles.push_back(columns);
  const ObstacleField field(obstacles);
  for (const Obstacle& obstacle : field.obstacles()) {
    const Bounds bounds = BoundsOf(obstacle);
    Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity);
    Eigen::Vector3d high = -low;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d p = test::RandomPoint(bounds.min, bounds.max, &random);
      if (SignedDistance(obstacle, p) > 0.0) continue;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double size = (bounds.max - bounds.min).norm();
    EXPECT_LT((low - bounds.min).norm(), 0.2 * size);
    EXPECT_LT((bounds.max - high).norm(), 0.2 * size);
    // Just outside each face there is nothing.
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 50; ++i) {
        Eigen::Vector3d p = test::RandomPoint(bounds.min, bounds.max, &random);
        p[axis] = bounds.max[axis] + 1e-9;
        EXPECT_GT(SignedDistance(obstacle, p), 0.0);
      }
    }
  }
}

TEST(ObstacleField, EmptyFieldIsInfinitelyFar) {
  EXPECT_EQ(ObstacleField().SignedDistance({0.0, 0.0, 0.0}), kInfinity);
  EXPECT_EQ(ObstacleField().RayDistance({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), kInfinity);
}

TEST(ObstacleField, RefusesByNameValueAndRange) {
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                VoxelColumns columns;
                columns.count_x = 2;
                ObstacleField({columns});
              }),
              AllOf(HasSubstr("obstacle 0: number of heights is 1"), HasSubstr("[2, 2]")));
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                Ring ring;
                ring.half_width = 0.0;
                ObstacleField({ring});
              }),
              HasSubstr("obstacle 0: half_width is 0"));
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                ObstacleField({Box{}, Box{{0, 0, 0}, {1.0, -0.5, 1.0}, 0.0}});
              }),
              AllOf(HasSubstr("obstacle 1: half_extents.y is -0.5"), HasSubstr("(0, 1000]")));
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                ObstacleField({Cylinder{{0, 0, 0}, 0.5, std::nan("")}});
              }),
              AllOf(HasSubstr("obstacle 0: height is nan"), HasSubstr("(0, 1000]")));
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                ObstacleField({Cylinder{{kInfinity, 0, 0}, 0.5, 1.0}});
              }),
              HasSubstr("obstacle 0: center.x is inf"));
}

}  // namespace
}  // namespace touchdown::sim
