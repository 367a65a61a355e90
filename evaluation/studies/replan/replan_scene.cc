// SPDX-License-Identifier: BSD-3-Clause
// The published scenes' end is a point and a velocity near the speed limit, whenever it is reached: the set
// point_ahead. In the others the point belongs to a future pad. The pad passes it when the replanner's own guess of the
// duration says, so that a plan that is on time ends there.
#include "evaluation/studies/replan/replan_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <boost/math/tools/toms748_solve.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/field_map.h"
#include "evaluation/studies/replan/scene_sets.h"
#include "planning/map/voxel_traversal.h"
#include "planning/problem/duration_guess.h"
#include "planning/search/grid_search.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::evaluation {
namespace {

using sim::RandomStream;

constexpr double kBeyondTarget = 4.0;  // that is known [m]
constexpr double kMostMoved = 1.0;     // of a target, in a feasible scene [m]
constexpr double kMostDetour = 1.3;
constexpr int kExpansions = 2000000;
constexpr double kShortest = 0.1;  // flight to the end [s]
constexpr double kLongest = 60.0;  // [s]
constexpr double kMissed = 1e-6;   // of the target by an end that is on time [m]

planning::OccupancyMapOptions MapOptions(const SceneOptions& options) {
  planning::OccupancyMapOptions map;
  map.resolution = options.resolution;
  map.inflation_radius = options.kind.inflation;
  // Known 12 m around the start at the usual horizon; a window is a power of two.
  const double half = std::max(12.8, options.horizon + kBeyondTarget);
  constexpr int kLargest = 10;  // of a window's side, as a power of two of cells
  const auto log2_of = [&](double extent) {
    const int needed = static_cast<int>(std::ceil(std::log2(extent / options.resolution - 1e-9)));
    if (needed > kLargest) {
      throw BadInput(
          fmt::format("horizon {:.4g} m: a map of cells of {:.4g} m holds no more than {:.4g} m",
                      options.horizon, options.resolution,
                      0.5 * options.resolution * (1 << kLargest) - kBeyondTarget));
    }
    return std::max(needed, 4);
  };
  map.size_log2 = {log2_of(2.0 * half), log2_of(2.0 * half), log2_of(3.2)};
  return map;
}

// The end's place at the start and the duration of the flight depend on each other. False if they do not come together.
bool SetEnd(const Eigen::Vector3d& v_end, const planning::Limits& limits, ReplanScene* scene) {
  const auto guess_for = [&](double T) {
    const MovingTarget end(scene->target, v_end, T);
    return planning::GuessDuration(scene->start, 0.0, end, scene->endpoint, limits, 1.0);
  };
  const auto late = [&](double T) { return std::min(guess_for(T), kLongest) - T; };
  if (!(late(kShortest) > 0.0) || !(late(0.99 * kLongest) < 0.0)) return false;
  std::uintmax_t steps = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      late, kShortest, 0.99 * kLongest, boost::math::tools::eps_tolerance<double>(40), steps);
  scene->end = std::make_unique<MovingTarget>(scene->target, v_end, 0.5 * (low + high));
  scene->duration = guess_for(0.5 * (low + high));
  return (scene->end->At(scene->duration).p_WP - scene->target).norm() < kMissed;
}

bool BrakesFreely(const ReplanScene& scene, const planning::FreeSpace& space,
                  const planning::Limits& limits) {
  const planning::UniformBspline brake =
      planning::MakeRestTrajectory(scene.start, 0.0, Eigen::Vector3d::Zero(), limits);
  return !std::isfinite(planning::FirstBlockedTime(brake, 0.0, space));
}

bool Joined(const ReplanScene& scene, const planning::FreeSpace& space) {
  planning::GridSearch search;
  planning::GuidePath path;
  if (search.Search(space, scene.start.p, scene.target, kExpansions, &path) !=
      planning::SearchStatus::kFound) {
    return false;
  }
  return planning::PathLength(path) <= kMostDetour * (scene.target - scene.start.p).norm();
}

/// Farthest that a point gets along a line in `time`, from speed s0 to s1 along it.
double MostProgress(double s0, double s1, double time, const planning::Limits& limits) {
  const double a = limits.acceleration;
  s0 = std::min(s0, limits.speed);
  if (std::abs(s1 - s0) > a * time) return -std::numeric_limits<double>::infinity();
  const double top = std::min(0.5 * (s0 + s1 + a * time), limits.speed);
  const double ramps = (2.0 * top * top - s0 * s0 - s1 * s1) / (2.0 * a);
  return ramps + top * (time - (2.0 * top - s0 - s1) / a);
}

}  // namespace

estimation::PadState MovingTarget::At(double t) const noexcept {
  estimation::PadState state;
  state.p_WP = p_ + (t - t_) * v_;
  state.v_WP = v_;
  return state;
}

