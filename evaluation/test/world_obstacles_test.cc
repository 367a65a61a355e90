// SPDX-License-Identifier: BSD-3-Clause
// Worlds from lists and files: their obstacles, refusals with their place, and flights in them.
#include "evaluation/scenario/world_obstacles.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/obstacle_field.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kWorlds = TOUCHDOWN_SOURCE_DIR "/docs/examples/worlds/";

/// A tetrahedron, the triangles that are given of it.
std::string Obj(const std::vector<std::string>& faces) {
  std::string text = "v 9 9 0\nv 10 9 0\nv 9 10 0\nv 9 9 1\n";
  for (const std::string& face : faces) text += "f " + face + "\n";
  return text;
}

class WorldObstacles : public ::testing::Test {
 protected:
  ~WorldObstacles() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + name, std::ios::binary) << bytes;
    return folder_ + name;
  }

  Scenario Load(const std::string& text) {
    return ParseScenario(text, "world", "world.yaml", {}, StandardRegistries());
  }

  std::string Refusal(const std::string& text) {
    try {
      Load(text);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "accepted";
  }

  /// The refusal of a mesh file, which stands in line 3.
  std::string OfMesh(const std::string& name, const std::string& bytes) {
    return Refusal("obstacles:\n  meshes:\n    - {file: " + Write(name, bytes) + "}\n");
  }

  std::string Folder() {
    const std::string folder = ::testing::TempDir() + "touchdown_worlds/";
    std::filesystem::create_directories(folder);
    return folder;
  }

  std::string folder_ = Folder();
};

const std::string kLists =
    "obstacles:\n"
    "  boxes:\n"
    "    - {centre: [-8, -3], size: [1, 2, 3], turn_deg: [0, 0, 30]}\n"
    "    - {centre: [-8, 9], size: [1, 2, 3], base: 1, turn_deg: [20, 10, 30]}\n"
    "  cylinders:\n    - {centre: [-5, 0.5], radius: 0.3, height: 4, base: 2}\n"
    "  spheres:\n    - {centre: [-9, 0, 2], radius: 0.7}\n"
    "  walls:\n    - {points: [-9, -9, -6, -9, -6, -12], thickness: 0.3, height: 2}\n";

TEST_F(WorldObstacles, EveryListGivesItsSolidsAndSurvivesADump) {
  const Scenario scenario = Load(kLists);
  const std::string text = DumpScenario(scenario);
  EXPECT_EQ(DumpScenario(Load(text)), text);
  const ObstacleList all = ObstaclesOf(scenario);
  ASSERT_EQ(all.size(), 6U);
  EXPECT_NEAR(std::get<sim::Box>(all[0].obstacle).yaw, 0.5235987755982988, 1e-12);
  EXPECT_NEAR(std::get<sim::Mesh>(all[1].obstacle).surface->Volume(), 6.0, 1e-9);
  EXPECT_EQ(std::get<sim::Cylinder>(all[2].obstacle).center.z(), 4.0);
  EXPECT_EQ(std::get<sim::Sphere>(all[3].obstacle).radius, 0.7);
  // A wall's pieces meet at the corner.
  EXPECT_EQ(all[5].key, "obstacles.walls[0]");
  EXPECT_LT(sim::SignedDistance(all[4].obstacle, {-5.9, -8.9, 1.0}), 0.0);
  EXPECT_LT(sim::SignedDistance(all[5].obstacle, {-6.1, -9.1, 1.0}), 0.0);
}

TEST_F(WorldObstacles, AnOctomapOfAnyCellSizeIsItsCells) {
  octomap::OcTree tree(0.08);
  std::set<std::array<int, 3>> cells;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 6; ++y) {
      for (int z = 0; z < 9; ++z) {
        const bool occupied = (x * 7 + y * 5 + z * 3) % 4 != 0;
        tree.updateNode(octomap::point3d(float(0.08 * (x + 0.5)), float(0.08 * (y + 0.5)),
                                         float(0.08 * (z + 0.5))),
                        occupied);
        if (occupied) cells.insert({x, y, z});
      }
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
  for (const char* name : {"map.bt", "map.ot"}) {
    const std::string path = folder_ + name;
    ASSERT_TRUE(path.ends_with("t") && (name[4] == 'b' ? tree.writeBinary(path) : tree.write(path)));
    const std::string at = "obstacles: {octomaps: [{file: " + path + ", at: [-9, -9, 0.5], yaw_deg: 90";
    const auto field = [&](const std::string& more) {
      std::vector<sim::Obstacle> solids;
      for (const NamedObstacle& named : ObstaclesOf(Load(at + more + "}]}\n"))) {
        solids.push_back(named.obstacle);
      }
      return sim::ObstacleField(std::move(solids));
    };
    const sim::ObstacleField all = field(""), low = field(", crop_max: [9, 9, 0.3]");
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 6; ++y) {
        for (int z = 0; z < 9; ++z) {
          const Eigen::Vector3d p(-9 - 0.08 * (y + 0.5), -9 + 0.08 * (x + 0.5), 0.5 + 0.08 * (z + 0.5));
          const bool is = cells.count({x, y, z}) > 0;
          EXPECT_EQ(all.SignedDistance(p) < 0.0, is) << x << " " << y << " " << z;
          EXPECT_EQ(low.SignedDistance(p) < 0.0, is && z <= 3);
        }
      }
    }
    EXPECT_THAT(Refusal(at + ", crop_min: [50, 0, 0]}]}\n"), HasSubstr("no occupied cell"));
  }
}

