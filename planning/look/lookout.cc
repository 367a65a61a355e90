// SPDX-License-Identifier: BSD-3-Clause
#include "planning/look/lookout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "planning/certify/start_cells.h"
#include "touchdown/planning/certify/stored_stop.h"

namespace touchdown::planning {
namespace {

constexpr int kAllSpans = std::numeric_limits<int>::max();  // that a search expands
constexpr double kBetweenBalls = 0.15;  // along the way [m]
constexpr double kBetweenTested =
    0.3;  // balls: they leave out 3 cm of what the hull sweeps between them [m]
constexpr double kSoon = 1.5;           // cells so far along it are worth a third of the first [m]
constexpr double kFar = 4.0 * kSoon;    // beyond what was seen: 2 % of the first [m]
constexpr std::size_t kMostNeeded = 600;  // cells
constexpr std::size_t kUsualPath = 2048, kUsualNeeded = 40000, kUsualMarks = 200000,
                      kUsualCameras = 8;
constexpr double kApartAt[] = {1.2, 0.6, 0.3, 0.1};  // places, the first that finds many [m]
constexpr std::size_t kMostPlaces = 250;
constexpr std::size_t kSample = 200;  // needed cells, by which places are compared
constexpr double kFlies = 1.0, kTurns = 1.2,
                 kStays = 0.6;                      // [m/s], [rad/s], [s]: what a look takes
constexpr double kSamePlace = 0.4, kSameYaw = 0.5;  // of a struck one [m], [rad]

/// Calls visit(cell) for the cells of the hull's ball at p that were not seen free and are not the deck's. Ends where
/// it returns false; whether none did.
template <class Visit>
bool ForEachUnseen(const HullSpace& hull, const Eigen::Vector3d& p, Visit&& visit) {
  const OccupancyMap& map = *hull.space->map;
  const double side = map.resolution(), radius = hull.radius() + kSweepRoom;
  double exempt = map.options().ground_height;
  if (hull.pad != nullptr && hull.space->OverPad(p)) {
    exempt = std::max(exempt, hull.pad->MeanAt(0.0).p_WP.z() + side);
  }
  const CellIndex low = map.CellOf(p.array() - radius), high = map.CellOf(p.array() + radius);
  const int count = std::min(64, high.x() - low.x() + 1);
  for (int z = low.z(); z <= high.z(); ++z) {
    if ((z + 1) * side <= exempt + FreeSpace::kLevelRounding) continue;
    for (int y = low.y(); y <= high.y(); ++y) {
      const CellIndex first(low.x(), y, z);
      const bool inside = map.InWindow(first) && map.InWindow(first + CellIndex(count - 1, 0, 0));
      std::uint64_t missing = ~std::uint64_t{0} >> (64 - count);
      if (inside) missing &= ~map.ObservedFreeRow(first, count);
      for (; missing != 0; missing &= missing - 1) {
        const CellIndex cell = first + CellIndex(std::countr_zero(missing), 0, 0);
        if (DistanceTo(cell, p, side) < radius && !visit(cell)) return false;
      }
    }
  }
  return true;
}

bool IsStruck(const Viewpoint& view, const std::vector<Viewpoint>& struck) {
  return std::any_of(struck.begin(), struck.end(), [&](const Viewpoint& old) {
    return (old.p_WB - view.p_WB).norm() < kSamePlace &&
           std::abs(estimation::WrapAngle(old.yaw - view.yaw)) < kSameYaw;
  });
}

}  // namespace

Lookout::Lookout(const PathCost& cost)
    : cost_(cost), search_({.vertical = cost.vertical}), far_search_({.vertical = cost.vertical}) {
  for (GuidePath* path : {&path_, &back_}) path->reserve(kUsualPath);
  needed_.reserve(kUsualNeeded);
  places_.reserve(2 * std::size(kApartAt) * kMostPlaces);
  candidates_.reserve(places_.capacity());
  queue_.reserve(27 * places_.capacity() / 2);
  sights_.reserve(kUsualCameras);
  look_.cells.reserve(kMostNeeded + 1);
  look_.way_W.reserve(kUsualPath + places_.capacity());
  seen_.reserve(kMostNeeded + 1);
}

void Lookout::Prepare(const FreeSpace& space) {
  const OccupancyMap& map = *space.map;
  search_.Reserve(map);
  marks_.Begin(map);
  far_.emplace(map, space.floor);
  far_search_.Reserve(far_->map());
}

void Lookout::Keep(const FreeSpace& space) {
  if (!far_) Prepare(space);
  far_->Keep(*space.map);
}

void Lookout::CellMarks::Begin(const OccupancyMap& map) {
  if (size_ != map.size() || marks_.empty()) {
    size_ = map.size();
    marks_.assign(static_cast<std::size_t>(size_.prod()), kNone);
    set_.reserve(kUsualMarks);
    set_.clear();
  }
  for (const std::uint32_t at : set_) marks_[at] = kNone;
  set_.clear();
  origin_ = map.origin();
}

/// It will be set. @pre the cell is in the window
Lookout::Mark& Lookout::CellMarks::At(const CellIndex& cell) {
  const CellIndex at = cell - origin_;
  const auto i = static_cast<std::uint32_t>((at.z() * size_.y() + at.y()) * size_.x() + at.x());
  if (marks_[i] == kNone) set_.push_back(i);
  return marks_[i];
}

double Lookout::Length(const FreeSpace& space, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& goal) {
  status_ = search_.SearchOut(space, from, goal, kAllSpans, &path_);
  end_ = search_.end();
  return status_ == SearchStatus::kFound ? search_.cost() : std::numeric_limits<double>::infinity();
}

void Lookout::TakePath(const FreeSpace& space, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& goal, bool wide, bool far) {
  search_.set_cost({cost_.vertical, wide ? cost_.tight : 1.0});
  if (!far || !TakeFarPath(space, from, goal)) {
    search_.SearchOut(space, from, goal, kAllSpans, &path_);
  }
  search_.set_cost({cost_.vertical, 1.0});
}

bool Lookout::TakeFarPath(const FreeSpace& space, const Eigen::Vector3d& from,
                          const Eigen::Vector3d& goal) {
  FreeSpace far = space;
  far.map = &far_->map();
  const SearchStatus status = far_search_.SearchOut(far, from, goal, kAllSpans, &back_);
  // It may have missed a passage: then what the window holds must do.
  const bool missed =
      far_search_.end() != SpanSearch::End::kGoal && far.map->InWindow(far.map->CellOf(goal));
  if (status != SearchStatus::kFound || missed) return false;
  // Within the window the way is as it is there, to where the other leaves it.
  const OccupancyMap& map = *space.map;
  const auto last = std::find_if(back_.begin(), back_.end(), [&](const Eigen::Vector3d& p) {
    return !map.InWindow(map.CellOf(p));
  });
  return last != back_.begin() &&
         search_.Search(space, from, *(last - 1), kAllSpans, &path_) == SearchStatus::kFound;
}

bool Lookout::Closed(const FreeSpace& space, const Eigen::Vector3d& from,
                     const Eigen::Vector3d& goal) {
  const bool found = status_ == SearchStatus::kFound;  // a way out, at least
  if (found && end_ == SpanSearch::End::kGoal) return false;
  const auto is_enclosed = [&](const Eigen::Vector3d& p) {
    if (!space.map->InWindow(space.map->CellOf(p))) return false;
    const SearchStatus status = search_.Escape(space, p, kAllSpans);
    return status == SearchStatus::kNoPath || status == SearchStatus::kEndsBlocked;
  };
  return (!found && is_enclosed(from)) || is_enclosed(goal);
}

double Lookout::Least(const OccupancyMap& map, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& goal) const {
  const Eigen::Array3d way = (map.CellOf(goal) - map.CellOf(from)).cast<double>().array().abs();
  const double longer = way.head<2>().maxCoeff(), shorter = way.head<2>().minCoeff();
  return map.resolution() *
         (longer + (std::numbers::sqrt2 - 1.0) * shorter + cost_.vertical * way.z());
}

void Lookout::BeginAt(const Eigen::Vector3d& from) {
  begin_ = seen_until_ = {from, 0.0};
  seen_places_ = 0;
}

bool Lookout::NoteNeeded(const HullSpace& hull, const Eigen::Vector3d& from) {
  const OccupancyMap& map = *hull.space->map;
  needed_.clear();
  marks_.Begin(map);
  double along = 0.0;
  const auto note = [&](const CellIndex& cell) {
    if (!map.InWindow(cell) || map.IsOccupied(cell)) return true;
    Mark& mark = marks_.At(cell);  // it is touched at several places
    if (mark == kNone) needed_.push_back({cell, std::exp(-along / kSoon)});
    mark = kReached;
    return true;
  };
  ForEachUnseen(hull, from, note);
  BeginAt(from);
  Eigen::Vector3d before = from;
  for (const Eigen::Vector3d& place : path_) {
    if (!needed_.empty() && along > seen_until_.way + kFar) break;
    const double length = (place - before).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kBetweenBalls)));
    for (int i = 1; i <= steps; ++i) {
      along += length / steps;
      const Eigen::Vector3d p = before + (place - before) * i / steps;
      ForEachUnseen(hull, p, note);
      if (!needed_.empty()) continue;
      seen_until_ = {p, along};
      along_ = place - before;
    }
    if (needed_.empty()) ++seen_places_;
    before = place;
  }
  const std::size_t every = 1 + needed_.size() / kMostNeeded;
  for (std::size_t i = 0; i * every < needed_.size(); ++i) needed_[i] = needed_[i * every];
  needed_.resize((needed_.size() + every - 1) / every);
  return !needed_.empty();
}

