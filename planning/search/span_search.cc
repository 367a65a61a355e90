// SPDX-License-Identifier: BSD-3-Clause
// A* (P. Hart, N. Nilsson and B. Raphael 1968) from column to column. Spans of columns are how navigation
// meshes see a scene (M. Mononen, Recast); here they keep the way's height free until the way is known.

#include "planning/search/span_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

namespace {

// Room at first; a search that needs more makes more.
constexpr std::size_t kUsualCosts = 1 << 18, kUsualGates = 1024;
constexpr std::size_t kUsualEntries = 4;  // of a column

struct Step {
  int x, y;
  float length;
};
constexpr float kDiagonal = std::numbers::sqrt2_v<float>;
constexpr std::array<Step, 8> kSteps = {{{1, 0, 1.0f},
                                         {-1, 0, 1.0f},
                                         {0, 1, 1.0f},
                                         {0, -1, 1.0f},
                                         {1, 1, kDiagonal},
                                         {1, -1, kDiagonal},
                                         {-1, 1, kDiagonal},
                                         {-1, -1, kDiagonal}}};
constexpr int kStraightSteps = 4;     // come first
constexpr int kSelf = kSteps.size();  // no step at all
constexpr float kStepsOfCell = 4.0f;  // of f, that the queue distinguishes, ...
constexpr float kFarthest = 1e6f;     // ... up to here
constexpr double kGateMargin = 1.0;   // of a way from the edges of a gate that has room [cells]

/// A span that can be reached from another.
struct Reached {
  int x, y, id, z, step;
};

/// The queue's room grows with what ways cost.
void RequireFactor(const char* name, double value) {
  if (value >= 1.0 && value <= 100.0) return;
  throw std::invalid_argument(std::string("SpanSearch: ") + name + " is " + std::to_string(value) +
                              ", it must be in [1, 100]");
}

}  // namespace

SpanSearch::Queue::Queue() { first_.reserve(kUsualCosts); }

void SpanSearch::Queue::Clear() {
  std::fill(first_.begin(), first_.end(), -1);
  entries_.clear();
  least_ = 0;
  waiting_ = 0;
}

void SpanSearch::Queue::Push(float f, std::uint32_t address) {
  const auto at = static_cast<std::size_t>(std::min(kStepsOfCell * f, kFarthest));
  if (at >= first_.size()) first_.resize(at + 1, -1);
  entries_.push_back({address, first_[at]});
  first_[at] = static_cast<std::int32_t>(entries_.size()) - 1;
  least_ = std::min(least_, at);
  ++waiting_;
}

std::uint32_t SpanSearch::Queue::Pop() {
  while (first_[least_] < 0) ++least_;
  const Entry& entry = entries_[static_cast<std::size_t>(first_[least_])];
  first_[least_] = entry.next;
  --waiting_;
  return entry.address;
}

SpanSearch::SpanSearch(const PathCost& cost, double greed) : greed_(static_cast<float>(greed)) {
  RequireFactor("greed", greed);
  set_cost(cost);
}

void SpanSearch::set_cost(const PathCost& cost) {
  RequireFactor("vertical cost", cost.vertical);
  RequireFactor("tight cost", cost.tight);
  vertical_cost_ = static_cast<float>(cost.vertical);
  tight_cost_ = static_cast<float>(cost.tight);
}

void SpanSearch::Reserve(const OccupancyMap& map) {
  columns_.Reserve(map);
  way_.reserve(kUsualGates);
  gates_.reserve(kUsualGates);
  const auto columns = static_cast<std::size_t>(map.size().head<2>().prod());
  queue_.Reserve(kUsualEntries * columns);
  if (nodes_.size() == columns * ColumnSpans::kMost) return;
  nodes_.assign(columns * ColumnSpans::kMost, Node());
  search_ = 0;
}

void SpanSearch::Forget(GuidePath* path) {
  path->clear();
  expansions_ = 0;
  cost_ = 0.0;
  end_ = End::kGoal;
}

