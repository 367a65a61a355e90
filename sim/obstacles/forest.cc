// SPDX-License-Identifier: BSD-3-Clause
// Pillars by dart throwing: centres are uniform. A centre too near to an earlier pillar or to a
// keep-out is drawn again. Scene kinds after the published measurements of EGO-Planner (Zhou et al.
// 2020) in the random forests of its simulator.

#include "sim/obstacles/forest.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "estimation/base/argument_check.h"
#include "sim/base/random_stream.h"

namespace touchdown::sim {
namespace {

constexpr double kGreatestDensity = 0.5;  // [1/m^2]
constexpr int kDrawsPerObstacle = 2000;   // then it counts as "does not fit"

struct Range {
  double low;
  double high;
};
constexpr Range kPillarWidth{0.5, 0.7};      // [m]
constexpr Range kPillarScale{0.5, 1.5};      // of the width
constexpr Range kRingHeight{0.7, 0.8};       // of the centre [m]
constexpr Range kRingYaw{-0.5, 0.5};         // [rad]
constexpr Range kRingWidth{0.5, 0.7};        // half axis [m]
constexpr Range kRingUpright{0.7, 1.2};      // half axis [m]
constexpr Range kWallLength{4.0, 8.0};       // gap included [m]
constexpr Range kWallGap{1.4, 2.2};          // [m]
constexpr Range kWallGapShift{-0.25, 0.25};  // of the gap's centre, in wall lengths
constexpr double kWallThickness = 0.3;       // [m]

double Draw(const Range& range, RandomStream* stream) {
  return stream->Uniform(range.low, range.high);
}

void Check(const ForestConfig& config) {
  estimation::CheckWithin("forest: size.x [m]", config.size.x(), 4.0, 1000.0);
  estimation::CheckWithin("forest: size.y [m]", config.size.y(), 4.0, 1000.0);
  estimation::CheckAbove("forest: height [m]", config.height, 0.0, 100.0);
  estimation::CheckWithin("forest: cell [m]", config.cell, 0.01, 1.0);
  estimation::CheckWithin("forest: pillars", config.pillars, 0.0,
                          kGreatestDensity * config.size.prod());
  estimation::CheckWithin("forest: spacing [m]", config.spacing, 0.0, 10.0);
  estimation::CheckWithin("forest: rings", config.rings, 0.0, config.size.prod());
  estimation::CheckWithin("forest: walls", config.walls, 0.0, config.size.prod());
  for (const KeepOut& keep : config.keep_out) {
    estimation::CheckWithin("forest: keep_out radius [m]", keep.radius, 0.0, 1000.0);
    estimation::CheckWithin("forest: |keep_out center| [m]", keep.center.norm(), 0.0, 1.0e4);
  }
}

Eigen::Vector2d DrawInside(const ForestConfig& config, RandomStream* stream) {
  const double x = stream->Uniform(-0.5, 0.5) * config.size.x();
  const double y = stream->Uniform(-0.5, 0.5) * config.size.y();
  return {x, y};
}

/// The middle of the cell that holds p.
Eigen::Vector2d Snap(const Eigen::Vector2d& p, double cell) {
  return ((p / cell).array().floor() + 0.5) * cell;
}

std::vector<Eigen::Vector2d> DrawCenters(const ForestConfig& config, std::uint64_t seed) {
  RandomStream stream(seed, "forest pillars");
  std::vector<Eigen::Vector2d> centers;
  for (int draws = 0; static_cast<int>(centers.size()) < config.pillars; ++draws) {
    if (draws == kDrawsPerObstacle * config.pillars) {
      estimation::ThrowOutOfRange("forest: pillars", config.pillars,
                                  "what fits: fewer, or at a smaller spacing");
    }
    const Eigen::Vector2d p = DrawInside(config, &stream);
    const bool crowded = std::any_of(centers.begin(), centers.end(), [&](const auto& other) {
      return (p - other).norm() < config.spacing;
    });
    const bool kept_out =
        std::any_of(config.keep_out.begin(), config.keep_out.end(),
                    [&](const KeepOut& keep) { return (p - keep.center).norm() < keep.radius; });
    if (!crowded && !kept_out) centers.push_back(p);
  }
  return centers;
}

/// The columns whose axes lie within `radius` of the centre, which is the middle of a cell.
VoxelColumns Disc(const Eigen::Vector2d& center, double radius, const ForestConfig& config,
                  RandomStream* heights) {
  const int reach = static_cast<int>(std::floor(radius / config.cell));
  VoxelColumns pillar;
  pillar.cell = config.cell;
  pillar.count_x = pillar.count_y = 2 * reach + 1;
  const double half = (reach + 0.5) * config.cell;
  pillar.corner = {center.x() - half, center.y() - half, 0.0};
  pillar.heights.clear();
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const bool inside = std::hypot(x, y) * config.cell <= radius;
      double height = inside ? config.height : 0.0;
      if (inside && config.shape == PillarShape::kRagged) {
        height = heights->Uniform(0.0, config.height);
      }
      pillar.heights.push_back(height);
    }
  }
  return pillar;
}

