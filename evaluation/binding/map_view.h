// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/binding/bind.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::binding {

/// A map for reading: one's own, or one that is lent for a call.
class MapView {
 public:
  MapView() = default;
  MapView(const MapView&) = delete;
  MapView& operator=(const MapView&) = delete;
  virtual ~MapView() = default;

  /// Raises RuntimeError if the map is no longer lent.
  virtual const planning::OccupancyMap& get() const { return lent.get("this map"); }

  Borrowed<planning::OccupancyMap> lent;
  mutable InUse use{"map"};
};

/// A map that Python owns.
class OwnMap : public MapView {
 public:
  explicit OwnMap(const planning::OccupancyMapOptions& options) : map_(options) {}
  const planning::OccupancyMap& get() const override { return map_; }
  planning::OccupancyMap& map() { return map_; }

 private:
  planning::OccupancyMap map_;
};

}  // namespace touchdown::binding
