// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/true_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/obstacles/forest.h"
#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

using estimation::VehicleState;

estimation::VehicleModel Model() { return LoadVehicleModel(DefaultVehicleMjcf()); }

VehicleState At(const Eigen::Vector3d& p_WB) {
  VehicleState vehicle;
  vehicle.p_WB = p_WB;
  return vehicle;
}

TEST(TrueClearance, LevelDistancesByHand) {
  const ObstacleField field(
      {Box{{3.0, 0.0, 1.0}, {0.5, 2.0, 1.0}, 0.0}, Cylinder{{-2.0, 0.0, 2.0}, 0.4, 4.0}});
  const TrueClearance clearance(field, Model());
  const Clearance box = clearance.Nearest(At({1.5, 0.0, 1.0}));
  EXPECT_NEAR(box.distance, 1.0 - 0.30, 1e-8);
  EXPECT_EQ(box.obstacle, 0);
  const Clearance cylinder = clearance.Nearest(At({-0.5, 0.0, 1.0}));
  EXPECT_NEAR(cylinder.distance, 1.5 - 0.4 - 0.30, 1e-8);
  EXPECT_EQ(cylinder.obstacle, 1);
  // Above the box: from the soles of the feet.
  EXPECT_NEAR(clearance.Distance(At({3.0, 0.0, 2.5})), 0.5 - 0.12, 1e-8);
  // Below a slab: from the hull's top.
  const TrueClearance below(ObstacleField({Box{{0, 0, 3.0}, {2.0, 2.0, 0.5}, 0.0}}), Model());
  EXPECT_NEAR(below.Distance(At({0.0, 0.0, 2.0})), 0.5 - 0.08, 1e-8);
}

TEST(TrueClearance, TiltedByHand) {
  const TrueClearance clearance(ObstacleField({Box{{0, 0, -0.5}, {5.0, 5.0, 0.5}, 0.0}}), Model());
  for (const double tilt : {0.1, 0.3, 0.6}) {
    VehicleState vehicle = At({0.0, 0.0, 1.0});
    vehicle.q_WB = Eigen::AngleAxisd(tilt, Eigen::Vector3d(0.6, 0.8, 0.0));
    const double depth = 0.12 * std::cos(tilt) + 0.30 * std::sin(tilt);
    EXPECT_NEAR(clearance.Distance(vehicle), 1.0 - depth, 1e-8) << tilt;
  }
}

// The distance to the cylinder's surface is bounded from both sides by samples of the signed
// distance over it. No sample is nearer than FCL says, and some sample is nearly as near.
TEST(TrueClearance, AgreesWithAnalyticDistancesOnRandomScenes) {
  RandomStream random(23, "clearance scenes");
  const estimation::VehicleModel model = Model();
  int apart = 0;
  int collided = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const ObstacleField field = test::RandomField(10, 5.0, &random);
    const TrueClearance clearance(field, model);
    for (int pose = 0; pose < 10; ++pose) {
      VehicleState vehicle = At(test::RandomPoint({-5, -5, 0.5}, {5, 5, 4}, &random));
      vehicle.q_WB = test::RandomAttitude(0.6, &random);
      double nearest = std::numeric_limits<double>::infinity();
      const auto sample = [&](double radius, double angle, double z) {
        const Eigen::Vector3d p_B(radius * std::cos(angle), radius * std::sin(angle), z);
        nearest = std::min(nearest, field.SignedDistance(vehicle.p_WB + vehicle.q_WB * p_B));
      };
      for (int i = 0; i < 90; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 90.0;
        for (int k = 0; k <= 6; ++k) {
          sample(model.hull_radius, angle, -model.foot_depth + k / 6.0 * 0.20);
          sample(model.hull_radius * k / 6.0, angle, -model.foot_depth);
          sample(model.hull_radius * k / 6.0, angle, model.hull_top);
        }
      }
      const Clearance found = clearance.Nearest(vehicle);
      ASSERT_GE(found.obstacle, 0);
      if (found.distance > 0.0) {
        ++apart;
        EXPECT_GE(nearest, found.distance - 1e-8);
        EXPECT_LE(nearest, found.distance + 0.03);  // the samples' spacing
      } else {
        ++collided;
        // An obstacle thinner than the spacing may slip between the samples.
        EXPECT_LE(nearest, 0.03);
      }
      if (nearest < -1e-3) {
        EXPECT_LT(found.distance, 0.0);
      }
    }
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(collided, 50);
}

