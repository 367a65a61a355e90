// SPDX-License-Identifier: BSD-3-Clause
// Worlds of all kinds of obstacles: all users of their geometry see the same.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/mujoco/mjcf_text.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/true_clearance.h"
#include "sim/obstacles/world_files.h"
#include "sim/test/scenes.h"
#include "sim/world/world.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const TriangleMesh> Shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

Placement AnyPlacement(RandomStream* random) {
  return {test::RandomAttitude(1.5, random).toRotationMatrix(),
          test::RandomPoint({-5, -5, 1}, {5, 5, 4}, random)};
}

/// Hills of 12 x 9 heights.
TriangleMesh Hills(RandomStream* random) {
  HeightGrid grid{12, 9, {}};
  for (int i = 0; i < 12 * 9; ++i) grid.heights.push_back(random->Uniform(0.0, 1.5));
  return HeightFieldMesh(grid, {8.0, 6.0}, 0.3,
                         {TurnOf(0.0, 0.0, random->Uniform(-3, 3)),
                          test::RandomPoint({-3, -3, 0}, {3, 3, 0.2}, random)});
}

/// Boxes, cylinders, spheres, tilted boxes and hills.
ObstacleField AnyWorld(RandomStream* random) {
  std::vector<Obstacle> all = test::RandomField(10, 5.0, random).obstacles();
  for (int i = 0; i < 4; ++i) {
    all.emplace_back(
        Sphere{test::RandomPoint({-5, -5, 0}, {5, 5, 4}, random), random->Uniform(0.1, 1.0)});
    all.emplace_back(Mesh{Shared(BoxMesh(
        test::RandomPoint({0.1, 0.1, 0.1}, {1.0, 1.0, 1.5}, random), AnyPlacement(random)))});
  }
  all.emplace_back(Mesh{Shared(Hills(random))});
  return ObstacleField(std::move(all));
}

/// A hull so small that it is a point.
estimation::VehicleModel Point() {
  estimation::VehicleModel model;
  model.hull_radius = 1e-4;
  model.hull_top = 1e-4;
  model.foot_depth = 1e-4;
  return model;
}

// 3 mm is what libccd's GJK may be off where a shape is round; a point has a tenth of a millimetre.
TEST(WorldGeometry, DistancesAgreeWithFcl) {
  RandomStream random(3, "distances");
  double largest = 0.0;
  int inside = 0;
  for (int world = 0; world < 20; ++world) {
    const ObstacleField field = AnyWorld(&random);
    const TrueClearance fcl(field, Point());
    for (int i = 0; i < 200; ++i) {
      estimation::VehicleState at;
      at.p_WB = test::RandomPoint({-7, -7, -1}, {7, 7, 6}, &random);
      const double ours = field.SignedDistance(at.p_WB);
      double one_by_one = 1e9;
      for (const Obstacle& obstacle : field.obstacles()) {
        one_by_one = std::min(one_by_one, SignedDistance(obstacle, at.p_WB));
      }
      EXPECT_EQ(ours, one_by_one);
      if (ours < 1e-3) {
        ++inside;
        continue;
      }
      largest = std::max(largest, std::abs(ours - fcl.Distance(at)));
    }
  }
  EXPECT_LT(largest, 3e-4);
  EXPECT_GT(inside, 100);
  RecordProperty("largest_difference_m", std::to_string(largest));
}