bool Lookout::NoteDoubted(const FreeSpace& space, const Eigen::Vector3d& goal) {
  const OccupancyMap& map = *space.map;
  needed_.clear();
  if (!space.Blocked(goal)) return false;
  const double reach = map.options().inflation_radius + map.resolution();
  const CellIndex low = map.CellOf(goal.array() - reach), high = map.CellOf(goal.array() + reach);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const CellIndex cell(x, y, z);
        const bool near = (map.CentreOf(cell) - goal).norm() < reach;
        if (near && map.IsOccupied(cell)) needed_.push_back({cell, 1.0});
      }
    }
  }
  return !needed_.empty();
}

/// Beside the vehicle cells may be unseen that its camera passed.
bool Lookout::Fits(const HullSpace& hull, const Eigen::Vector3d& p,
                   const Eigen::Vector3d& start) const {
  const OccupancyMap& map = *hull.space->map;
  return !hull.space->Blocked(p) && ForEachUnseen(hull, p, [&](const CellIndex& cell) {
    return !map.IsOccupied(cell) &&
           WasThere(cell, start, p, hull.radius() + kSweepRoom, map.resolution());
  });
}

bool Lookout::Leads(const HullSpace& hull, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b) const {
  return FitsBetween(hull, a, b) && Fits(hull, b, a);
}