TEST_F(WorldObstacles, AMeshFileIsRefusedWithItsPlaceAndLine) {
  EXPECT_EQ(OfMesh("good.obj", Obj({"1 3 2", "1 2 4", "2 3 4", "1 4 3"})), "accepted");
  EXPECT_THAT(OfMesh("open.obj", Obj({"1 3 2", "1 2 4", "2 3 4"})),
              AllOf(HasSubstr("world.yaml:3: obstacles.meshes[0]: "), HasSubstr("open.obj"),
                    HasSubstr("the surface is open"), HasSubstr("(9, 9, 0)")));
  EXPECT_THAT(OfMesh("flat.obj", Obj({"1 3 2", "1 2 4", "2 3 4", "1 4 3", "1 2 2"})),
              HasSubstr("no area"));
  EXPECT_THAT(OfMesh("words.obj", "no mesh\n"), HasSubstr("words.obj"));
  EXPECT_THAT(OfMesh("words.xyz", "no mesh\n"), HasSubstr("words.xyz"));
  EXPECT_THAT(Refusal("obstacles:\n  meshes:\n    - {file: nowhere.obj}\n"),
              AllOf(HasSubstr("world.yaml:3"), HasSubstr("nowhere.obj"), HasSubstr("cannot be read")));
  EXPECT_THAT(OfMesh("index.ply",
                     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                     "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                     "end_header\n9 9 0\n10 9 0\n9 10 0\n9 9 1\n4 1 2 3 70000000\n"),
              HasSubstr("index.ply"));
  EXPECT_THAT(
      Refusal("obstacles:\n  meshes:\n    - {file: " +
              Write("far.obj", Obj({"1 3 2", "1 2 4", "2 3 4", "1 4 3"})) + ", scale: 500000}\n"),
      AllOf(HasSubstr("world.yaml:3: obstacles.meshes[0]"), HasSubstr("coordinate"),
            HasSubstr("[0, 100000]: subtract an origin near the flight")));
  EXPECT_THAT(OfMesh("nan.stl",
                     "solid s\nfacet normal 0 0 1\nouter loop\nvertex 9 9 0\nvertex nan 9 0\n"
                     "vertex 9 10 0\nendloop\nendfacet\nendsolid s\n"),
              HasSubstr("nan.stl"));
}

TEST_F(WorldObstacles, OtherFilesAreRefusedToo) {
  const auto heights = [&](const std::string& file, const std::string& more) {
    return Refusal("obstacles:\n  height_fields:\n    - {file: " + file + ", size: [9, 9]" + more +
                   ", at: [-30, 0, 0]}\n");
  };
  const std::string hills = std::string(kWorlds) + "hills.png";
  EXPECT_EQ(heights(hills, ", height: 2"), "accepted");
  EXPECT_THAT(heights(hills, ""), AllOf(HasSubstr("world.yaml:3"), HasSubstr("lacks the key height")));
  EXPECT_THAT(heights(Write("no.png", "no picture"), ", height: 2"), HasSubstr("no sound PNG"));
  std::ifstream in(hills, std::ios::binary);
  std::stringstream whole;
  whole << in.rdbuf();
  EXPECT_THAT(heights(Write("half.png", whole.str().substr(0, 9000)), ", height: 2"),
              HasSubstr("half.png"));
  // 1025 x 4, cut short behind the head: the size is refused before anything is decoded.
  std::string wide = whole.str();
  wide.replace(16, 17, std::string("\0\0\4\1\0\0\0\4\x08\0\0\0\0\xda\x6a\x79\x64", 17));
  EXPECT_THAT(heights(Write("wide.png", wide), ", height: 2"), HasSubstr("at most 1024 x 1024"));
  EXPECT_THAT(heights("/dev/zero", ", height: 2"), HasSubstr("/dev/zero: "));
  EXPECT_THAT(
      heights(std::string(TOUCHDOWN_SOURCE_DIR) + "/docs/notebooks/05_profile_latency_13_2.png",
              ", height: 2"),
      HasSubstr("no grey PNG"));
  EXPECT_THAT(Refusal("obstacles: {octomaps: [{file: " + Write("no.bt", "no map") + "}]}\n"),
              HasSubstr("no.bt"));
  for (const char* res : {"-0.1", "0", "nan", "1e-12"}) {
    const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 1\nres ";
    EXPECT_THAT(Refusal("obstacles: {octomaps: [{file: " +
                        Write("res.bt", head + res + "\ndata\n" + std::string(2, '\1')) + "}]}\n"),
                HasSubstr("res.bt"));
  }
  EXPECT_THAT(Refusal("obstacles:\n  boxes:\n    - {centre: [9, 9], size: [100, 1.0e-8, 1], turn_deg: [1, 0, 0]}\n"),
              AllOf(HasSubstr("world.yaml:3: obstacles.boxes[0]"), HasSubstr("no area")));
  EXPECT_THAT(Refusal("obstacles: {walls: [{points: [1, 2, 3]}]}\n"),
              HasSubstr("a flat list x, y, x, y, ... of two points or more"));
}

TEST_F(WorldObstacles, WhatStandsOnTheStartOrInThePadsWayIsRefused) {
  EXPECT_THAT(Refusal("obstacles: {spheres: [{centre: [0.2, 0, 2.5], radius: 0.3}]}\n"),
              HasSubstr("obstacles.spheres[0] stands on the start"));
  EXPECT_THAT(Refusal("obstacles: {boxes: [{centre: [10, 7], size: [1, 1, 4], turn_deg: [10, 0, 0]}]}\n"),
              HasSubstr("obstacles.boxes[0] stands on the pad's way"));
  EXPECT_THAT(Refusal("obstacles: {height_fields: [{file: " + std::string(kWorlds) +
                      "hills.png, size: [30, 30], height: 3}]}\n"),
              HasSubstr("obstacles.height_fields[0] stands on the"));
}

// A diagonal wall does not block the rectangle about it.
TEST_F(WorldObstacles, ATurnedBoxIsWhereItIs) {
  const sim::Obstacle wall = ObstaclesOf(Load("obstacles: {walls: [{points: [10, -13, 24, 1]}]}\n")).front().obstacle;
  const auto gap = [&](double x, double y, double spread) {
    return HorizontalGap(wall, {x, y}, {spread, spread}, 0.0, 2.0, 1.0);
  };
  EXPECT_NEAR(gap(20.0, -12.0, 0.0), 9.0 * std::sqrt(0.5) - 0.1, 1e-9);  // less half the thickness
  EXPECT_NEAR(gap(20.0, -12.0, 1.0), 7.0 * std::sqrt(0.5) - 0.1, 1e-9);
  EXPECT_EQ(gap(17.0, -6.0, 0.0), 0.0);
  const sim::Obstacle ball = sim::Sphere{{0.0, 0.0, 2.0}, 1.0};
  EXPECT_NEAR(HorizontalGap(ball, {3.0, 0.0}, {0.0, 0.0}, 0.0, 1.4, 1.0), 3.0 - 0.8, 1e-12);
}

// The hash tells whether a file is unchanged. A changed file is read anew.
TEST_F(WorldObstacles, AChangedFileIsAnotherWorld) {
  const std::string text = "obstacles: {meshes: [{file: " +
                           Write("one.obj", Obj({"1 3 2", "1 2 4", "2 3 4", "1 4 3"})) + "}]}\n";
  const Scenario scenario = Load(text);
  const std::string before = WorldHash(scenario);
  EXPECT_EQ(WorldHash(Load("seed: 1\n")), "none");
  Write("one.obj", "v 9 9 5\n" + Obj({"1 3 2", "1 2 4", "2 3 4", "1 4 3"}));
  EXPECT_NE(WorldHash(scenario), before);
  const auto& mesh = std::get<sim::Mesh>(ObstaclesOf(scenario).front().obstacle);
  EXPECT_EQ(mesh.surface->bounds().max.z(), 5.0);
}

Scenario Example(const std::string& name, const std::string& file) {
  std::ifstream in(kWorlds + name + ".yaml");
  std::stringstream whole;
  whole << in.rdbuf();
  std::string text = whole.str();
  const std::string path = "docs/examples/worlds/" + file;
  text.replace(text.find(path), path.size(), kWorlds + file);
  return ParseScenario(text, name, name + ".yaml", {}, StandardRegistries());
}

TEST_F(WorldObstacles, TheExamplesAreLandedIn) {
  for (const auto& [name, file] : {std::pair{"building", "building.bt"},
                                   {"courtyard", "courtyard.obj"},
                                   {"hills", "hills.png"}}) {
    const Scenario scenario = Example(name, file);
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, 2, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kLanded) << name << ": " << result.detail;
    EXPECT_GT(*result.min_clearance_m, 0.1) << name;
    ASSERT_TRUE(result.safety);
    EXPECT_EQ(result.safety->uncertified_steps, 0) << name;
    const std::string path = folder_ + name + ".db";
    WriteRecord(path, scenario, result, record);
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    SqliteStatement meshes = db.Prepare("SELECT count(*) FROM obstacle WHERE kind = 'mesh'");
    SqliteStatement surfaces = db.Prepare(
        "SELECT count(*) FROM surface WHERE length(corners) >= 48 AND length(triangles) >= 48");
    ASSERT_TRUE(meshes.Step() && surfaces.Step());
    EXPECT_EQ(surfaces.Integer(0), meshes.Integer(0)) << name;
    EXPECT_EQ(meshes.Integer(0) > 0, std::string(name) != "building");
  }
}

}  // namespace
}  // namespace touchdown::evaluation
