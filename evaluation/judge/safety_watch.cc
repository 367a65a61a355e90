// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/safety_watch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace touchdown::evaluation {
namespace {

constexpr double kSight = 5.0;  // farther from the vehicle nothing is looked at [m]

/// Observed-free cells whose centre is inside the obstacle.
int CountFreeInside(const planning::OccupancyMap& map, const sim::Obstacle& obstacle,
                    const Eigen::Vector3d& p_WB, const Eigen::Vector3d& drift_W) {
  const sim::Bounds bounds = sim::BoundsOf(obstacle);
  const Eigen::Vector3d low = (bounds.min + drift_W).cwiseMax((p_WB.array() - kSight).matrix());
  const Eigen::Vector3d high = (bounds.max + drift_W).cwiseMin((p_WB.array() + kSight).matrix());
  const planning::CellIndex first = map.CellOf(low).cwiseMax(map.origin());
  const planning::CellIndex last =
      map.CellOf(high).cwiseMin(map.origin() + map.size() - planning::CellIndex::Ones());
  int count = 0;
  planning::CellIndex row = first;
  for (row.z() = first.z(); row.z() <= last.z(); ++row.z()) {
    for (row.x() = first.x(); row.x() <= last.x(); row.x() += 64) {
      const int cells = std::min(64, last.x() - row.x() + 1);
      std::array<double, 64> outside;  // each cell of a row is at least so far outside [m]: no distance is asked twice
      outside.fill(-1.0);
      for (row.y() = first.y(); row.y() <= last.y(); ++row.y()) {
        for (double& distance : outside) distance -= map.resolution();
        for (std::uint64_t free = map.ObservedFreeRow(row, cells); free != 0; free &= free - 1) {
          const int i = std::countr_zero(free);
          if (outside[static_cast<std::size_t>(i)] > 0.0) continue;
          const planning::CellIndex cell = row + planning::CellIndex(i, 0, 0);
          const double distance = sim::SignedDistance(obstacle, map.CentreOf(cell) - drift_W);
          count += distance < 0.0 ? 1 : 0;
          const int reach = static_cast<int>(std::max(0.0, distance) / map.resolution());
          for (int k = std::max(0, i - reach); k <= std::min(63, i + reach); ++k) {
            double& known = outside[static_cast<std::size_t>(k)];
            known = std::max(known, distance - std::abs(k - i) * map.resolution());
          }
        }
      }
    }
  }
  return count;
}

}  // namespace

void SafetyWatch::Step(const planning::ReplanResult& plan, const planning::Margins& margins,
                       bool late) {
  // A trajectory that is flown on keeps the margins with which it was proven.
  if (plan.committed) margins_ = margins;
  figures_.margin_max_m = std::max(figures_.margin_max_m, margins.Sum());
  figures_.margin_mean_m += (margins.Sum() - figures_.margin_mean_m) / ++steps_;
  const planning::Certificate& certificate = plan.certificate;
  if (!certificate.stops_in_observed_space || late) ++figures_.uncertified_steps;
  const planning::StartCells& start = certificate.start_cells;
  const bool escapes = start.leaves() || plan.status == planning::ReplanStatus::kEscaping;
  const bool narrow = start.narrow || !certificate.clear;
  if (escapes) ++figures_.escaping_steps;
  if (start.occupied) ++figures_.escaping_hit_steps;
  if (start.unknown) ++figures_.escaping_unknown_steps;
  if (!escapes && narrow) ++figures_.narrow_steps;
  if (plan.map_error) ++figures_.map_errors;
  // An intended stop is a curve to rest, without another one that begins later.
  const bool stops = plan.status == planning::ReplanStatus::kBraking && !plan.committed &&
                     std::isfinite(plan.t_stop);
  if (stops && !stopping_) ++figures_.stops_flown;
  stopping_ = stops;
}

void SafetyWatch::Tracked(const Eigen::Vector3d& p_WB, const Eigen::Vector3d& p_true_WB,
                          const Eigen::Vector3d& p_reference_W) {
  const auto note = [](double error, double margin, double* largest, bool* beyond, int* events) {
    *largest = std::max(*largest, error);
    const bool off = error > margin;
    if (off && !*beyond) ++*events;
    *beyond = off;
  };
  note((p_WB - p_reference_W).norm(), margins_.tracking, &figures_.tracking_max_m, &off_,
       &figures_.tracking_events);
  note((p_WB - p_true_WB).norm(), margins_.own_state, &figures_.drift_max_m, &drifted_,
       &figures_.drift_events);
}

void SafetyWatch::LookAt(const planning::OccupancyMap& map, const Eigen::Vector3d& p_WB,
                         const Eigen::Vector3d& drift_W) {
  figures_.free_cells += map.CountObservedFree();
  const Eigen::Array3d p_W = p_WB - drift_W;
  obstacles_.tree().Within({p_W - kSight, p_W + kSight}, [&](int i) {
    figures_.falsely_free_cells += CountFreeInside(
        map, obstacles_.obstacles()[static_cast<std::size_t>(i)], p_WB, drift_W);
  });
}

}  // namespace touchdown::evaluation