bool Lookout::FitsBetween(const HullSpace& hull, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) const {
  const int steps = static_cast<int>(std::ceil((b - a).norm() / kBetweenTested));
  for (int i = 1; i < steps; ++i) {
    if (!Fits(hull, a + (b - a) * i / steps, a)) return false;
  }
  return true;
}

/// Adds the places to which cells lead that were seen free, the nearest first: few far apart in the open, more where it
/// is narrow. In such a place as many again in each longer step: so it comes out of a shaft.
void Lookout::Flood(const HullSpace& hull, const Place& from) {
  marks_.Begin(*hull.space->map);
  const std::size_t before = places_.size();
  std::size_t most = before + kMostPlaces;
  Mark reached = kReached;
  const auto* apart = std::begin(kApartAt);
  for (;; ++apart) {
    places_.resize(before);
    places_.push_back(from);
    Spread(hull, before, most, *apart, reached++);
    if (places_.size() == most || apart + 1 == std::end(kApartAt)) break;
  }
  while (places_.size() == most && apart != std::begin(kApartAt)) {
    most += kMostPlaces;
    Spread(hull, before, most, *--apart, reached++);
  }
}

/// Whether a hull fits whose centre is so many cells beyond `from`, or was reached. It stands for the next strides.
Lookout::Mark Lookout::MarkAt(const HullSpace& hull, const Eigen::Vector3d& from,
                              const CellIndex& cells) {
  const OccupancyMap& map = *hull.space->map;
  const CellIndex cell = map.CellOf(from) + cells;
  if (!map.InWindow(cell)) return kClosed;
  Mark& mark = marks_.At(cell);
  if (mark == kNone) {
    const Eigen::Vector3d p = from + map.resolution() * cells.cast<double>();
    mark = Fits(hull, p, begin_.p_W) ? kFits : kClosed;
  }
  return mark;
}

