// SPDX-License-Identifier: BSD-3-Clause
// The forests are those of forest_scene.h, as for replan_scene.h. Map and ends are the published planner's own where
// they differ from this project's:
// - Cubes, not balls, are inflated around obstacle cells.
// - Everything farther than 12 m from the start is unknown.
// - The end is on its straight global reference, and is not moved out of an obstacle.
// No ring stands within 2 m of the start, as no pillar does. This is inferred: else one start in fifty would lie in a
// ring's reach and fail at once, which none of the measured ones did.
#include "evaluation/studies/fidelity/ego_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "planning/baselines/ego/ego_plan.h"
#include "planning/baselines/ego/ego_reference.h"

namespace touchdown::evaluation {
namespace {

using planning::EgoStatus;

constexpr double kKnownRadius = 12.0;  // [m]
constexpr double kRingKeepOut = 2.0;   // of rings around the start [m]
constexpr double kMapSide = 40.0;      // [m]
constexpr double kCell = 0.1;          // [m]
constexpr double kGround = -0.01;      // lowest corner of the map [m]
constexpr double kSample = 0.01;       // of a curve's figures [s]

/// Occupies the cells of the obstacles that are known at the start `centre`.
void Fill(const sim::ObstacleField& field, const Eigen::Vector2d& centre,
          planning::CubeGrid* grid) {
  const auto known = [&](const Eigen::Vector3d& p) {
    return (p.head<2>() - centre).norm() <= kKnownRadius;
  };
  for (const sim::Obstacle& obstacle : field.obstacles()) {
    if (const auto* columns = std::get_if<sim::VoxelColumns>(&obstacle)) {
      for (int k = 0; k < columns->count_x * columns->count_y; ++k) {
        const int row = k / columns->count_x;
        Eigen::Vector3d p =
            columns->corner +
            columns->cell * Eigen::Vector3d(k % columns->count_x + 0.5, row + 0.5, 0.0);
        if (!known(p)) continue;
        for (p.z() = 0.5 * kCell; p.z() < columns->heights[k] + 0.5 * kCell; p.z() += kCell) {
          grid->SetOccupied(p);
        }
      }
    } else if (const auto* ring = std::get_if<sim::Ring>(&obstacle)) {
      if ((ring->center.head<2>() - centre).norm() < kRingKeepOut) continue;
      for (int i = 0; i < sim::Ring::kSides; ++i) {
        const Eigen::Vector3d a = ring->Corner(i), b = ring->Corner(i + 1);
        constexpr int kPoints = 8;  // a side is at most 0.2 m long
        for (int k = 0; k < kPoints; ++k) {
          const Eigen::Vector3d p = a + (b - a) * k / kPoints;
          if (known(p)) grid->SetOccupied(p);
        }
      }
    }
  }
}

planning::EgoOptions OptionsOf(const SceneKind& kind) {
  planning::EgoOptions options;
  options.max_speed = kind.limits.speed;
  options.max_acceleration = kind.limits.acceleration;
  return options;
}

struct EgoScene {
  planning::CubeGrid grid;
  planning::EgoEnds ends;
};

/// Empty where the start is occupied.
std::optional<EgoScene> Draw(const SceneOptions& options, int index, int draw) {
  sim::RandomStream stream = SceneStream(options, index, draw);
  const ForestScene forest = DrawForestScene(options, &stream);
  const Eigen::Vector3d corner(-0.5 * kMapSide, -0.5 * kMapSide, kGround);
  EgoScene scene{planning::CubeGrid(corner, {kMapSide, kMapSide, forest.height}, kCell,
                                    options.kind.inflation),
                 {}};
  Fill(forest.field, forest.start.p.head<2>(), &scene.grid);
  if (scene.grid.Occupied(forest.start.p)) return std::nullopt;
  const planning::EgoOptions ego = OptionsOf(options.kind);
  planning::EgoReference reference;
  reference.Set(forest.start.p, forest.start.v, forest.goal, Eigen::Vector3d::Zero(), ego);
  const planning::LocalTarget target = reference.Target(forest.start.p, ego);
  scene.ends = {forest.start, target.p, target.v};
  return scene;
}

EgoScene DrawFree(const SceneOptions& options, int index) {
  for (int draw = 0; draw < kForestSceneDraws; ++draw) {
    if (auto scene = Draw(options, index, draw)) return *std::move(scene);
  }
  throw std::runtime_error(
      fmt::format("ego scene {}: the start was blocked in {} draws", index, kForestSceneDraws));
}

void Measure(const planning::UniformBspline& curve, EgoSceneResult* result) {
  result->control_points = static_cast<int>(curve.control_points().cols());
  result->duration = curve.duration();
  result->jerk = curve.SquaredJerk();
  Eigen::Vector3d before = curve.Evaluate(curve.t0()).p_WB;
  result->length = result->max_speed = result->max_acceleration = 0.0;
  for (double t = 0.0; t <= curve.duration(); t += kSample) {
    const planning::FlatState state = curve.Evaluate(curve.t0() + t);
    result->length += (state.p_WB - before).norm();
    result->max_speed = std::max(result->max_speed, state.v_WB.norm());
    result->max_acceleration = std::max(result->max_acceleration, state.a_WB.norm());
    before = state.p_WB;
  }
}

}  // namespace

std::vector<EgoSceneResult> RunEgoScenes(const SceneKind& kind, int scenes, std::uint64_t seed,
                                         const std::function<void(int done, int all)>& report) {
  if (scenes < 1) {
    throw std::invalid_argument(fmt::format("RunEgoScenes: scenes is {}, it must be >= 1", scenes));
  }
  SceneOptions options;
  options.kind = kind;
  options.seed = seed;
  planning::EgoPlan plan(OptionsOf(kind), seed);
  std::vector<EgoSceneResult> results;
  for (int index = 0; index < scenes; ++index) {
    const EgoScene scene = DrawFree(options, index);
    planning::EgoRequest request;
    request.ends = scene.ends;
    const planning::EgoPlanResult planned = plan.Run(scene.grid, request);
    EgoSceneResult result;
    result.status = planned.status;
    result.iterations = planned.counts.iterations;
    result.evaluations = planned.counts.evaluations;
    result.runs = planned.counts.runs;
    result.searches = planned.counts.searches;
    result.refined = planned.refined;
    result.length = result.duration = result.jerk = result.max_speed = result.max_acceleration =
        std::numeric_limits<double>::quiet_NaN();
    if (planned.status == EgoStatus::kPlanned) Measure(planned.curve, &result);
    results.push_back(result);
    if (report) report(index + 1, scenes);
  }
  return results;
}

}  // namespace touchdown::evaluation
