// SPDX-License-Identifier: BSD-3-Clause
// Stands in for the OctoMap sources where the build has no OctoMap: no file is read or written, and nothing is known
// beforehand.
#include <cmath>
#include <stdexcept>

#include "planning/map/octomap_cells.h"
#include "planning/map/prior_tree.h"

namespace touchdown::planning {
namespace {

[[noreturn]] void RefuseFiles() {
  throw std::invalid_argument("OctoMap files are neither read nor written: built without OctoMap");
}

}  // namespace

struct PriorTree::Impl {
  int occupied;
};

PriorTree::PriorTree(const OccupancyMapOptions& options) : impl_(std::make_unique<Impl>()) {
  const double p = options.probability_occupied;
  impl_->occupied =
      static_cast<int>(std::lround(std::log(p / (1.0 - p)) / OccupancyMap::kLogOddsStep));
}
PriorTree::~PriorTree() = default;
PriorTree::PriorTree(PriorTree&&) noexcept = default;
PriorTree& PriorTree::operator=(PriorTree&&) noexcept = default;

int PriorTree::occupied() const { return impl_->occupied; }
std::size_t PriorTree::size() const { return 0; }
bool PriorTree::Knows(const CellIndex&) const { return false; }
void PriorTree::Fill(const CellIndex&, CellBlock*) const {}
std::optional<std::int8_t> PriorTree::LogOdds(const CellIndex&) const { return std::nullopt; }
void PriorTree::ForEachObstacle(const std::function<void(const CellCube&)>&) const {}
void PriorTree::Read(std::istream&) { RefuseFiles(); }
void PriorTree::Put(const CellValue&) {}
void PriorTree::Write(std::ostream&, MapFormat) { RefuseFiles(); }

OccupiedCells ReadOccupiedCells(std::istream&) { RefuseFiles(); }

}  // namespace touchdown::planning