/// Adds places, so far apart [m], to those from `first` on, until there are so many.
void Lookout::Spread(const HullSpace& hull, std::size_t first, std::size_t most, double apart,
                     Mark reached) {
  const double side = hull.space->map->resolution();
  const int stride = std::max(1, static_cast<int>(std::lround(apart / side)));
  const Eigen::Vector3d from_W = places_[first].p_W;
  const CellIndex origin = hull.space->map->CellOf(from_W);
  const auto step_of = [&](int i) -> CellIndex {
    return stride * CellIndex(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
  };
  const auto later = [](const Entry& a, const Entry& b) {
    return a.way != b.way ? a.way > b.way : a.number > b.number;
  };
  const auto leave = [&](const CellIndex& node, std::size_t place) {
    for (int i = 0; i < 27; ++i) {
      const CellIndex next = node + step_of(i);
      if (const Mark mark = MarkAt(hull, from_W, next); mark == kClosed || mark == reached) {
        continue;
      }
      queue_.push_back({places_[place].way + side * step_of(i).cast<double>().norm(), next,
                        27 * static_cast<int>(place) + i});
      std::push_heap(queue_.begin(), queue_.end(), later);
    }
  };
  queue_.clear();
  for (std::size_t place = first; place < places_.size(); ++place) {
    const CellIndex node = ((places_[place].p_W - from_W) / side).array().round().cast<int>();
    if ((node.array() / stride * stride != node.array()).any()) continue;
    marks_.At(origin + node) = reached;
    leave(node, place);
  }
  while (!queue_.empty() && places_.size() < most) {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const Entry at = queue_.back();
    queue_.pop_back();
    if (marks_.At(origin + at.node) == reached) continue;
    // Few of the ways between places are taken: so they are tested here.
    const CellIndex step = step_of(at.number % 27);
    const double length = side * step.cast<double>().norm();
    const int tests = static_cast<int>(std::ceil(length / kBetweenTested));
    int passed = 1;
    const auto fits = [&](const CellIndex& node) { return MarkAt(hull, from_W, node) != kClosed; };
    while (passed < tests && fits(at.node - step * passed / tests)) ++passed;
    if (passed < tests) continue;
    marks_.At(origin + at.node) = reached;
    places_.push_back({from_W + side * at.node.cast<double>(), at.way, at.number / 27});
    leave(at.node, places_.size() - 1);
  }
}

/// @param place  of those of the flood; -1: where the seen part of the way ends.
const Look* Lookout::LookFrom(const Viewpoint& from, int place) {
  const auto at = [&](int i) -> const Place& { return places_[static_cast<std::size_t>(i)]; };
  look_.from = from;
  look_.way = place < 0 ? seen_until_.way : at(place).way;
  look_.cells.clear();
  look_.camera = 0;
  GuidePath& way_W = look_.way_W;
  way_W.clear();
  for (; place >= 0; place = at(place).from) way_W.push_back(at(place).p_W);
  if (way_W.empty() || way_W.back() == seen_until_.p_W) {
    way_W.push_back(seen_until_.p_W);
    way_W.insert(way_W.end(), path_.rend() - static_cast<std::ptrdiff_t>(seen_places_),
                 path_.rend());
    way_W.push_back(begin_.p_W);
  }
  std::reverse(way_W.begin(), way_W.end());
  return &look_;
}

const Look* Lookout::Onwards(double yaw, const std::vector<Viewpoint>& struck) {
  const bool upright = along_.head<2>().norm() < 1e-6;
  const Viewpoint from = {seen_until_.p_W, upright ? yaw : std::atan2(along_.y(), along_.x())};
  return IsStruck(from, struck) ? nullptr : LookFrom(from, -1);
}

const Look* Lookout::Around(const Eigen::Vector3d& from, double yaw) {
  BeginAt(from);
  return LookFrom({from, estimation::WrapAngle(yaw + 0.5 * std::numbers::pi)}, -1);
}

const Look* Lookout::Highest(const HullSpace& hull, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& goal) {
  BeginAt(from);
  places_.clear();
  Flood(hull, begin_);
  const auto lower = [](const Place& a, const Place& b) { return a.p_W.z() < b.p_W.z(); };
  const auto highest = std::max_element(places_.begin(), places_.end(), lower);
  const Eigen::Vector3d to = goal - highest->p_W;
  return LookFrom({highest->p_W, std::atan2(to.y(), to.x())},
                  static_cast<int>(highest - places_.begin()));
}

void Lookout::FindCandidates(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                             const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                             const std::vector<Viewpoint>& struck, std::size_t apart) {
  const OccupancyMap& map = *hull.space->map;
  places_.clear();
  Flood(hull, begin_);
  if (seen_until_.way > 0.0) Flood(hull, seen_until_);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double all = 0.0;
  for (const Needed& needed : needed_) {
    middle += needed.worth * map.CentreOf(needed.cell);
    all += needed.worth;
  }
  middle /= all;

  candidates_.clear();
  const double yaw_now = estimation::Yaw(vehicle.q_WB);
  const double lowest =
      hull.pad != nullptr ? LowestRest(vehicle.t, hull) : -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    const Eigen::Vector3d to = middle - place.p_W;
    const Viewpoint from = {place.p_W, std::atan2(to.y(), to.x())};
    const bool in_pads_way = hull.space->OverPad(place.p_W) && place.p_W.z() < lowest;
    if (in_pads_way || IsStruck(from, struck)) continue;
    const double turn = std::abs(estimation::WrapAngle(from.yaw - yaw_now));
    const double time = std::max(place.way / kFlies, turn / kTurns) + kStays;
    double worth = 0.0;
    for (const LookCamera& camera : cameras) {
      const Sight sight(camera, from, pull_W);
      for (std::size_t k = 0; k < needed_.size(); k += apart) {
        if (sight.Holds(map.CentreOf(needed_[k].cell))) worth += needed_[k].worth;
      }
    }
    if (worth > 0.0) candidates_.push_back({worth / time, from, static_cast<int>(i), time});
  }
  const auto better = [](const Candidate& a, const Candidate& b) {
    return a.worth != b.worth ? a.worth > b.worth : a.place < b.place;
  };
  std::sort(candidates_.begin(), candidates_.end(), better);
}