TEST(WorldGeometry, RaysAgreeWithMuJoCo) {
  RandomStream random(4, "rays");
  double largest = 0.0;
  int different = 0, compared = 0;
  for (int world = 0; world < 20; ++world) {
    const ObstacleField field = AnyWorld(&random);
    std::string assets, geoms;
    for (std::size_t i = 0; i < field.size(); ++i) {
      const std::string name = std::to_string(i);
      const Obstacle& obstacle = field.obstacles()[i];
      if (const auto* mesh = std::get_if<Mesh>(&obstacle)) {
        assets += MeshAssetText(mesh->surface->corners(), mesh->surface->triangles(), name);
      }
      geoms += "<geom " + GeomText(obstacle, name, "mj_ray") + "/>";
    }
    const MujocoModel model = CompileMjcf("<mujoco><asset>" + assets + "</asset><worldbody>" +
                                          geoms + "</worldbody></mujoco>");
    const MujocoData data = MakeMujocoData(*model);
    mj_forward(model.get(), data.get());
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d from = test::RandomPoint({-7, -7, 0}, {7, 7, 6}, &random);
      const Eigen::Vector3d along = test::RandomPoint({-1, -1, -1}, {1, 1, 1}, &random);
      if (field.SignedDistance(from) < 0.01) continue;
      int geom = -1;
      const double theirs =
          mj_ray(model.get(), data.get(), from.data(), along.data(), nullptr, 1, -1, &geom);
      const double ours = field.RayDistance(from, along);
      ++compared;
      if ((theirs < 0.0) != std::isinf(ours)) {
        ++different;
      } else if (theirs >= 0.0) {
        largest = std::max(largest, along.norm() * std::abs(ours - theirs));
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LE(different,
            2);  // through an edge, to rounding: MuJoCo's corners are of single precision
  EXPECT_LT(largest, 1e-4);
  RecordProperty("largest_difference_m", std::to_string(largest));
}

// The vehicle first touches where and when it comes nearest, not before.
TEST(WorldGeometry, AVehicleThatFallsTouchesEachKind) {
  const Placement tilted{TurnOf(0.3, 0.2, 0.5), {0.0, 0.0, 2.0}};
  const std::vector<Obstacle> kinds = {Box{{0, 0, 1}, {1, 1, 1}, 0.3},
                                       Cylinder{{0, 0, 1}, 1.0, 2.0}, Sphere{{0, 0, 1}, 1.0},
                                       Mesh{Shared(BoxMesh({1.0, 1.0, 0.3}, tilted))}};
  for (const Obstacle& obstacle : kinds) {
    WorldConfig config = test::OpenSky();
    config.start.p_WB = {0.0, 0.0, 4.0};
    config.obstacles = ObstacleField({Box{{9, 9, 1}, {1, 1, 1}, 0.0}, obstacle});
    World world(config);
    while (world.contacts().empty() && world.time() < 2.0) world.Step(Eigen::Vector4d(0, 0, 0, 0));
    ASSERT_FALSE(world.contacts().empty()) << obstacle.index();
    const Contact& contact = world.contacts().front();
    EXPECT_EQ(contact.kind, ContactKind::kObstacle);
    EXPECT_EQ(contact.obstacle, 1);
    EXPECT_NEAR(SignedDistance(obstacle, contact.p_W), 0.0, 0.02) << obstacle.index();
    // Of one step at this speed the vehicle is at most so deep.
    const double clearance =
        TrueClearance(config.obstacles, world.model()).Distance(world.vehicle());
    EXPECT_LE(clearance, 0.0) << obstacle.index();
    EXPECT_GT(clearance, -0.35) << obstacle.index();
  }
}

TEST(TriangleMesh, SaysWhatIsWrongWithASurface) {
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Eigen::Vector3i> closed = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const auto said = [&](std::vector<Eigen::Vector3d> c, std::vector<Eigen::Vector3i> t) {
    return test::MessageOf<std::invalid_argument>(
        [&] { TriangleMesh(std::move(c), std::move(t)); });
  };
  EXPECT_EQ(said(corners, closed), "");
  EXPECT_THAT(said(corners, {}), HasSubstr("no triangle"));
  EXPECT_THAT(said(corners, {closed[0], closed[1], closed[2]}), HasSubstr("is open"));
  EXPECT_THAT(said(corners, {{0, 1, 2}, closed[1], closed[2], closed[3]}), HasSubstr("same sense"));
  EXPECT_THAT(said(corners, {{0, 2, 2}, closed[1], closed[2], closed[3]}), HasSubstr("no area"));
  EXPECT_THAT(said(corners, {{0, 2, 7}, closed[1], closed[2], closed[3]}),
              HasSubstr("corner 7 of 4"));
  auto broken = corners;
  broken[2].y() = std::nan("");
  EXPECT_THAT(said(broken, closed), HasSubstr("not finite"));
}

TEST(TriangleMesh, ASurfaceTurnedInsideOutIsTurnedBack) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}});
  EXPECT_NEAR(mesh.Volume(), 1.0 / 6.0, 1e-12);
  EXPECT_LT(mesh.SignedDistance({0.1, 0.1, 0.1}), 0.0);
}

TEST(TriangleMesh, MeetsWhatItReachesInto) {
  const TriangleMesh box = BoxMesh({1, 1, 1}, {TurnOf(0, 0, 0.785398163397448), {0, 0, 0}});
  const auto meets = [&](const Eigen::Vector3d& p, double half) {
    return box.Meets({p.array() - half, p.array() + half});
  };
  EXPECT_TRUE(meets({0, 0, 0}, 0.1));       // within
  EXPECT_TRUE(meets({0, 0, 0}, 9.0));       // around
  EXPECT_TRUE(meets({1.4, 0, 0}, 0.05));    // a corner
  EXPECT_FALSE(meets({1.0, 1.0, 0}, 0.2));  // within its bounds, beyond its side
  EXPECT_FALSE(meets({0, 0, 1.2}, 0.1));
}

TEST(MeshShapes, SolidsAreToldApart) {
  const TriangleMesh one = BoxMesh({1, 1, 1}, {}),
                     other = BoxMesh({1, 1, 1}, {TurnOf(0, 0, 0), {5, 0, 0}});
  std::vector<Eigen::Vector3d>
      corners;  // three of its own to each triangle, as an STL file has them
  std::vector<Eigen::Vector3i> triangles;
  for (const TriangleMesh* mesh : {&one, &other}) {
    for (const Eigen::Vector3i& of : mesh->triangles()) {
      for (const int i : of) corners.push_back(mesh->corners()[static_cast<std::size_t>(i)]);
      const int n = static_cast<int>(corners.size());
      triangles.emplace_back(n - 3, n - 2, n - 1);
    }
  }
  const std::vector<TriangleMesh> solids = SolidsOf(corners, triangles);
  ASSERT_EQ(solids.size(), 2u);
  EXPECT_EQ(solids[1].corners().size(), 8u);
  EXPECT_NEAR(solids[1].SignedDistance({5.0, 0.0, 3.0}), 2.0, 1e-12);
}

