// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scenario/world_obstacles.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "estimation/base/degrees.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/build_info.h"
#include "evaluation/scenario/obstacle_keys.h"
#include "planning/map/octomap_cells.h"
#include "sim/base/input_file.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/world_files.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostKept = 16;  // files whose obstacles are kept
constexpr double kTouching = 1e-9;     // contact of surfaces is no overlap [m]

Eigen::Matrix3d Turned(const Eigen::Vector3d& turn_deg) {
  const Eigen::Vector3d turn = turn_deg * estimation::kRadPerDeg;
  return sim::TurnOf(turn.x(), turn.y(), turn.z());
}

std::vector<sim::Obstacle> SolidsOf(const BoxObstacle& spec) {
  Eigen::Vector3d middle;
  middle << spec.centre, spec.base + 0.5 * spec.size.z();
  if (spec.turn_deg.head<2>().isZero(0.0)) {
    return {sim::Box{middle, 0.5 * spec.size, spec.turn_deg.z() * estimation::kRadPerDeg}};
  }
  return {sim::Mesh{std::make_shared<const sim::TriangleMesh>(
      sim::BoxMesh(0.5 * spec.size, {Turned(spec.turn_deg), middle}))}};
}

std::vector<sim::Obstacle> SolidsOf(const CylinderObstacle& spec) {
  sim::Cylinder cylinder;
  cylinder.center << spec.centre, spec.base + 0.5 * spec.height;
  cylinder.radius = spec.radius;
  cylinder.height = spec.height;
  return {cylinder};
}

std::vector<sim::Obstacle> SolidsOf(const SphereObstacle& spec) {
  return {sim::Sphere{spec.centre, spec.radius}};
}

// A box from point to point, each longer by half the thickness at both ends: corners are filled.
std::vector<sim::Obstacle> SolidsOf(const WallObstacle& spec) {
  std::vector<sim::Obstacle> boxes;
  for (std::size_t i = 0; i + 3 < spec.points.size(); i += 2) {
    const Eigen::Map<const Eigen::Vector2d> from(&spec.points[i]), to(&spec.points[i + 2]);
    const Eigen::Vector2d along = to - from;
    sim::Box box;
    box.center << 0.5 * (from + to), spec.base + 0.5 * spec.height;
    box.half_extents =
        0.5 * Eigen::Vector3d(along.norm() + spec.thickness, spec.thickness, spec.height);
    box.yaw = std::atan2(along.y(), along.x());
    boxes.emplace_back(box);
  }
  return boxes;
}

std::vector<sim::Obstacle> Read(const MeshObstacle& spec) {
  return sim::ObstaclesOfMeshFile(spec.file, spec.scale, {Turned(spec.turn_deg), spec.at});
}

std::vector<sim::Obstacle> Read(const HeightFieldObstacle& spec) {
  return {sim::ObstacleOfHeightFile(spec.file, spec.size, spec.height,
                                    {Turned({0.0, 0.0, spec.yaw_deg}), spec.at})};
}

std::vector<sim::Obstacle> Read(const OctomapObstacle& spec) {
  std::istringstream file(sim::ReadInputFile(spec.file, planning::kMostMapBytes));
  planning::OccupiedCells occupied;
  try {
    occupied = planning::ReadOccupiedCells(file);
  } catch (const std::invalid_argument& error) {
    sim::RefuseFile(spec.file, error.what());
  }
  std::erase_if(occupied.cells, [&](const planning::CellIndex& cell) {
    const Eigen::Array3d middle = occupied.resolution * (cell.cast<double>().array() + 0.5);
    return (middle < spec.crop_min.array()).any() || (middle > spec.crop_max.array()).any();
  });
  if (occupied.cells.empty()) {
    sim::RefuseFile(spec.file, "no occupied cell of it lies within crop_min and crop_max");
  }
  return sim::BoxesOfCells(std::move(occupied.cells), occupied.resolution, spec.at,
                           spec.yaw_deg * estimation::kRadPerDeg);
}

// Keyed by all that decides a file's content: the keys of its element, its size and its time of
// writing.
class FileCache {
 public:
  using Solids = std::shared_ptr<const std::vector<sim::Obstacle>>;

  template <typename Element>
  Solids Take(const Element& spec, const ElementKeys<Element>& keys) {
    std::error_code missing;
    const auto size = fs::file_size(spec.file, missing);
    const auto written = missing ? fs::file_time_type{} : fs::last_write_time(spec.file, missing);
    if (missing) sim::RefuseFile(spec.file, "it cannot be read (" + missing.message() + ")");
    std::string about = fmt::format("{} {}", size, written.time_since_epoch().count());
    for (const auto& key : keys) about += " " + key.name + " " + key.get(spec);
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = kept_.find(about);
    if (found != kept_.end()) return found->second;
    if (kept_.size() >= kMostKept) kept_.clear();
    return kept_[about] = std::make_shared<const std::vector<sim::Obstacle>>(Read(spec));
  }