planning::ReplannerOptions SceneReplannerOptions(const SceneOptions& options,
                                                 planning::ReplannerOptions base) {
  base.limits = options.kind.limits;
  base.floor_height = kForestFloor;
  base.ceiling_height = kForestCeiling;
  base.pad_radius = 0.0;   // there is no vehicle under the end
  base.hull_radius = 0.0;  // a point flies
  return base;
}

ReplanScene DrawReplanScene(const SceneOptions& options, int index) {
  const planning::Limits& limits = options.kind.limits;
  for (int draw = 0; draw < kForestSceneDraws; ++draw) {
    RandomStream stream = SceneStream(options, index, draw);
    SceneSketch sketch = SceneSetNamed(options.set).draw(options, stream);
    ReplanScene scene;
    scene.start = sketch.start;
    scene.endpoint.height = 0.0;
    scene.endpoint.passing_W = sketch.passing;
    scene.field = std::move(sketch.field);
    scene.map = std::make_unique<planning::OccupancyMap>(MapOptions(options));
    scene.map->Recentre({scene.start.p.x(), scene.start.p.y(), 0.5 * sketch.height});
    FillMap(scene.field, scene.map.get());
    planning::FreeSpace space;
    space.map = scene.map.get();
    space.floor = kForestFloor;
    space.ceiling = kForestCeiling;
    if (space.Blocked(scene.start.p)) continue;

    planning::CellIndex cell = scene.map->CellOf(sketch.target);
    const bool blocked = space.Blocked(cell);
    const bool found =
        sketch.target_moves ? planning::GridSearch::NearestFree(space, &cell) : !blocked;
    scene.target = blocked && found ? scene.map->CentreOf(cell) : sketch.target;
    scene.target_moved = (scene.target - sketch.target).norm();
    if (!SetEnd(sketch.v_end, limits, &scene)) continue;
    scene.straight_blocked = false;
    planning::TraverseCells(scene.start.p, scene.target, scene.map->resolution(),
                            [&](const planning::CellIndex& passed) {
                              scene.straight_blocked = space.Blocked(passed);
                              return !scene.straight_blocked;
                            });
    scene.feasible = found && scene.target_moved < kMostMoved && Joined(scene, space) &&
                     BrakesFreely(scene, space, limits);
    return scene;
  }
  throw std::runtime_error(
      fmt::format("replan scene {}: in {} draws the start was blocked, or no end was met on time",
                  index, kForestSceneDraws));
}

planning::ReplanInput AskAt(const ReplanScene& scene, planning::Replanner* replanner) {
  constexpr double kAhead = 0.5;  // [s]
  planning::ControlPoints straight(3, 4);
  for (int i = 0; i < 4; ++i) {
    straight.col(i) = scene.start.p + (i - 1) * kAhead * scene.start.v;
  }
  planning::ReplannerState state;
  state.current.curve = state.next.curve = planning::UniformBspline(straight, kAhead, 0.0);
  replanner->Restore(state);
  planning::ReplanInput input;
  input.vehicle.p_WB = scene.start.p;
  input.vehicle.v_WB = scene.start.v;
  input.pad = scene.end.get();
  input.endpoint = scene.endpoint;
  return input;
}

// At an arrival the end lies ahead by some distance, in some direction. Even along that direction alone the point has
// to get that far, and from its own speed to the end's.
double EarliestArrival(const ReplanScene& scene, const planning::Limits& limits) {
  constexpr double kClock = 0.01;
  double T = kClock;
  for (; T < kLongest; T += kClock) {
    const planning::SplineState end = planning::EndStateAt(*scene.end, scene.endpoint, T).state;
    const Eigen::Vector3d way = end.p - scene.start.p;
    const Eigen::Vector3d along = way.stableNormalized();
    if (MostProgress(scene.start.v.dot(along), end.v.dot(along), T, limits) >= way.norm()) break;
  }
  return T - kClock;
}

void LearnWithin(const planning::OccupancyMap& all, const Eigen::Vector3d& centre, double radius,
                 planning::OccupancyMap* map) {
  const planning::CellIndex low = all.CellOf(centre.array() - radius).cwiseMax(all.origin());
  const planning::CellIndex high =
      all.CellOf(centre.array() + radius)
          .cwiseMin(all.origin() + all.size() - planning::CellIndex::Ones());
  planning::CellIndex cell;
  for (cell.z() = low.z(); cell.z() <= high.z(); ++cell.z()) {
    for (cell.y() = low.y(); cell.y() <= high.y(); ++cell.y()) {
      for (cell.x() = low.x(); cell.x() <= high.x(); ++cell.x()) {
        const bool near = (all.CentreOf(cell) - centre).norm() <= radius;
        if (near && all.IsOccupied(cell)) map->SetState(cell, planning::CellState::kOccupied);
      }
    }
  }
  map->MarkFree(centre, radius);
}

}  // namespace touchdown::evaluation