// Columns and rings are many shapes each. For a vehicle as small as a point the distance is that of the field.
TEST(TrueClearance, ColumnsAndRingsAreExact) {
  RandomStream random(29, "forest points");
  ForestConfig forest = ForestOfKind("A");
  const ObstacleField field = MakeForest(forest, 3);
  estimation::VehicleModel point = Model();
  point.hull_radius = point.hull_top = point.foot_depth = 1e-5;
  const TrueClearance clearance(field, point);
  int near = 0;
  for (int i = 0; i < 3000; ++i) {
    const VehicleState vehicle = At(test::RandomPoint({-18, -18, 0.1}, {18, 18, 2.9}, &random));
    const double wanted = field.SignedDistance(vehicle.p_WB);
    if (wanted < 1e-3) continue;
    near += wanted < 0.3;
    const Clearance found = clearance.Nearest(vehicle);
    EXPECT_NEAR(found.distance, wanted, 3e-5);
    const Obstacle& nearest = field.obstacles()[static_cast<std::size_t>(found.obstacle)];
    EXPECT_NEAR(SignedDistance(nearest, vehicle.p_WB), wanted, 3e-5);
  }
  EXPECT_GT(near, 300);
}

TEST(TrueClearance, PenetrationIsNegativeAndDeepens) {
  const TrueClearance clearance(ObstacleField({Box{{3.0, 0.0, 1.0}, {1.0, 3.0, 3.0}, 0.0}}),
                                Model());
  EXPECT_NEAR(clearance.Distance(At({1.8, 0.0, 1.0})), -0.10, 1e-3);
  EXPECT_NEAR(clearance.Distance(At({1.9, 0.0, 1.0})), -0.20, 1e-3);
  EXPECT_NEAR(clearance.Distance(At({1.699, 0.0, 1.0})), 0.001, 1e-8);
}

TEST(TrueClearance, NoObstacleIsInfinitelyFar) {
  const Clearance none = TrueClearance({}, Model()).Nearest(At({0.0, 0.0, 1.0}));
  EXPECT_EQ(none.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(none.obstacle, -1);
}

TEST(TrueClearance, RefusesPosesFclWouldAbortOn) {
  const TrueClearance clearance(ObstacleField({Box{}}), Model());
  VehicleState vehicle = At({std::nan(""), 0.0, 1.0});
  EXPECT_THROW(clearance.Distance(vehicle), std::invalid_argument);
  vehicle = At({0.0, 0.0, 1.0});
  vehicle.q_WB.coeffs().setZero();
  EXPECT_THROW(clearance.Distance(vehicle), std::invalid_argument);
  estimation::VehicleModel flat = Model();
  flat.hull_radius = 0.0;
  EXPECT_THROW(TrueClearance({}, flat), std::invalid_argument);
}

// Of a flight past obstacles, and through one.
TEST(LeastClearance, IsTheLeastOfAllPoses) {
  RandomStream random(8, "least clearance");
  for (int flight = 0; flight < 20; ++flight) {
    const ObstacleField field = test::RandomField(12, 5.0, &random);
    const TrueClearance clearance(field, Model());
    LeastClearance least(field, Model());
    EXPECT_EQ(least.Least(), std::numeric_limits<double>::infinity());
    estimation::VehicleState state;
    state.p_WB = test::RandomPoint({-6, -6, 1}, {6, 6, 4}, &random);
    const Eigen::Vector3d v_W = test::RandomPoint({-2, -2, -0.3}, {2, 2, 0.3}, &random);
    const Eigen::Vector3d w_B = test::RandomPoint({-1, -1, -1}, {1, 1, 1}, &random);
    double expected = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 1000; ++i) {
      state.p_WB += 0.004 * v_W;
      state.q_WB = state.q_WB * Eigen::Quaterniond(Eigen::AngleAxisd(0.004 * w_B.norm(), w_B.normalized()));
      state.q_WB.normalize();
      least.Add(state);
      expected = std::min(expected, clearance.Distance(state));
    }
    EXPECT_EQ(least.Least(), expected) << flight;
  }
}

}  // namespace
}  // namespace touchdown::sim
