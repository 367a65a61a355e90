// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/lookout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <queue>
#include <unordered_map>
#include <unordered_set>

#include "planning/map/voxel_traversal.h"
#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::planning {
namespace {

constexpr int kMostSpans = 60000;         // that a survey expands
constexpr double kBetweenBalls = 0.15;    // along the way [m]
constexpr double kSoon = 1.5;  // cells so far along the way are worth a third of the first ones [m]
constexpr std::size_t kMostNeeded = 600;  // cells
constexpr int kStrides[] = {1, 2, 4};  // cells between places
constexpr std::size_t kMostPlaces = 4000, kMostTried = 1500;
constexpr int kMostTraced = 60;  // of these, from which sight is traced
constexpr double kInside = 0.08;  // of the image's edge [rad]
constexpr double kFlown = 1.0, kTurned = 1.2, kStays = 0.6;  // [m/s], [rad/s], [s]
constexpr double kSamePlace = 0.4, kSameYaw = 0.5;           // [m], [rad]

/// Of a cell of the window, or beside it, counted from its lowest.
std::int64_t KeyOf(const CellIndex& at) {
  return ((std::int64_t{at.z()} + 1024) << 40) + ((std::int64_t{at.y()} + 1024) << 20) + at.x() + 1024;
}

/// Calls visit(cell) for the cells of the hull's ball at p that were not seen free, and that SweepHull does not
/// except. Ends early where it returns false.
template <class Visit>
bool ForEachUnseen(const HullSpace& hull, const Eigen::Vector3d& p, Visit&& visit) {
  const OccupancyMap& map = *hull.space->map;
  const double side = map.resolution(), radius = hull.radius() + kSweepRoom;
  const bool over = hull.pad != nullptr && hull.space->OverPad(p);
  const double deck = over ? hull.pad->MeanAt(0.0).p_WP.z() + side : 0.0;
  const double exempt = std::max(map.options().ground_height, deck) + 1e-9;
  const CellIndex low = map.CellOf(p.array() - radius), high = map.CellOf(p.array() + radius);
  const int count = high.x() - low.x() + 1;
  for (int z = low.z(); z <= high.z(); ++z) {
    if ((z + 1) * side <= exempt) continue;
    for (int y = low.y(); y <= high.y(); ++y) {
      const CellIndex first(low.x(), y, z);
      const bool inside = map.InWindow(first) && map.InWindow(first + CellIndex(count - 1, 0, 0));
      std::uint64_t missing = ~std::uint64_t{0} >> (64 - count);
      if (inside) missing &= ~map.ObservedFreeRow(first, count);
      for (; missing != 0; missing &= missing - 1) {
        const CellIndex cell = first + CellIndex(std::countr_zero(missing), 0, 0);
        const Eigen::Array3d off = ((map.CentreOf(cell) - p).array().abs() - 0.5 * side).max(0.0);
        if (off.matrix().squaredNorm() < radius * radius && !visit(cell)) return false;
      }
    }
  }
  return true;
}

/// How a vehicle that hovers against `pull_W` [m/s^2] is turned.
Eigen::Matrix3d Hovering(double yaw, const Eigen::Vector3d& pull_W) {
  const Eigen::Vector3d up = estimation::kGravity * Eigen::Vector3d::UnitZ() - pull_W;
  return (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up) *
          Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// What one camera has in its image from a place, whatever is between.
class Sight {
 public:
  Sight(const LookCamera& camera, const Viewpoint& from, const Eigen::Vector3d& pull_W)
      : reach_(camera.reach) {
    const Eigen::Matrix3d R_WB = Hovering(from.yaw, pull_W);
    R_CW_ = (R_WB * camera.R_BC).transpose();
    p_WC_ = from.p_WB + R_WB * camera.p_BC;
    const estimation::CameraIntrinsics& k = camera.intrinsics;
    const auto inside = [&k](double pixel, double centre, double inwards) {
      return std::tan(std::atan((pixel - centre) / k.focal) + inwards);
    };
    low_ = {inside(0.0, k.cx, kInside), inside(0.0, k.cy, kInside)};
    high_ = {inside(k.width, k.cx, -kInside), inside(k.height, k.cy, -kInside)};
  }

  bool Holds(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p_C = R_CW_ * (p_W - p_WC_);
    const Eigen::Array2d across = p_C.head<2>().array();
    return p_C.z() >= kNearest && p_C.z() <= reach_ && (across > p_C.z() * low_).all() &&
           (across < p_C.z() * high_).all();
  }

  /// Nothing that is known to block is before the cell.
  bool Reaches(const CellIndex& cell, const OccupancyMap& map) const {
    return TraverseCells(p_WC_, map.CentreOf(cell), map.resolution(), [&](const CellIndex& at) {
      return at == cell || !map.IsOccupied(at);
    });
  }

 private:
  static constexpr double kNearest = 0.25;  // [m]
  double reach_;
  Eigen::Array2d low_, high_;  // of the image, over the depth
  Eigen::Matrix3d R_CW_;
  Eigen::Vector3d p_WC_;
};

bool IsStruck(const Viewpoint& view, const std::vector<Viewpoint>& struck) {
  return std::any_of(struck.begin(), struck.end(), [&](const Viewpoint& old) {
    return (old.p_WB - view.p_WB).norm() < kSamePlace &&
           std::abs(estimation::WrapAngle(old.yaw - view.yaw)) < kSameYaw;
  });
}

}  // namespace

double Lookout::Length(const FreeSpace& space, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& goal) {
  const OccupancyMap& map = *space.map;
  // The last place of the window on the straight line.
  const Eigen::Vector3d low = map.CentreOf(map.origin()),
                        high = map.CentreOf(map.origin() + map.size() - CellIndex::Ones());
  double share = 1.0;
  for (int c = 0; c < 3; ++c) {
    const double along = goal[c] - from[c];
    if (along == 0.0) continue;
    share = std::min(share, std::max(0.0, ((along > 0.0 ? high : low)[c] - from[c]) / along));
  }
  const Eigen::Vector3d end = from + share * (goal - from);
  const SearchStatus status = search_.Search(space, from, end, kMostSpans, &path_);
  if (status != SearchStatus::kFound) return std::numeric_limits<double>::infinity();
  return search_.cost() + (goal - end).norm();
}

bool Lookout::NoteNeeded(const HullSpace& hull, const Eigen::Vector3d& from) {
  const OccupancyMap& map = *hull.space->map;
  needed_.clear();
  std::unordered_set<std::int64_t> noted;  // a cell is touched at several places
  double along = 0.0;
  const auto note = [&](const CellIndex& cell) {
    if (map.IsOccupied(cell) || !noted.insert(KeyOf(cell - map.origin())).second) return true;
    needed_.push_back({cell, std::exp(-along / kSoon)});
    return true;
  };
  ForEachUnseen(hull, from, note);
  begin_ = unseen_from_ = {from, 0.0};
  Eigen::Vector3d before = from;
  for (const Eigen::Vector3d& place : path_) {
    const double length = (place - before).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kBetweenBalls)));
    for (int i = 1; i <= steps; ++i) {
      along += length / steps;
      const Eigen::Vector3d p = before + (place - before) * i / steps;
      ForEachUnseen(hull, p, note);
      if (needed_.empty()) unseen_from_ = {p, along};
    }
    before = place;
  }
  const std::size_t step = 1 + needed_.size() / kMostNeeded;
  for (std::size_t i = 0; i * step < needed_.size(); ++i) needed_[i] = needed_[i * step];
  needed_.resize((needed_.size() + step - 1) / step);
  return !needed_.empty();
}

