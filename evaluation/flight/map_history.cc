// SPDX-License-Identifier: BSD-3-Clause
// Rows of the window are compared as words of bits first: most of them are the same from step to step.
#include "evaluation/flight/map_history.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace touchdown::evaluation {
namespace {

using planning::CellIndex;
using planning::CellState;

// Appends the runs of cells in which a row of `count` cells from `first` on differs.
void CompareRow(const CellState* before, const CellState* after, int count, const CellIndex& first,
                std::vector<MapRun>* runs) {
  for (int i = 0; i < count;) {
    if (before[i] == after[i]) {
      ++i;
      continue;
    }
    MapRun run{first + i * CellIndex::UnitX(), 0, after[i]};
    // A run may include a cell that had the state already: fewer runs say the same.
    for (; i < count && after[i] == run.state; ++i) ++run.count;
    runs->push_back(run);
  }
}

constexpr int kWord = 64;  // cells

// The 64 cells from `from` on of a row of `words` words. Cells outside of the row count as not set.
std::uint64_t BitsFrom(const std::uint64_t* row, int words, int from) {
  const auto word = [&](int i) { return i >= 0 && i < words ? row[i] : 0; };
  const int first = from >= 0 ? from / kWord : -((kWord - 1 - from) / kWord);
  const int bit = from - first * kWord;
  return bit == 0 ? word(first) : word(first) >> bit | word(first + 1) << (kWord - bit);
}

void PutStates(std::uint64_t bits, CellState state, CellState* of) {
  for (; bits != 0; bits &= bits - 1) of[std::countr_zero(bits)] = state;
}

}  // namespace

const char* ToString(CellState state) {
  switch (state) {
    case CellState::kUnknown:
      return "unknown";
    case CellState::kFree:
      return "free";
    case CellState::kOccupied:
      return "occupied";
  }
  return "unknown";
}

MapChange MapRecorder::Take(const planning::OccupancyMap& map) {
  MapChange change;
  change.origin = map.origin();
  const CellIndex& size = map.size();
  const int words = (size.x() + kWord - 1) / kWord;
  const int in_word = std::min(kWord, size.x());
  const auto all = static_cast<std::size_t>(words) * static_cast<std::size_t>(size.y()) *
                   static_cast<std::size_t>(size.z());
  for (States* states : {&states_, &now_}) {
    states->free.resize(all);
    states->occupied.resize(all);
  }
  const CellIndex shift = change.origin - origin_;
  std::vector<CellState> before(static_cast<std::size_t>(words * kWord)), after(before);
  std::size_t row = 0;
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y, row += static_cast<std::size_t>(words)) {
      const int old_y = y + shift.y(), old_z = z + shift.z();
      const bool in_old = old_y >= 0 && old_y < size.y() && old_z >= 0 && old_z < size.z();
      const auto old_row =
          static_cast<std::size_t>(in_old ? (old_z * size.y() + old_y) * words : 0);
      const auto were = [&](const std::vector<std::uint64_t>& bits, int x) {
        if (!in_old) return std::uint64_t{0};
        return BitsFrom(&bits[old_row], words, x + shift.x()) &
               ~std::uint64_t{0} >> (kWord - in_word);
      };
      bool same = true;
      for (int i = 0; i < words; ++i) {
        const CellIndex first = change.origin + CellIndex(i * kWord, y, z);
        const std::size_t at = row + static_cast<std::size_t>(i);
        now_.free[at] = map.ObservedFreeRow(first, in_word);
        now_.occupied[at] = map.OccupiedRow(first, in_word);
        same = same && now_.free[at] == were(states_.free, i * kWord) &&
               now_.occupied[at] == were(states_.occupied, i * kWord);
      }
      if (same) continue;
      std::fill(before.begin(), before.end(), CellState::kUnknown);
      std::fill(after.begin(), after.end(), CellState::kUnknown);
      for (int i = 0; i < words; ++i) {
        const std::size_t at = row + static_cast<std::size_t>(i);
        PutStates(were(states_.free, i * kWord), CellState::kFree, &before[i * kWord]);
        PutStates(were(states_.occupied, i * kWord), CellState::kOccupied, &before[i * kWord]);
        PutStates(now_.free[at], CellState::kFree, &after[i * kWord]);
        PutStates(now_.occupied[at], CellState::kOccupied, &after[i * kWord]);
      }
      CompareRow(before.data(), after.data(), size.x(), change.origin + CellIndex(0, y, z),
                 &change.runs);
    }
  }
  origin_ = change.origin;
  std::swap(states_, now_);
  return change;
}

void Apply(const MapChange& change, planning::OccupancyMap* map) {
  if (change.origin != map->origin()) map->MoveWindow(change.origin);
  for (const MapRun& run : change.runs) {
    for (int i = 0; i < run.count; ++i) {
      map->SetState(run.cell + i * CellIndex::UnitX(), run.state);
    }
  }
}

}  // namespace touchdown::evaluation