void AddPillars(const ForestConfig& config, std::uint64_t seed, std::vector<Obstacle>* obstacles) {
  RandomStream sizes(seed, "forest pillar sizes");
  RandomStream heights(seed, "forest column heights");
  for (const Eigen::Vector2d& drawn : DrawCenters(config, seed)) {
    const Eigen::Vector2d center = Snap(drawn, config.cell);
    const double width = Draw(kPillarWidth, &sizes);
    const double radius = 0.5 * width * Draw(kPillarScale, &sizes);
    if (config.shape == PillarShape::kCylinder) {
      obstacles->push_back(
          Cylinder{{center.x(), center.y(), 0.5 * config.height}, radius, config.height});
    } else {
      obstacles->push_back(Disc(center, radius, config, &heights));
    }
  }
}

void AddRings(const ForestConfig& config, std::uint64_t seed, std::vector<Obstacle>* obstacles) {
  RandomStream stream(seed, "forest rings");
  for (int i = 0; i < config.rings; ++i) {
    const Eigen::Vector2d center = Snap(DrawInside(config, &stream), config.cell);
    Ring ring;
    ring.center = {center.x(), center.y(), Draw(kRingHeight, &stream)};
    ring.yaw = Draw(kRingYaw, &stream);
    ring.half_width = Draw(kRingWidth, &stream);
    ring.half_height = Draw(kRingUpright, &stream);
    // The published scenes mark the cells that the hoop's curve passes: a hair instead of a tube.
    ring.tube_radius = 0.01 * config.cell;
    obstacles->push_back(ring);
  }
}

bool Reaches(const Obstacle& wall, const std::vector<KeepOut>& keep_out) {
  const double height = 0.5 * (BoundsOf(wall).min.z() + BoundsOf(wall).max.z());
  return std::any_of(keep_out.begin(), keep_out.end(), [&](const KeepOut& keep) {
    return SignedDistance(wall, {keep.center.x(), keep.center.y(), height}) < keep.radius;
  });
}

void AddWalls(const ForestConfig& config, std::uint64_t seed, std::vector<Obstacle>* obstacles) {
  RandomStream stream(seed, "forest walls");
  int standing = 0;
  for (int draws = 0; standing < config.walls; ++draws) {
    if (draws == kDrawsPerObstacle * config.walls) {
      estimation::ThrowOutOfRange("forest: walls", config.walls,
                                  "what fits around the keep-outs: fewer");
    }
    const Eigen::Vector2d middle = DrawInside(config, &stream);
    const double yaw = stream.Uniform(0.0, std::numbers::pi);
    const double length = Draw(kWallLength, &stream);
    const double gap = Draw(kWallGap, &stream);
    const double shift = length * Draw(kWallGapShift, &stream);
    const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw));
    const auto piece = [&](double from, double to) {
      const Eigen::Vector2d center = middle + 0.5 * (from + to) * along;
      return Box{{center.x(), center.y(), 0.5 * config.height},
                 {0.5 * (to - from), 0.5 * kWallThickness, 0.5 * config.height},
                 yaw};
    };
    const Box left = piece(-0.5 * length, shift - 0.5 * gap);
    const Box right = piece(shift + 0.5 * gap, 0.5 * length);
    // A wall with a keep-out in its gap would be fine, but would make the scene's goal special.
    const Box whole = piece(-0.5 * length, 0.5 * length);
    if (left.half_extents.x() <= 0.0 || right.half_extents.x() <= 0.0) continue;
    if (Reaches(whole, config.keep_out)) continue;
    obstacles->push_back(left);
    obstacles->push_back(right);
    ++standing;
  }
}

}  // namespace

const std::vector<std::string>& ForestKinds() {
  static const std::vector<std::string> kinds = {"A", "B", "C", "D", "walls", "dense"};
  return kinds;
}

ForestConfig ForestOfKind(const std::string& kind) {
  ForestConfig config;
  if (kind == "A") {
    config.shape = PillarShape::kRagged;
    config.rings = 200;
  } else if (kind == "C") {
    config.pillars = 400;
  } else if (kind == "walls") {
    config.pillars = 0;
    config.walls = 60;
  } else if (kind == "dense") {
    SetDensity(kGreatestDensity, &config);
  } else if (kind != "B" && kind != "D") {
    std::string known;
    for (const std::string& name : ForestKinds()) known += (known.empty() ? "" : ", ") + name;
    throw std::invalid_argument("forest kind " + kind + " is unknown; known: " + known);
  }
  return config;
}

void SetDensity(double density, ForestConfig* config) {
  estimation::CheckWithin("forest: density [1/m^2]", density, 0.0, kGreatestDensity);
  constexpr double kSpacing = 1.2;  // [m]
  config->pillars = static_cast<int>(std::lround(density * config->size.prod()));
  config->spacing = density > 0.0 ? std::min(kSpacing, 0.64 / std::sqrt(density)) : kSpacing;
}

ObstacleField MakeForest(const ForestConfig& config, std::uint64_t seed) {
  Check(config);
  std::vector<Obstacle> obstacles;
  AddPillars(config, seed, &obstacles);
  AddRings(config, seed, &obstacles);
  AddWalls(config, seed, &obstacles);
  return ObstacleField(std::move(obstacles));
}

}  // namespace touchdown::sim
