// SPDX-License-Identifier: BSD-3-Clause
// The world is cut into cells of 0.2 m around start, lane and obstacles. A cell may be entered where the obstacles are
// as far as the clearance; the step into it is checked half way. The bound on the rest of a way is the distance to the
// box around the lane. So a settled cell is settled by its shortest way.
#include "evaluation/studies/hostile/hostile_way.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include <Eigen/Geometry>

#include "estimation/base/degrees.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/obstacle_field.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::evaluation {
namespace {

constexpr double kCell = 0.2;          // [m]
constexpr double kRoomAround = 3.0;    // around everything: room to fly around it [m]
constexpr double kFloor = 0.6;         // lowest cells [m]
constexpr double kOverLow = 0.5;       // above the deck a way may end from here [m]
constexpr double kOverHigh = 1.5;      // to here
constexpr double kLaneStepTime = 0.2;  // of the pad's lane in time [s]
constexpr double kHull = 0.35;  // least room beside a start that has less than the clearance [m]
constexpr double kStartZone = 1.0;          // around such a start [m]
constexpr double kWindy = 5.0;              // [m/s]
constexpr double kShare = 0.5;              // of the limits a way is flown with
constexpr double kUsualSpeed = 1.5;         // and no faster [m/s]
constexpr double kUsualAcceleration = 1.0;  // [m/s^2]
constexpr double kTouchDown = 6.0;          // from above the lane to contact [s]

// From rest to rest over a way.
double FlightTime(const Scenario& s, double length) {
  const double most =
      std::min(s.limits.acceleration,
               estimation::kGravity * std::tan(s.limits.tilt_deg * estimation::kRadPerDeg));
  const double a = std::min(kShare * most, kUsualAcceleration);
  const double v = std::min(kShare * s.limits.speed, kUsualSpeed);
  return length < v * v / a ? 2.0 * std::sqrt(length / a) : length / v + v / a;
}

struct LanePoint {
  Eigen::Vector2d p;
  double latest = 0.0;  // that the pad is there [s]
};

class PathFinder {
 public:
  PathFinder(const Scenario& scenario, const Registries& registries, double horizon)
      : scenario_(scenario), clearance_(WayClearance(scenario)), start_(scenario.start.position) {
    for (const NamedObstacle& named : ObstaclesOf(scenario)) {
      obstacles_.push_back(named.obstacle);
      const sim::Bounds bounds = sim::BoundsOf(named.obstacle);
      space_.extend(Eigen::AlignedBox2d(bounds.min.head<2>(), bounds.max.head<2>()));
    }
    start_room_ = Room(start_);
    SampleLane(registries, horizon - kTouchDown);
    space_.extend(Eigen::Vector2d(start_.head<2>()));
    space_.extend(lane_box_);
    low_ = space_.min() - Eigen::Vector2d::Constant(kRoomAround);
    const Eigen::Vector2d extent = space_.max() + Eigen::Vector2d::Constant(kRoomAround) - low_;
    nx_ = static_cast<int>(extent.x() / kCell) + 1;
    ny_ = static_cast<int>(extent.y() / kCell) + 1;
    nz_ = static_cast<int>((scenario.planning.ceiling - kFloor) / kCell) + 1;
    MarkLane();
  }

  HostileWay Find() {
    HostileWay way;
    way.clearance = clearance_;
    const std::size_t cells = static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_ * nz_);
    length_.assign(cells, std::numeric_limits<float>::infinity());
    free_.assign(cells, kUnknown);
    settled_.assign(cells, false);
    const int first = CellOf(start_);
    Reach(first, 0.0F);
    while (!queue_.empty()) {
      const int cell = queue_.top().cell;
      queue_.pop();
      if (settled_[Index(cell)]) continue;
      settled_[Index(cell)] = true;
      const double length = static_cast<double>(length_[Index(cell)]);
      if (Ends(cell, length)) {
        way.exists = true;
        way.length = length;
        return way;
      }
      Expand(cell);
    }
    return way;
  }