/// Adds places to which cells lead that were seen free, as densely as their number allows.
void Lookout::Flood(const HullSpace& hull, const Place& from) {
  const std::size_t before = places_.size();
  for (const int stride : kStrides) {
    places_.resize(before);
    if (Flood(hull, from, stride)) return;
  }
}

/// False: there are more than fit.
bool Lookout::Flood(const HullSpace& hull, const Place& begin, int stride) {
  const OccupancyMap& map = *hull.space->map;
  const Eigen::Vector3d& from = begin.p_W;
  const double side = stride * map.resolution();
  const std::size_t most = places_.size() + kMostPlaces;
  const auto place = [&](const CellIndex& node) -> Eigen::Vector3d {
    return from + side * node.cast<double>();
  };
  const double at_start = hull.radius() + kSweepRoom;
  const auto fits = [&](const Eigen::Vector3d& p) {
    return !hull.space->Blocked(p) && ForEachUnseen(hull, p, [&](const CellIndex& cell) {
      return !map.IsOccupied(cell) && (map.CentreOf(cell) - begin_.p_W).norm() < at_start;
    });
  };
  struct Entry {
    double way;
    CellIndex node;
    bool operator<(const Entry& other) const { return way > other.way; }
  };
  std::unordered_map<std::int64_t, double> ways = {{KeyOf(CellIndex::Zero()), 0.0}};
  std::priority_queue<Entry> queue;
  queue.push({0.0, CellIndex::Zero()});
  while (!queue.empty()) {
    if (places_.size() == most) return false;
    const Entry at = queue.top();
    queue.pop();
    if (at.way > ways[KeyOf(at.node)]) continue;
    places_.push_back({place(at.node), begin.way + at.way});
    for (int i = 0; i < 27; ++i) {
      const CellIndex next = at.node + CellIndex(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const double way = at.way + side * (next - at.node).cast<double>().norm();
      const auto [known, is_new] = ways.emplace(KeyOf(next), std::numeric_limits<double>::infinity());
      if (is_new && !fits(place(next))) known->second = -1.0;
      if (way >= known->second) continue;
      const Eigen::Vector3d between = 0.5 * (place(at.node) + place(next));
      if (hull.space->Blocked(between)) continue;
      known->second = way;
      queue.push({way, next});
    }
  }
  return true;
}

std::optional<Look> Lookout::Choose(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                                    const estimation::VehicleState& vehicle,
                                    const Eigen::Vector3d& pull_W,
                                    const std::vector<Viewpoint>& struck) {
  const OccupancyMap& map = *hull.space->map;
  places_.clear();
  Flood(hull, begin_);
  if (unseen_from_.way > 0.0) Flood(hull, unseen_from_);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double all = 0.0;
  for (const NeededCell& needed : needed_) {
    middle += needed.worth * map.CentreOf(needed.cell);
    all += needed.worth;
  }
  middle /= all;
  const double yaw_now = estimation::Yaw(vehicle.q_WB);

  struct Candidate {
    double worth;  // at most
    Viewpoint view;
    double way, time;
  };
  std::vector<Candidate> candidates;
  const double lowest = hull.pad != nullptr ? LowestRest(vehicle.t, hull)
                                            : -std::numeric_limits<double>::infinity();
  const std::size_t every = 1 + places_.size() / kMostTried;
  for (std::size_t i = 0; i < places_.size(); i += every) {
    const Place& place = places_[i];
    if (place.p_W.z() < lowest) continue;
    const Eigen::Vector3d to = middle - place.p_W;
    const Viewpoint view = {place.p_W, std::atan2(to.y(), to.x())};
    if (IsStruck(view, struck)) continue;
    const double turn = std::abs(estimation::WrapAngle(view.yaw - yaw_now));
    const double time = std::max(place.way / kFlown, turn / kTurned) + kStays;
    double seen = 0.0;
    for (const LookCamera& camera : cameras) {
      const Sight sight(camera, view, pull_W);
      for (const NeededCell& needed : needed_) {
        if (sight.Holds(map.CentreOf(needed.cell))) seen += needed.worth;
      }
    }
    if (seen > 0.0) candidates.push_back({seen / time, view, place.way, time});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  if (getenv("LOOKDBG")) fprintf(stderr, "   places %zu needed %zu candidates %zu middle %.2f %.2f %.2f first %.2f %.2f %.2f\n", places_.size(), needed_.size(), candidates.size(), middle.x(), middle.y(), middle.z(), map.CentreOf(needed_[0].cell).x(), map.CentreOf(needed_[0].cell).y(), map.CentreOf(needed_[0].cell).z());
  std::optional<Look> best;
  double best_worth = 0.0;
  int traced = 0;
  for (const Candidate& candidate : candidates) {
    if (candidate.worth <= best_worth || ++traced > kMostTraced) break;
    Look look = {candidate.view, candidate.way, candidate.time, {}};
    double worth = 0.0;
    for (const NeededCell& needed : needed_) {
      for (const LookCamera& camera : cameras) {
        const Sight sight(camera, look.from, pull_W);
        if (!sight.Holds(map.CentreOf(needed.cell)) || !sight.Reaches(needed.cell, map)) continue;
        look.cells.push_back(needed.cell);
        worth += needed.worth / candidate.time;
        break;
      }
    }
    if (worth <= best_worth) continue;
    best_worth = worth;
    best = std::move(look);
  }
  return best;
}

}  // namespace touchdown::planning