SearchStatus SpanSearch::Search(const FreeSpace& space, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to, int max_expansions, GuidePath* path,
                                std::span<const Barrier> barriers, double max_cost) {
  Forget(path);
  const OccupancyMap& map = *space.map;
  CellIndex goal = map.CellOf(to);
  if (!map.InWindow(goal)) return SearchStatus::kEndsOutside;
  if (!GridSearch::NearestFree(space, &goal)) return SearchStatus::kEndsBlocked;
  return SearchFrom(space, map.CellOf(from), goal, End::kGoal, max_expansions, path, barriers,
                    max_cost);
}

SearchStatus SpanSearch::SearchOut(const FreeSpace& space, const Eigen::Vector3d& from,
                                   const Eigen::Vector3d& to, int max_expansions, GuidePath* path) {
  Forget(path);
  const OccupancyMap& map = *space.map;
  CellIndex goal = map.CellOf(to);
  const int level = goal.z(), lowest = map.origin().z();
  goal.z() = std::clamp(level, lowest, lowest + map.size().z() - 1);
  const bool inside = map.InWindow(goal);
  if (inside && !GridSearch::NearestFree(space, &goal)) return SearchStatus::kEndsBlocked;
  // A goal that is enclosed is soon known to be; from outside all would have to be searched.
  CellIndex start = map.CellOf(from);
  if (!map.InWindow(start)) return SearchStatus::kEndsOutside;
  if (!GridSearch::NearestFree(space, &start)) return SearchStatus::kEndsBlocked;
  const bool enclosed =
      inside && Escape(space, map.CentreOf(goal), max_expansions) == SearchStatus::kNoPath &&
      !Passed(start);
  SearchStatus status = SearchStatus::kNoPath;
  for (const End end : {End::kGoal, End::kSide, End::kAnywhere}) {
    if ((end == End::kGoal && (!inside || enclosed)) || status != SearchStatus::kNoPath) continue;
    status = SearchFrom(space, start, goal, end, max_expansions, path, {},
                        std::numeric_limits<double>::infinity());
    end_ = end;
  }
  cost_ += vertical_cost_ * map.resolution() * std::abs(level - goal.z());
  return status;
}

SearchStatus SpanSearch::Escape(const FreeSpace& space, const Eigen::Vector3d& from,
                                int max_expansions) {
  const OccupancyMap& map = *space.map;
  const CellIndex start = map.CellOf(from);
  // Towards the nearest side.
  const Eigen::Array2i to_low = (start - map.origin()).head<2>();
  const Eigen::Array2i to_high = map.size().head<2>().array() - 1 - to_low;
  int axis = 0;
  to_low.min(to_high).minCoeff(&axis);
  CellIndex side = start;
  side[axis] += to_low[axis] < to_high[axis] ? -to_low[axis] : to_high[axis];
  return SearchFrom(space, start, side, End::kAnywhere, max_expansions, nullptr, {},
                    std::numeric_limits<double>::infinity());
}

SearchStatus SpanSearch::SearchFrom(const FreeSpace& space, CellIndex start, CellIndex goal,
                                    End end, int max_expansions, GuidePath* path,
                                    std::span<const Barrier> barriers, double max_cost) {
  const OccupancyMap& map = *space.map;
  if (!map.InWindow(start)) return SearchStatus::kEndsOutside;
  if (!GridSearch::NearestFree(space, &start)) return SearchStatus::kEndsBlocked;
  Reserve(map);
  columns_.Begin(space, barriers);
  if (++search_ > kMostSearches) {
    std::fill(nodes_.begin(), nodes_.end(), Node());
    search_ = 1;
  }
  // From here on cells are counted from the window's lowest one.
  origin_ = map.origin();
  start -= origin_;
  goal -= origin_;
  const SearchStatus status =
      SearchOn(start, goal, end, max_expansions, static_cast<float>(max_cost / map.resolution()));
  if (status != SearchStatus::kFound || path == nullptr) return status;
  cost_ *= map.resolution();
  if (end != End::kGoal) goal = {way_.back().x, way_.back().y, end_z_};
  Straighten(start.z(), goal.z());
  for (std::size_t i = 0; i < way_.size(); ++i) {
    // Between the gates at both sides of a column, which are within its span.
    const double z = 0.5 * (gates_[i].z + gates_[i + 1].z);
    path->push_back(map.CentreOf(CellIndex(way_[i].x, way_[i].y, 0) + map.origin()));
    path->back().z() += z * map.resolution();
  }
  path->front() = map.CentreOf(start + map.origin());
  if (way_.size() == 1) path->push_back(path->front());
  path->back() = map.CentreOf(goal + map.origin());
  return status;
}

