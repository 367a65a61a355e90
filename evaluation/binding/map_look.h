// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/binding/bind.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::binding {

/// A map that may be looked at: one's own, or one that is lent for a call.
class MapLook {
 public:
  MapLook() = default;
  MapLook(const MapLook&) = delete;
  MapLook& operator=(const MapLook&) = delete;
  virtual ~MapLook() = default;

  /// Raises RuntimeError for one that is lent no more.
  virtual const planning::OccupancyMap& get() const { return lent.get("this map"); }

  Lent<planning::OccupancyMap> lent;
  mutable InUse use{"map"};
};

/// A map that Python owns.
class OwnMap : public MapLook {
 public:
  explicit OwnMap(const planning::OccupancyMapOptions& options) : map_(options) {}
  const planning::OccupancyMap& get() const override { return map_; }
  planning::OccupancyMap& map() { return map_; }

 private:
  planning::OccupancyMap map_;
};

}  // namespace touchdown::binding