// Two boxes that share a face, an edge or a corner are two solids.
TEST(MeshShapes, SolidsMayTouch) {
  for (const Eigen::Vector3d& off :
       {Eigen::Vector3d(2, 0, 0), {2, 2, 0}, {2, 2, 2}, {0, -2, 0}, {0, 2, -2}}) {
    std::vector<Eigen::Vector3d> corners;
    std::vector<Eigen::Vector3i> triangles;
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), off}) {
      const TriangleMesh box = BoxMesh({1, 1, 1}, {TurnOf(0, 0, 0), p});
      const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(corners.size()));
      corners.insert(corners.end(), box.corners().begin(), box.corners().end());
      for (const Eigen::Vector3i& of : box.triangles()) triangles.push_back(first + of);
    }
    const std::vector<TriangleMesh> solids = SolidsOf(corners, triangles);
    ASSERT_EQ(solids.size(), 2u) << off.transpose();
    EXPECT_NEAR(solids[0].Volume(), 8.0, 1e-12);
    EXPECT_NEAR(solids[1].Volume(), 8.0, 1e-12);
  }
}

// Also where all are turned inside out. A single inverted one within another is no solid.
TEST(MeshShapes, InsideOutAndCavities) {
  const auto solids = [](const std::vector<TriangleMesh>& parts, const std::vector<bool>& turned) {
    std::vector<Eigen::Vector3d> corners;
    std::vector<Eigen::Vector3i> triangles;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(corners.size()));
      corners.insert(corners.end(), parts[i].corners().begin(), parts[i].corners().end());
      for (Eigen::Vector3i of : parts[i].triangles()) {
        if (turned[i]) std::swap(of[0], of[1]);
        triangles.push_back(first + of);
      }
    }
    return SolidsOf(corners, triangles);
  };
  const TriangleMesh box = BoxMesh({1, 1, 1}, {}),
                     beside = BoxMesh({1, 1, 1}, {TurnOf(0, 0, 0), {2, 0, 0}});
  const TriangleMesh within = BoxMesh({0.5, 0.5, 0.5}, {});
  EXPECT_EQ(solids({box, beside}, {true, true}).size(), 2u);
  EXPECT_EQ(solids({box, within}, {false, false}).size(), 2u);
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] {
                solids({box, within}, {false, true});
              }),
              HasSubstr("is a cavity"));
}

TEST(TrueClearance, OfAMeshThatIsTouchedItIsNothing) {
  const TrueClearance mesh(ObstacleField({Mesh{Shared(BoxMesh({1, 1, 1}, {}))}}), {});
  estimation::VehicleState state;
  for (const double x : {0.9, 1.0, 1.2}) {
    state.p_WB.x() = x;
    EXPECT_EQ(mesh.Distance(state), 0.0);
  }
  state.p_WB.x() = 2.0;
  EXPECT_NEAR(mesh.Distance(state), 0.7, 1e-6);
}

TEST(MeshShapes, AHeightFieldHasItsHeights) {
  HeightGrid grid{3, 2, {0.0, 1.0, 2.0, 0.0, 1.0, 2.0}};
  const TriangleMesh mesh = HeightFieldMesh(grid, {4.0, 2.0}, 0.5, {});
  const auto height = [&](double x, double y) {
    return 5.0 - mesh.RayDistance({x, y, 5.0}, {0, 0, -1});
  };
  EXPECT_NEAR(height(-1.9, 0.1), 0.05, 1e-9);
  EXPECT_NEAR(height(1.0, -0.7), 1.5, 1e-9);
  EXPECT_EQ(mesh.bounds().min.z(), -0.5);
  EXPECT_NEAR(mesh.Volume(), 4.0 * 2.0 * 1.5, 1e-9);
}

TEST(CellBoxes, FillTheCellsAndNothingElse) {
  RandomStream random(5, "cells");
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < 9; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 7; ++z) {
        if (random.Uniform(0, 1) < 0.6) cells.emplace_back(x, y, z);
      }
    }
  }
  const double side = 0.25, yaw = 0.4;
  const Eigen::Vector3d place(1, 2, 3);
  const ObstacleField field(BoxesOfCells(cells, side, place, yaw));
  EXPECT_LT(field.size(), cells.size() / 2);
  double volume = 0.0;
  for (const Obstacle& obstacle : field.obstacles()) {
    volume += 8.0 * std::get<Box>(obstacle).half_extents.prod();
  }
  EXPECT_NEAR(volume, static_cast<double>(cells.size()) * std::pow(side, 3), 1e-9);
  for (const Eigen::Vector3i& cell : cells) {
    const Eigen::Vector3d middle =
        TurnOf(0, 0, yaw) * (side * (cell.cast<double>().array() + 0.5).matrix());
    EXPECT_LT(field.SignedDistance(place + middle), 0.0);
  }
}

}  // namespace
}  // namespace touchdown::sim