SearchStatus SpanSearch::SearchOn(const CellIndex& start, const CellIndex& goal, End end,
                                  int max_expansions, float max_cost) {
  queue_.Clear();
  expansions_ = 0;
  const int nx = columns_.size().x(), ny = columns_.size().y();
  const auto address = [&](int x, int y, int id) {
    return static_cast<std::uint32_t>((id * ny + y) * nx + x);
  };
  const auto to_goal = [&](int x, int y, int z) {
    const int dx = std::abs(x - goal.x()), dy = std::abs(y - goal.y());
    const auto straight = static_cast<float>(std::abs(dx - dy));
    return straight + kDiagonal * static_cast<float>(std::min(dx, dy)) +
           vertical_cost_ * static_cast<float>(std::abs(z - goal.z()));
  };
  const bool out = end != End::kGoal;
  const int start_id = columns_.IdAt(start), goal_id = out ? 0 : columns_.IdAt(goal);
  if (start_id < 0 || goal_id < 0) return SearchStatus::kNoPath;  // a barrier closes an end
  const int top = columns_.levels() - 1;
  const auto ends = [&](std::uint32_t here, int x, int y, int id) {
    if (!out) return here == address(goal.x(), goal.y(), goal_id);
    const FreeSpan& span = columns_.At(x, y, id);
    if (end == End::kAnywhere && (span.high == top || span.low == 0)) return true;
    return x == 0 || y == 0 || x == nx - 1 || y == ny - 1;
  };
  const auto see = [&](const Reached& at, float g, int from_id) {
    const float left = to_goal(at.x, at.y, at.z);
    if (g + left > max_cost) return;
    const std::uint32_t a = address(at.x, at.y, at.id);
    Node& node = nodes_[a];
    if (node.search == search_ && (node.closed || g >= node.g)) return;
    node.g = g;
    node.search = search_;
    node.closed = 0;
    node.z = static_cast<std::int16_t>(at.z);
    node.step = static_cast<std::uint8_t>(at.step);
    node.from_id = static_cast<std::uint8_t>(from_id);
    queue_.Push(g + greed_ * left, a);
  };
  see({start.x(), start.y(), start_id, start.z(), kSelf}, 0.0f, 0);

  std::array<Reached, kSteps.size() * ColumnSpans::kMost> reached;
  while (!queue_.empty()) {
    const std::uint32_t here = queue_.Pop();
    Node& node = nodes_[here];
    if (node.closed) continue;  // an older, longer entry of the same span
    node.closed = 1;
    const auto row = static_cast<int>(here) / nx;
    const int x = static_cast<int>(here) % nx, y = row % ny, id = row / ny, z = node.z;
    if (ends(here, x, y, id)) {
      const FreeSpan& last = columns_.At(x, y, id);
      const bool up = end == End::kAnywhere && last.high == top;
      const bool down = end == End::kAnywhere && !up && last.low == 0;
      end_z_ = up ? top : down ? 0 : z;
      cost_ = node.g + vertical_cost_ * static_cast<float>(std::abs(end_z_ - z)) +
              to_goal(out ? x : goal.x(), out ? y : goal.y(), end_z_);
      TraceBack(x, y, id);
      return SearchStatus::kFound;
    }
    if (expansions_ >= max_expansions) return SearchStatus::kExpansionLimit;
    ++expansions_;
    const FreeSpan own = columns_.At(x, y, id);
    std::size_t count = 0;
    bool tight = false;
    for (int s = 0; s < kSelf; ++s) {
      const Step& step = kSteps[static_cast<std::size_t>(s)];
      const int to_x = x + step.x, to_y = y + step.y;
      if (to_x < 0 || to_y < 0 || to_x >= nx || to_y >= ny) continue;
      bool level = false;
      const int spans = columns_.Count(to_x, to_y);
      for (int to_id = 0; to_id < spans; ++to_id) {
        const FreeSpan& span = columns_.At(to_x, to_y, to_id);
        const int low = std::max(own.low, span.low), high = std::min(own.high, span.high);
        if (low > high) continue;
        const int to_z = std::clamp(z, low, high);
        // Between two corners that touch nothing fits.
        const bool fits = s < kStraightSteps || columns_.IdAt({to_x, y, to_z}) >= 0 ||
                          columns_.IdAt({x, to_y, to_z}) >= 0;
        if (!fits) continue;
        level |= to_z == z;
        const Node& there = nodes_[address(to_x, to_y, to_id)];
        if (there.search == search_ && there.closed) continue;
        reached[count++] = {to_x, to_y, to_id, to_z, s};
      }
      tight |= !level;
    }
    const float factor = tight ? tight_cost_ : 1.0f;
    const float g_here = node.g;
    for (std::size_t i = 0; i < count; ++i) {
      const Reached& next = reached[i];
      const float along = kSteps[static_cast<std::size_t>(next.step)].length;
      const auto up = static_cast<float>(std::abs(next.z - z));
      see(next, g_here + factor * along + vertical_cost_ * up, id);
    }
  }
  return SearchStatus::kNoPath;
}

