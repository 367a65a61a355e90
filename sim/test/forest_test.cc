// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/forest.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/rendering/scene_mjcf.h"
#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using test::MessageOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Shape>
std::vector<Shape> All(const ObstacleField& field) {
  std::vector<Shape> shapes;
  for (const Obstacle& obstacle : field.obstacles()) {
    if (const auto* shape = std::get_if<Shape>(&obstacle)) shapes.push_back(*shape);
  }
  return shapes;
}

Eigen::Vector2d CenterOf(const VoxelColumns& pillar) {
  return pillar.corner.head<2>() +
         0.5 * pillar.cell * Eigen::Vector2d(pillar.count_x, pillar.count_y);
}

TEST(Forest, KindsHaveTheirNumbersAndShapes) {
  const ObstacleField a = MakeForest(ForestOfKind("A"), 1);
  EXPECT_EQ(All<VoxelColumns>(a).size(), 200u);
  EXPECT_EQ(All<Ring>(a).size(), 200u);
  EXPECT_EQ(All<VoxelColumns>(MakeForest(ForestOfKind("B"), 1)).size(), 200u);
  EXPECT_EQ(All<VoxelColumns>(MakeForest(ForestOfKind("C"), 1)).size(), 400u);
  EXPECT_EQ(All<VoxelColumns>(MakeForest(ForestOfKind("D"), 1)).size(), 200u);
  EXPECT_EQ(All<VoxelColumns>(MakeForest(ForestOfKind("dense"), 1)).size(), 800u);
  EXPECT_EQ(All<Box>(MakeForest(ForestOfKind("walls"), 1)).size(), 120u);
  EXPECT_THAT(MessageOf<std::invalid_argument>([] { ForestOfKind("jungle"); }),
              AllOf(HasSubstr("jungle"), HasSubstr("A, B, C, D")));
}

TEST(Forest, PillarsKeepTheirDistances) {
  for (const std::string kind : {"B", "C", "dense"}) {
    ForestConfig config = ForestOfKind(kind);
    config.keep_out = {{{1.0, 2.0}, 2.0}, {{-9.0, 4.0}, 2.0}};
    const std::vector<VoxelColumns> pillars = All<VoxelColumns>(MakeForest(config, 7));
    const double snap = std::sqrt(0.5) * config.cell;  // a centre moves by at most this
    for (std::size_t i = 0; i < pillars.size(); ++i) {
      const Eigen::Vector2d center = CenterOf(pillars[i]);
      EXPECT_LE(center.cwiseAbs().maxCoeff(), 20.1);
      for (const KeepOut& keep : config.keep_out) {
        EXPECT_GE((center - keep.center).norm(), keep.radius - snap);
      }
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE((center - CenterOf(pillars[j])).norm(), config.spacing - 2.0 * snap) << kind;
      }
    }
  }
}

// Radii are w s / 2 with w = U(0.5, 0.7), s = U(0.5, 1.5): mean 0.3 m, from 0.125 to 0.525 m.
TEST(Forest, PillarsAreDiscsOfTheStatedSizes) {
  ForestConfig config = ForestOfKind("B");
  config.shape = PillarShape::kCylinder;
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ObstacleField columns = MakeForest(ForestOfKind("B"), seed);
    const ObstacleField cylinders = MakeForest(config, seed);
    for (std::size_t i = 0; i < cylinders.size(); ++i) {
      const auto& cylinder = std::get<Cylinder>(cylinders.obstacles()[i]);
      EXPECT_GE(cylinder.radius, 0.125);
      EXPECT_LE(cylinder.radius, 0.525);
      EXPECT_DOUBLE_EQ(cylinder.height, 3.0);
      sum += cylinder.radius;
      ++count;
      // The other shape is the same pillar: every column's axis within the radius, and no other.
      const auto& pillar = std::get<VoxelColumns>(columns.obstacles()[i]);
      EXPECT_NEAR((CenterOf(pillar) - cylinder.center.head<2>()).norm(), 0.0, 1e-12);
      for (int y = 0; y < pillar.count_y; ++y) {
        for (int x = 0; x < pillar.count_x; ++x) {
          const Eigen::Vector2d axis =
              pillar.corner.head<2>() + pillar.cell * Eigen::Vector2d(x + 0.5, y + 0.5);
          const double off = (axis - cylinder.center.head<2>()).norm();
          if (std::abs(off - cylinder.radius) < 1e-9) continue;
          EXPECT_EQ(pillar.heights[y * pillar.count_x + x], off < cylinder.radius ? 3.0 : 0.0);
        }
      }
    }
  }
  EXPECT_NEAR(sum / count, 0.3, 0.005);
}

