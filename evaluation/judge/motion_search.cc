// SPDX-License-Identifier: BSD-3-Clause
// Greedy A* over pieces of constant acceleration (S. Liu et al., "Search-based motion planning for quadrotors
// using linear quadratic minimum time control", IROS 2017, for the lattice). Every node that is near enough
// tries to end at once.
#include "evaluation/judge/motion_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <unordered_set>

#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/spline/boundary_lift.h"

namespace touchdown::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.2;       // of the lattice of positions [m] ...
constexpr double kSpeedCell = 0.4;  // ... and of velocities [m/s]
constexpr double kGreed = 2.0;      // of the time that is left at full speed
constexpr double kEffort = 0.05;    // cost of a second at full acceleration [s]
constexpr double kSample = 0.05;    // between places that are looked at [m]
constexpr double kShotFrom = 4.0;   // distance at which an end is tried [m]
constexpr double kTopSpeed = 0.95;  // of the limit
constexpr int kShotSegments = 12;

struct Node {
  Vector3d p, v;
  double t = 0.0, cost = 0.0;
  int parent = -1;
};

struct Key {
  std::array<int, 6> at;
  bool operator==(const Key&) const = default;
};
struct HashKey {
  std::size_t operator()(const Key& key) const {
    std::size_t hash = 1469598103934665603ull;
    for (const int i : key.at)
      hash = (hash ^ static_cast<std::size_t>(i + 4096)) * 1099511628211ull;
    return hash;
  }
};

Key KeyOf(const Node& node) {
  Key key;
  for (int i = 0; i < 3; ++i) {
    key.at[static_cast<std::size_t>(i)] = static_cast<int>(std::lround(node.p[i] / kCell));
    key.at[static_cast<std::size_t>(i + 3)] = static_cast<int>(std::lround(node.v[i] / kSpeedCell));
  }
  return key;
}

std::vector<Vector3d> Accelerations(double most) {
  std::vector<Vector3d> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      all.push_back(most * Vector3d(x, y, 0.0) / std::max(1.0, std::hypot(x, y)));
    }
  }
  all.push_back({0.0, 0.0, 0.4 * most});
  all.push_back({0.0, 0.0, -0.4 * most});
  return all;
}

bool Free(const Node& from, const Vector3d& a, double time, const planning::FreeSpace& space) {
  const double length = from.v.norm() * time + 0.5 * a.norm() * time * time;
  const int samples = std::max(2, static_cast<int>(std::ceil(length / kSample)));
  for (int i = 1; i <= samples; ++i) {
    const double t = time * i / samples;
    if (space.Blocked(Vector3d(from.p + t * from.v + 0.5 * t * t * a))) return false;
  }
  return true;
}

class Search {
 public:
  Search(const planning::SplineState& start, const estimation::PadPrediction& pad,
         const planning::EndpointTarget& target, const planning::Limits& limits,
         const planning::FreeSpace& space, const MotionSearchOptions& options)
      : start_(start),
        pad_(pad),
        target_(target),
        limits_(limits),
        space_(space),
        options_(options) {}

  std::optional<TimedMotion> Run() {
    const std::vector<Vector3d> accelerations =
        Accelerations(options_.share * limits_.acceleration);
    Push({start_.p, start_.v, 0.0, 0.0, -1});
    for (int expanded = 0; !open_.empty() && expanded < options_.max_expansions;) {
      const int at = open_.top().second;
      open_.pop();
      const Node node = nodes_[static_cast<std::size_t>(at)];
      if (!closed_.insert(KeyOf(node)).second) continue;
      ++expanded;
      if (auto way = Shoot(at)) return way;
      for (const Vector3d& a : accelerations) {
        const double time = options_.step;
        Node next{node.p + time * node.v + 0.5 * time * time * a, node.v + time * a, node.t + time,
                  0.0, at};
        if (next.v.norm() > std::max(kTopSpeed * limits_.speed, node.v.norm())) continue;
        if (closed_.count(KeyOf(next)) > 0 || !Free(node, a, time, space_)) continue;
        const double effort = a.squaredNorm() / (limits_.acceleration * limits_.acceleration);
        next.cost = node.cost + time * (1.0 + kEffort * effort);
        Push(next);
      }
    }
    return std::nullopt;
  }

 private:
  planning::SplineState EndAt(double t) const {
    return planning::EndStateAt(pad_, target_, t).state;
  }

  void Push(const Node& node) {
    const double left = (EndAt(node.t).p - node.p).norm() / limits_.speed;
    open_.push({-(node.cost + kGreed * left), static_cast<int>(nodes_.size())});
    nodes_.push_back(node);
  }

  /// A quintic to the end, for a few arrivals.
  std::optional<TimedMotion> Shoot(int at) const {
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    const double distance = (EndAt(node.t).p - node.p).norm();
    if (distance > kShotFrom) return std::nullopt;
    for (const double factor : {1.2, 1.6, 2.2, 3.0}) {
      const double time = std::max(0.3, factor * distance / limits_.speed);
      const planning::SplineState from{node.p, node.v, Vector3d::Zero()};
      const planning::UniformBspline curve(
          planning::HermiteControlPoints(from, EndAt(node.t + time), kShotSegments, time),
          time / kShotSegments, node.t);
      const planning::DerivativeBounds bounds = planning::BoundDerivatives(curve);
      if (bounds.speed > 1.05 * limits_.speed) continue;
      if (bounds.acceleration > 1.2 * limits_.acceleration) continue;
      if (std::isfinite(planning::FirstBlockedTime(curve, node.t, space_))) continue;
      return WayTo(at, curve);
    }
    return std::nullopt;
  }

  TimedMotion WayTo(int at, const planning::UniformBspline& last) const {
    constexpr int kPlaces = 6;  // of a piece
    std::vector<int> chain;
    for (int i = at; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) chain.push_back(i);
    std::reverse(chain.begin(), chain.end());
    TimedMotion way;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Node& a = nodes_[static_cast<std::size_t>(chain[i])];
      const Node& b = nodes_[static_cast<std::size_t>(chain[i + 1])];
      const double time = b.t - a.t;
      for (int k = 0; k < kPlaces; ++k) {
        const double t = time * k / kPlaces;
        way.push_back({a.t + t, a.p + t * a.v + 0.5 * t * t / time * (b.v - a.v)});
      }
    }
    for (int k = 0; k <= 4 * kPlaces; ++k) {
      const double t = last.t0() + last.duration() * k / (4 * kPlaces);
      way.push_back({t, last.Position(t)});
    }
    return way;
  }

  const planning::SplineState& start_;
  const estimation::PadPrediction& pad_;
  const planning::EndpointTarget& target_;
  const planning::Limits& limits_;
  const planning::FreeSpace& space_;
  const MotionSearchOptions& options_;
  std::vector<Node> nodes_;
  std::priority_queue<std::pair<double, int>> open_;
  std::unordered_set<Key, HashKey> closed_;
};

}  // namespace

std::optional<TimedMotion> SearchMotion(const planning::SplineState& start,
                                        const estimation::PadPrediction& pad,
                                        const planning::EndpointTarget& target,
                                        const planning::Limits& limits,
                                        const planning::FreeSpace& space,
                                        const MotionSearchOptions& options) {
  return Search(start, pad, target, limits, space, options).Run();
}

}  // namespace touchdown::evaluation