 private:
  static constexpr std::uint8_t kUnknown = 0, kFree = 1, kBlocked = 2;
  struct Entry {
    float bound;
    int cell;
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound > other.bound : cell > other.cell;
    }
  };

  static std::size_t Index(int cell) { return static_cast<std::size_t>(cell); }

  void SampleLane(const Registries& registries, double until) {
    const auto course = PadCourseOf(scenario_, registries, scenario_.pad.phase, 0);
    for (int i = 0; i * kLaneStepTime <= until; ++i) {
      const Eigen::Vector2d p = course->At(i * kLaneStepTime).p_WP.head<2>();
      lane_.push_back({p, i * kLaneStepTime});
      lane_box_.extend(p);
    }
  }

  // The latest time of the pad over each column of cells.
  void MarkLane() {
    latest_.assign(static_cast<std::size_t>(nx_ * ny_), -1.0);
    for (const LanePoint& point : lane_) {
      const Eigen::Vector2d at = (point.p - low_) / kCell;
      const int column = static_cast<int>(at.y()) * nx_ + static_cast<int>(at.x());
      double& latest = latest_[static_cast<std::size_t>(column)];
      latest = std::max(latest, point.latest);
    }
  }

  double Room(const Eigen::Vector3d& p) const {
    double room = std::numeric_limits<double>::infinity();
    for (const sim::Obstacle& obstacle : obstacles_) {
      room = std::min(room, sim::SignedDistance(obstacle, p));
    }
    return room;
  }

  bool Clear(const Eigen::Vector3d& p) const {
    double needed = clearance_;
    if ((p - start_).norm() < kStartZone)
      needed = std::min(needed, std::max(kHull, start_room_ - kCell));
    for (const sim::Obstacle& obstacle : obstacles_) {
      if (sim::SignedDistance(obstacle, p) < needed) return false;
    }
    return true;
  }

  int CellOf(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d at = (p.head<2>() - low_) / kCell;
    const int k = std::clamp(static_cast<int>((p.z() - kFloor) / kCell), 0, nz_ - 1);
    return (k * ny_ + static_cast<int>(at.y())) * nx_ + static_cast<int>(at.x());
  }
  Eigen::Vector3i Place(int cell) const { return {cell % nx_, cell / nx_ % ny_, cell / nx_ / ny_}; }
  Eigen::Vector3d Centre(const Eigen::Vector3i& place) const {
    const Eigen::Vector3d middle = (place.cast<double>().array() + 0.5) * kCell;
    return middle + Eigen::Vector3d(low_.x(), low_.y(), kFloor);
  }

  bool Free(int cell) {
    std::uint8_t& state = free_[Index(cell)];
    if (state == kUnknown) state = Clear(Centre(Place(cell))) ? kFree : kBlocked;
    return state == kFree;
  }

  void Reach(int cell, float length) {
    if (length >= length_[Index(cell)]) return;
    length_[Index(cell)] = length;
    const Eigen::Vector2d p = Centre(Place(cell)).head<2>();
    // The last cell's centre may be outside of the box. Subtracting half a diagonal keeps the bound
    // valid.
    const double rest = std::max(0.0, lane_box_.exteriorDistance(p) - kCell);
    queue_.push({length + static_cast<float>(rest), cell});
  }

  void Expand(int cell) {
    const Eigen::Vector3i place = Place(cell);
    const Eigen::Vector3d from = Centre(place);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Eigen::Vector3i step(dx, dy, dz);
          const Eigen::Vector3i next = place + step;
          if (step.isZero() || (next.array() < 0).any() || next.x() >= nx_ || next.y() >= ny_ ||
              next.z() >= nz_) {
            continue;
          }
          const int there = (next.z() * ny_ + next.y()) * nx_ + next.x();
          const float length =
              length_[Index(cell)] + static_cast<float>(kCell * step.cast<double>().norm());
          if (settled_[Index(there)] || length >= length_[Index(there)]) continue;
          if (Free(there) && Clear(0.5 * (from + Centre(next)))) Reach(there, length);
        }
      }
    }
  }

  bool Ends(int cell, double length) const {
    const Eigen::Vector3i place = Place(cell);
    const double latest = latest_[static_cast<std::size_t>(place.y() * nx_ + place.x())];
    const double over = Centre(place).z() - scenario_.pad.deck_height;
    return over >= kOverLow && over <= kOverHigh && FlightTime(scenario_, length) <= latest;
  }

  const Scenario& scenario_;
  double clearance_;
  Eigen::Vector3d start_;
  double start_room_ = 0.0;
  std::vector<sim::Obstacle> obstacles_;
  std::vector<LanePoint> lane_;
  Eigen::AlignedBox2d lane_box_;
  Eigen::AlignedBox2d space_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int nx_ = 0, ny_ = 0, nz_ = 0;
  std::vector<double> latest_;  // by column; negative: the pad is never there
  std::vector<float> length_;
  std::vector<std::uint8_t> free_;
  std::vector<bool> settled_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

double WayClearance(const Scenario& scenario) {
  const bool estimated = scenario.own_state == OwnStateKind::kEstimated;
  const bool windy = std::max(scenario.wind.mean, scenario.wind.max) > kWindy;
  return 0.55 + 0.15 * (static_cast<int>(estimated) + static_cast<int>(windy));
}

HostileWay FindWay(const Scenario& scenario, const Registries& registries, double horizon) {
  return PathFinder(scenario, registries, horizon).Find();
}

}  // namespace touchdown::evaluation
