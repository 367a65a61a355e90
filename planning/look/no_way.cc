// SPDX-License-Identifier: BSD-3-Clause
// A flood that goes where it is widest first. The distances to what is occupied come axis by axis (T. Saito and
// J. Toriwaki 1994), up to half of the greatest width.
#include "touchdown/planning/look/no_way.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchdown::planning {
namespace {

/// Squared distances of all cells of a window to the nearest occupied one [cells], up to a greatest one.
class Distances {
 public:
  Distances(const OccupancyMap& map, int most) : size_(map.size()), most_(most) {
    squares_.resize(static_cast<std::size_t>(size_.prod()));
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      squares_[i] = map.IsOccupied(map.origin() + CellAt(i)) ? 0 : most_ * most_;
    }
    std::size_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      Sweep(axis, stride);
      stride *= static_cast<std::size_t>(size_[axis]);
    }
  }

  std::size_t IndexOf(const CellIndex& cell) const {
    return static_cast<std::size_t>((cell.z() * size_.y() + cell.y()) * size_.x() + cell.x());
  }
  CellIndex CellAt(std::size_t index) const {
    const auto i = static_cast<int>(index);
    return {i % size_.x(), i / size_.x() % size_.y(), i / (size_.x() * size_.y())};
  }
  bool Holds(const CellIndex& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
  }
  std::size_t count() const { return squares_.size(); }
  int At(std::size_t index) const { return squares_[index]; }

 private:
  void Sweep(int axis, std::size_t stride) {
    const int length = size_[axis];
    std::vector<int> line(static_cast<std::size_t>(length));
    for (std::size_t first = 0; first < squares_.size(); ++first) {
      if (CellAt(first)[axis] != 0) continue;
      for (int i = 0; i < length; ++i) {
        int least = most_ * most_;
        for (int k = std::max(0, i - most_); k <= std::min(length - 1, i + most_); ++k) {
          const int there = squares_[first + static_cast<std::size_t>(k) * stride];
          least = std::min(least, there + (i - k) * (i - k));
        }
        line[static_cast<std::size_t>(i)] = least;
      }
      for (int i = 0; i < length; ++i) {
        squares_[first + static_cast<std::size_t>(i) * stride] = line[static_cast<std::size_t>(i)];
      }
    }
  }

  CellIndex size_;
  int most_;
  std::vector<int> squares_;
};

}  // namespace

double LeastGap(const OccupancyMap& map) {
  const double cells = (map.options().inflation_radius + kChordSagitta) / map.resolution();
  return map.resolution() * (2.0 * std::ceil(cells) + 1.0);
}

std::optional<NarrowPlace> FindNarrowPlace(const OccupancyMap& map, const Eigen::Vector3d& from,
                                           const Eigen::Vector3d& to, double floor,
                                           double ceiling) {
  const double bottom = (map.origin().z() + 0.5) * map.resolution();
  const auto level_in = [&](const Eigen::Vector3d& p_W) {
    CellIndex cell = map.CellOf(p_W) - map.origin();
    cell = cell.cwiseMax(CellIndex::Zero()).cwiseMin(map.size() - CellIndex::Ones());
    const auto low = static_cast<int>(std::ceil((floor - bottom) / map.resolution()));
    const double last = map.size().z() - 1;
    const auto high =
        static_cast<int>(std::min(last, std::floor((ceiling - bottom) / map.resolution())));
    cell.z() = std::min(std::max({cell.z(), low, 0}), high);
    return cell;
  };
  const CellIndex start = level_in(from), goal = level_in(to);
  const auto most = static_cast<int>(std::lround(0.5 * NarrowPlace::kWidest / map.resolution()));
  const Distances distances(map, most);
  const auto is_free = [&](const CellIndex& cell) {
    return distances.Holds(cell) && distances.At(distances.IndexOf(cell)) > 0;
  };
  if (!is_free(start) || !is_free(goal)) return std::nullopt;

  constexpr std::uint8_t kNotReached = 0xff, kStart = 0xfe;
  std::vector<std::uint8_t> came_by(distances.count(), kNotReached);
  // What was reached, by how wide it is there; the widest comes first.
  std::vector<std::vector<std::size_t>> reached(static_cast<std::size_t>(most * most) + 1);
  const auto step = [](int i) { return CellIndex(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1); };
  const std::size_t begin = distances.IndexOf(start), end = distances.IndexOf(goal);
  came_by[begin] = kStart;
  auto widest = static_cast<std::size_t>(distances.At(begin));
  reached[widest].push_back(begin);
  while (came_by[end] == kNotReached) {
    while (widest > 0 && reached[widest].empty()) --widest;
    if (widest == 0) return std::nullopt;
    const std::size_t here = reached[widest].back();
    reached[widest].pop_back();
    for (int i = 0; i < 27; ++i) {
      const CellIndex cell = distances.CellAt(here) + step(i);
      if (!distances.Holds(cell)) continue;
      const double level = map.CentreOf(map.origin() + cell).z();
      const std::size_t there = distances.IndexOf(cell);
      if (came_by[there] != kNotReached || level < floor || level > ceiling) continue;
      came_by[there] = static_cast<std::uint8_t>(i);
      const auto width = static_cast<std::size_t>(distances.At(there));
      reached[width].push_back(there);
      widest = std::max(widest, width);
    }
  }

  std::size_t narrowest = end;
  for (std::size_t at = end; at != begin;) {
    at = distances.IndexOf(distances.CellAt(at) - step(came_by[at]));
    if (distances.At(at) < distances.At(narrowest)) narrowest = at;
  }
  return NarrowPlace{map.CentreOf(map.origin() + distances.CellAt(narrowest)),
                     map.resolution() * (2.0 * std::sqrt(distances.At(narrowest)) - 1.0)};
}

}  // namespace touchdown::planning