/// Notes which of every so many needed cells are in sight of the candidate; returns their worth over the time.
double Lookout::Trace(const OccupancyMap& map, const std::vector<LookCamera>& cameras,
                      const Candidate& candidate, const Eigen::Vector3d& pull_W,
                      std::size_t apart) {
  seen_.clear();
  sights_.clear();
  for (const LookCamera& camera : cameras) sights_.emplace_back(camera, candidate.from, pull_W);
  double worth = 0.0;
  for (std::size_t i = 0; i < needed_.size(); i += apart) {
    const Needed& needed = needed_[i];
    const bool seen = std::any_of(sights_.begin(), sights_.end(), [&](const Sight& sight) {
      return sight.Holds(map.CentreOf(needed.cell)) && sight.Reaches(needed.cell, map);
    });
    if (!seen) continue;
    seen_.push_back(needed.cell);
    worth += needed.worth / candidate.time;
  }
  return worth;
}

const Look* Lookout::Choose(const HullSpace& hull, const std::vector<LookCamera>& cameras,
                            const estimation::VehicleState& vehicle, const Eigen::Vector3d& pull_W,
                            const std::vector<Viewpoint>& struck) {
  const OccupancyMap& map = *hull.space->map;
  const std::size_t apart = 1 + needed_.size() / kSample;
  FindCandidates(hull, cameras, vehicle, pull_W, struck, apart);
  const Candidate* best = nullptr;
  double most = 0.0;
  for (const Candidate& candidate : candidates_) {
    if (candidate.worth <= most) break;
    const double worth = Trace(map, cameras, candidate, pull_W, apart);
    if (worth <= most) continue;
    most = worth;
    best = &candidate;
  }
  if (best == nullptr) return nullptr;
  Trace(map, cameras, *best, pull_W, 1);
  LookFrom(best->from, best->place);
  look_.cells = seen_;
  const auto held = [&](const Sight& sight) {
    return std::count_if(seen_.begin(), seen_.end(),
                         [&](const CellIndex& cell) { return sight.Holds(map.CentreOf(cell)); });
  };
  const auto fewer = [&](const Sight& a, const Sight& b) { return held(a) < held(b); };
  const auto sight = std::max_element(sights_.begin(), sights_.end(), fewer);
  look_.camera = static_cast<std::size_t>(sight - sights_.begin());
  return &look_;
}

}  // namespace touchdown::planning
