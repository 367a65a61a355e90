// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_shapes.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

constexpr char kHead[] = R"(<mujoco><asset>
  <mesh name="cube" vertex="0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1"/></asset>
  <worldbody><geom name="floor" type="plane" size="1 1 1"/><body name="vehicle"><freejoint/>
  <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
  <geom name="hull" type="cylinder" size="0.3 0.05"/>
  <geom name="foot0" type="sphere" size="0.02" pos="0.1 0.2 -0.3"/>
  <geom name="unseen" type="box" size="1 1 1" rgba="1 0 0 0"/>)";

std::string With(const std::string& geom) {
  return std::string(kHead).append(geom).append("</body></worldbody></mujoco>");
}

TEST(VehicleShapes, TheDefaultVehicleHasItsBodyArmsLegsAndFeetButNotItsHull) {
  const std::vector<VehicleShape> shapes = VehicleShapes(DefaultVehicleMjcf());
  const auto count = [&](VehicleShape::Kind kind) {
    return std::count_if(shapes.begin(), shapes.end(),
                         [&](const VehicleShape& shape) { return shape.kind == kind; });
  };
  EXPECT_EQ(count(VehicleShape::Kind::kBox), 1);
  EXPECT_EQ(count(VehicleShape::Kind::kCapsule), 6);
  EXPECT_EQ(count(VehicleShape::Kind::kSphere), 4);
  EXPECT_EQ(count(VehicleShape::Kind::kCylinder), 0);
}

TEST(VehicleShapes, WhatHasNothingForTheEyeHasArmsToItsFeetAndRotors) {
  const std::vector<VehicleShape> shapes = VehicleShapes(
      With(R"(<site name="rotor0" pos="0.3 0 0.4"/><site name="else" pos="1 1 1"/>)"));
  ASSERT_EQ(shapes.size(), 3U);
  const Eigen::Vector3d foot(0.1, 0.2, -0.3), rotor(0.3, 0.0, 0.4);
  EXPECT_TRUE(shapes[0].p_BG.isApprox(foot));
  for (const auto& [arm, end] : {std::pair{shapes[1], foot}, std::pair{shapes[2], rotor}}) {
    EXPECT_EQ(arm.kind, VehicleShape::Kind::kCapsule);
    const Eigen::Vector3d half = arm.q_BG * Eigen::Vector3d(0.0, 0.0, arm.size.y());
    EXPECT_TRUE((arm.p_BG + half).isApprox(end));
    EXPECT_LT((arm.p_BG - half).norm(), 1e-12);
  }
}

TEST(VehicleShapes, ARotorInTheMiddleHasNoArm) {
  const std::vector<VehicleShape> shapes =
      VehicleShapes(With(R"(<site name="rotor0" pos="0 0 0"/>)"));
  EXPECT_EQ(shapes.size(), 2U);  // a foot, and the arm to it
  for (const VehicleShape& shape : shapes) EXPECT_GT(shape.size.x(), 0.0);
}

TEST(VehicleShapes, AMeshHasItsOwnTrianglesWhereItsGeomStands) {
  const std::vector<VehicleShape> shapes =
      VehicleShapes(With(R"(<geom type="mesh" mesh="cube" pos="1 2 3"/>)"));
  ASSERT_EQ(shapes.size(), 2U);
  const VehicleShape& cube = shapes[1];
  ASSERT_EQ(cube.kind, VehicleShape::Kind::kMesh);
  EXPECT_EQ(cube.triangles.size(), 12U);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (const Eigen::Vector3i& triangle : cube.triangles) {
    for (const int corner : triangle) {
      const Eigen::Vector3d p =
          cube.p_BG + cube.q_BG * cube.corners.at(static_cast<std::size_t>(corner));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  EXPECT_TRUE(low.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-5)) << low.transpose();
  EXPECT_TRUE(high.isApprox(Eigen::Vector3d(2.0, 3.0, 4.0), 1e-5)) << high.transpose();
}

TEST(VehicleShapes, WhatIsNoVehicleIsRefused) {
  EXPECT_THROW(VehicleShapes("<mujoco/>"), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