/// By the last search.
bool SpanSearch::Passed(const CellIndex& cell) {
  const CellIndex at = cell - origin_;
  const Eigen::Vector2i& size = columns_.size();
  if ((at.array() < 0).any() || (at.head<2>().array() >= size.array()).any()) return false;
  const int id = columns_.IdAt(at);
  const auto address = static_cast<std::size_t>((id * size.y() + at.y()) * size.x() + at.x());
  return id >= 0 && nodes_[address].search == search_ && nodes_[address].closed;
}

/// The spans from the start to here.
void SpanSearch::TraceBack(int x, int y, int id) {
  way_.clear();
  for (;;) {
    way_.push_back({x, y, columns_.At(x, y, id)});
    const Eigen::Vector2i& size = columns_.size();
    const Node& node = nodes_[static_cast<std::size_t>((id * size.y() + y) * size.x() + x)];
    if (node.step == kSelf) break;
    x -= kSteps[node.step].x;
    y -= kSteps[node.step].y;
    id = node.from_id;
  }
  std::reverse(way_.begin(), way_.end());
}

/// The shortest profile of heights through the gates between the columns: a string pulled tight. Gate i is
/// between the columns i - 1 and i; the ends are points.
void SpanSearch::Straighten(double from, double to) {
  gates_.assign(1, {0.0, from, from, from});
  for (std::size_t i = 1; i < way_.size(); ++i) {
    const Place &a = way_[i - 1], &b = way_[i];
    double low = std::max(a.span.low, b.span.low), high = std::min(a.span.high, b.span.high);
    const double margin = std::min(kGateMargin, 0.5 * (high - low));
    const double width = std::hypot(b.x - a.x, b.y - a.y);
    gates_.push_back({gates_.back().at + width, low + margin, high - margin, 0.0});
  }
  gates_.push_back({gates_.back().at + 1.0, to, to, to});
  const std::size_t last = gates_.size() - 1;
  for (std::size_t apex = 0; apex < last;) {
    const Gate& tip = gates_[apex];
    // The slopes that pass all gates so far, and the gates that bound them.
    double least = -std::numeric_limits<double>::infinity(), most = -least;
    std::size_t least_at = apex, most_at = apex, next = last;
    double z = to;
    for (std::size_t i = apex + 1; i <= last; ++i) {
      const double to_low = (gates_[i].low - tip.z) / (gates_[i].at - tip.at);
      const double to_high = (gates_[i].high - tip.z) / (gates_[i].at - tip.at);
      if (to_low > most) {  // the string bends at what held it down ...
        next = most_at;
        z = gates_[next].high;
        break;
      }
      if (to_high < least) {  // ... or up
        next = least_at;
        z = gates_[next].low;
        break;
      }
      if (to_high <= most) most = to_high, most_at = i;
      if (to_low >= least) least = to_low, least_at = i;
    }
    const double slope = (z - tip.z) / (gates_[next].at - tip.at);
    for (std::size_t i = apex + 1; i <= next; ++i) {
      gates_[i].z = tip.z + slope * (gates_[i].at - tip.at);
    }
    apex = next;
  }
}

}  // namespace touchdown::planning