 private:
  std::mutex mutex_;
  std::map<std::string, Solids> kept_;
};

template <typename Element>
constexpr bool kIsFile =
    std::is_same_v<Element, MeshObstacle> || std::is_same_v<Element, HeightFieldObstacle> ||
    std::is_same_v<Element, OctomapObstacle>;

}  // namespace

ObstacleList ObstaclesOf(const Scenario& scenario) {
  static FileCache cache;
  ObstacleList list;
  ForEachObstacleList(scenario,
                      [&](const std::string& name, const auto& elements, const auto& keys) {
                        using Element = typename std::decay_t<decltype(elements)>::value_type;
                        for (std::size_t i = 0; i < elements.size(); ++i) {
                          const std::string key = fmt::format("{}[{}]", name, i);
                          const auto add = [&](const std::vector<sim::Obstacle>& solids) {
                            for (const sim::Obstacle& solid : solids) {
                              sim::Validate(solid, "a solid of it");
                              list.push_back({key, solid});
                            }
                          };
                          try {
                            if constexpr (kIsFile<Element>) {
                              add(*cache.Take(elements[i], keys));
                            } else {
                              add(SolidsOf(elements[i]));
                            }
                          } catch (const std::invalid_argument& error) {
                            throw BadInput(fmt::format("{}: {}.", key, error.what()));
                          }
                        }
                      });
  return list;
}

std::string WorldHash(const Scenario& scenario) {
  std::string bytes;
  ForEachObstacleList(scenario, [&](const std::string& name, const auto& elements, const auto&) {
    using Element = typename std::decay_t<decltype(elements)>::value_type;
    if constexpr (kIsFile<Element>) {
      for (const Element& spec : elements) {
        try {
          bytes += sim::ReadInputFile(spec.file, sim::kMostInputBytes - bytes.size());
          bytes += '\0';
        } catch (const std::invalid_argument& error) {
          throw BadInput(fmt::format("{}: {}.", name, error.what()));
        }
      }
    }
  });
  return bytes.empty() ? "none" : HashOf(bytes);
}

double HorizontalGap(const sim::Obstacle& obstacle, const Eigen::Vector2d& centre,
                     const Eigen::Vector2d& spread, double z_lo, double z_hi, double within) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const sim::Bounds bounds = sim::BoundsOf(obstacle);
  if (bounds.max.z() <= z_lo || bounds.min.z() >= z_hi) return kInfinity;
  if (const auto* mesh = std::get_if<sim::Mesh>(&obstacle)) {
    const Eigen::Array2d reach = spread.array() + within - kTouching;
    sim::Bounds place;
    place.min << centre.array() - reach, z_lo + kTouching;
    place.max << centre.array() + reach, z_hi - kTouching;
    return mesh->surface->Meets(place) ? 0.0 : kInfinity;
  }
  const auto beyond = [&](const Eigen::Vector2d& middle, const Eigen::Vector2d& half) {
    return ((middle - centre).cwiseAbs() - spread - half).cwiseMax(0.0).norm();
  };
  if (const auto* ball = std::get_if<sim::Sphere>(&obstacle)) {
    const double z = std::clamp(ball->center.z(), z_lo, z_hi) - ball->center.z();
    return beyond(ball->center.head<2>(), Eigen::Vector2d::Zero()) -
           std::sqrt(std::max(0.0, ball->radius * ball->radius - z * z));
  }
  if (const auto* cylinder = std::get_if<sim::Cylinder>(&obstacle)) {
    return beyond(cylinder->center.head<2>(), Eigen::Vector2d::Zero()) - cylinder->radius;
  }
  const Eigen::Vector2d middle = 0.5 * (bounds.min + bounds.max).head<2>();
  const double by_bounds = beyond(middle, 0.5 * (bounds.max - bounds.min).head<2>());
  const auto* box = std::get_if<sim::Box>(&obstacle);
  if (box == nullptr || box->yaw == 0.0) return by_bounds;
  // Along the box's own axes the spread is as wide as its projection. Both are too short at corners.
  const double c = std::cos(box->yaw), s = std::sin(box->yaw);
  const Eigen::Vector2d off = middle - centre;
  const Eigen::Vector2d along(std::abs(c * off.x() + s * off.y()),
                              std::abs(c * off.y() - s * off.x()));
  const Eigen::Vector2d shadow(std::abs(c) * spread.x() + std::abs(s) * spread.y(),
                               std::abs(s) * spread.x() + std::abs(c) * spread.y());
  return std::max(by_bounds, (along - shadow - box->half_extents.head<2>()).cwiseMax(0.0).norm());
}

}  // namespace touchdown::evaluation
