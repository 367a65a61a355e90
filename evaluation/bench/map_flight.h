// SPDX-License-Identifier: BSD-3-Clause
// One set of depth frames for the planner's rolling map and for OctoMap, under equal conditions.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <octomap/octomap.h>

#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/forest.h"
#include "sim/sensors/depth_camera.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::evaluation {

/// A world and the way flown through it.
struct MapFlight {
  std::string name;
  sim::ObstacleField obstacles;
  std::vector<Eigen::Vector3d> way;  ///< corners, in W [m]
};

/// Case 1 of the paper: from the start through a passage into the street.
inline MapFlight StraightTurnFlight() {
  const Scenario scenario = LoadScenario(FindScenario("straight_turn"), {}, StandardRegistries());
  std::vector<sim::Obstacle> obstacles;
  for (const NamedObstacle& named : ObstaclesOf(scenario)) obstacles.push_back(named.obstacle);
  return {"straight_turn",
          sim::ObstacleField(std::move(obstacles)),
          {{0.0, 0.0, 2.5}, {5.4, 1.0, 2.5}, {5.4, 4.0, 2.0}, {8.0, 6.5, 2.0}}};
}

/// Scene kind B, 200 round pillars, with a lane that is kept free of them.
inline MapFlight ForestFlight() {
  sim::ForestConfig config = sim::ForestOfKind("B");
  config.shape = sim::PillarShape::kCylinder;  // the depth camera takes no voxel columns
  for (double x = -6.0; x <= 6.0; x += 0.5) config.keep_out.push_back({{x, 0.0}, 1.0});
  return {"forest_B", sim::MakeForest(config, 1), {{-5.0, 0.0, 1.5}, {5.0, 0.0, 1.5}}};
}

/// What a level camera sees that flies the way at 1.5 m/s and takes `rate` images a second [Hz].
/// The map's frame is off the world's by some centimetres. Without that, surfaces of both worlds
/// lie exactly between cells, and rounding alone decides in which cell a return ends.
inline std::vector<estimation::DepthFrame> DepthFrames(const MapFlight& flight, int width,
                                                       int height, double rate) {
  sim::DepthCameraConfig config;
  config.width = width;
  config.height = height;
  sim::DepthCamera camera(config, flight.obstacles, sim::PadGeometry{}, 1);
  estimation::PadState pad;
  pad.p_WP << 7.0, 6.5, 0.5;
  std::vector<estimation::DepthFrame> frames;
  for (std::size_t leg = 0; leg + 1 < flight.way.size(); ++leg) {
    const Eigen::Vector3d along = flight.way[leg + 1] - flight.way[leg];
    const int count = static_cast<int>(along.norm() / 1.5 * rate);
    for (int i = 0; i < count; ++i) {
      estimation::VehicleState vehicle;
      vehicle.p_WB = flight.way[leg] + along * i / count;
      vehicle.q_WB = Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ());
      frames.emplace_back();
      camera.Capture(vehicle, pad, &frames.back());
      frames.back().p_WC += Eigen::Vector3d(0.031, 0.047, 0.053);
    }
  }
  return frames;
}

/// The rolling map's options, without what OctoMap does not have: ground, a least range, and a
/// window that ends before the rays do.
inline planning::OccupancyMapOptions EqualOptions() {
  planning::OccupancyMapOptions options;
  options.size_log2 = {8, 8, 8};
  options.ground_height = -1e9;
  options.min_ray = 0.0;
  return options;
}

inline octomap::OcTree EqualTree(const planning::OccupancyMapOptions& options) {
  octomap::OcTree tree(options.resolution);
  tree.setProbHit(options.probability_hit);
  tree.setProbMiss(options.probability_miss);
  tree.setClampingThresMin(options.probability_min);
  tree.setClampingThresMax(options.probability_max);
  tree.setOccupancyThres(options.probability_occupied);
  return tree;
}

/// The frame as points in W. A pixel without a return is a point beyond the largest range. OctoMap
/// then clears the ray up to that range, as the rolling map does.
inline octomap::Pointcloud CloudOf(const estimation::DepthFrame& frame) {
  octomap::Pointcloud cloud;
  const estimation::CameraIntrinsics& k = frame.intrinsics;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const float depth = frame.depth[static_cast<std::size_t>(v * k.width + u)];
      const Eigen::Vector3d ray_C((u + 0.5 - k.cx) / k.focal, (v + 0.5 - k.cy) / k.focal, 1.0);
      const double along = std::isfinite(depth) ? depth : 2.0 * frame.max_range;
      const Eigen::Vector3f p = (frame.p_WC + frame.R_WC * ray_C * along).cast<float>();
      cloud.push_back(p.x(), p.y(), p.z());
    }
  }
  return cloud;
}

inline octomap::point3d OriginOf(const estimation::DepthFrame& frame) {
  const Eigen::Vector3f p = frame.p_WC.cast<float>();
  return {p.x(), p.y(), p.z()};
}

/// How two maps agree on the cells that either of them observed.
struct Agreement {
  int observed = 0;
  int equal = 0;  ///< observed by both, and both occupied or both free
  double share() const { return static_cast<double>(equal) / observed; }
};

inline Agreement Compare(const planning::OccupancyMap& map, const octomap::OcTree& tree) {
  Agreement agreement;
  planning::ForEachCell(
      {map.origin(), map.origin() + map.size()}, [&](const planning::CellIndex& cell) {
        const Eigen::Vector3d p = map.CentreOf(cell);
        const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
        const bool known = map.IsKnown(cell);
        if (!known && node == nullptr) return;
        ++agreement.observed;
        agreement.equal +=
            known && node != nullptr && map.IsOccupied(cell) == tree.isNodeOccupied(node);
      });
  return agreement;
}

}  // namespace touchdown::evaluation