TEST(Forest, RaggedColumnsAreUniformInHeight) {
  double sum = 0.0, least = 3.0, most = 0.0;
  int count = 0;
  for (const VoxelColumns& pillar : All<VoxelColumns>(MakeForest(ForestOfKind("A"), 3))) {
    for (const double height : pillar.heights) {
      if (height == 0.0) continue;
      sum += height;
      least = std::min(least, height);
      most = std::max(most, height);
      ++count;
    }
  }
  EXPECT_GT(count, 3000);
  EXPECT_NEAR(sum / count, 1.5, 0.05);
  EXPECT_LT(least, 0.05);
  EXPECT_GT(most, 2.95);
}

TEST(Forest, RingsHaveTheStatedAxes) {
  for (const Ring& ring : All<Ring>(MakeForest(ForestOfKind("A"), 5))) {
    EXPECT_GE(ring.center.z(), 0.7);
    EXPECT_LE(ring.center.z(), 0.8);
    EXPECT_GE(ring.half_width, 0.5);
    EXPECT_LE(ring.half_width, 0.7);
    EXPECT_GE(ring.half_height, 0.7);
    EXPECT_LE(ring.half_height, 1.2);
    EXPECT_LE(std::abs(ring.yaw), 0.5);
    // Through the middle there is nothing; on the hoop there is.
    EXPECT_GT(DistanceTo(ring, ring.center), 0.4);
    EXPECT_LT(DistanceTo(ring, ring.Corner(5)), 0.0);
  }
}

TEST(Forest, WallsHaveAGapToFlyThrough) {
  const std::vector<Box> boxes = All<Box>(MakeForest(ForestOfKind("walls"), 2));
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    const Box& a = boxes[i];
    const Box& b = boxes[i + 1];
    EXPECT_DOUBLE_EQ(a.yaw, b.yaw);
    const double apart = (b.center - a.center).norm();
    const double gap = apart - a.half_extents.x() - b.half_extents.x();
    EXPECT_GE(gap, 1.4 - 1e-9);
    EXPECT_LE(gap, 2.2 + 1e-9);
    const double length = gap + 2.0 * (a.half_extents.x() + b.half_extents.x());
    EXPECT_GE(length, 4.0 - 1e-9);
    EXPECT_LE(length, 8.0 + 1e-9);
  }
}

TEST(Forest, SameSeedSameForestAndStreamsAreTheirOwn) {
  const auto distances = [](const ObstacleField& field) {
    std::vector<double> d;
    for (double x = -18.0; x < 18.0; x += 2.3) d.push_back(field.SignedDistance({x, 0.4 * x, 1.1}));
    return d;
  };
  EXPECT_EQ(distances(MakeForest(ForestOfKind("A"), 11)),
            distances(MakeForest(ForestOfKind("A"), 11)));
  EXPECT_NE(distances(MakeForest(ForestOfKind("A"), 11)),
            distances(MakeForest(ForestOfKind("A"), 12)));
  // Leaving the rings out moves no pillar.
  ForestConfig without = ForestOfKind("A");
  without.rings = 0;
  const std::vector<VoxelColumns> a = All<VoxelColumns>(MakeForest(ForestOfKind("A"), 11));
  const std::vector<VoxelColumns> b = All<VoxelColumns>(MakeForest(without, 11));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].heights, b[i].heights);
}

TEST(Forest, RefusesWhatCannotBe) {
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                ForestConfig config;
                SetDensity(0.6, &config);
              }),
              AllOf(HasSubstr("density"), HasSubstr("0.6"), HasSubstr("[0, 0.5]")));
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                ForestConfig config;
                config.pillars = 800;
                config.spacing = 1.2;
                MakeForest(config, 1);
              }),
              AllOf(HasSubstr("pillars is 800"), HasSubstr("fits")));
}

// Ragged pillars and rings have no geoms: code that would draw them says so.
TEST(Forest, VoxelShapesAreRefusedWhereAPictureIsAsked) {
  VisualScene scene;
  scene.obstacles = MakeForest(ForestOfKind("A"), 1);
  EXPECT_THAT(MessageOf<std::invalid_argument>([&] { SceneMjcf(scene, {}); }),
              AllOf(HasSubstr("obstacle 0"), HasSubstr("voxel columns"), HasSubstr("scene")));
  scene.obstacles = ObstacleField({Ring{}});
  EXPECT_THAT(MessageOf<std::invalid_argument>([&] { SceneMjcf(scene, {}); }),
              HasSubstr("obstacle 0 is a ring"));
}

}  // namespace
}  // namespace touchdown::sim
