// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/binding/bind.h"
#include "touchdown/planning/map/occupancy_map.h"

namespace touchdown::binding {

/// A map that may be looked at: one's own, or one that is lent for a call.
class MapLook {
 public:
  explicit MapLook(const planning::OccupancyMap* map) : it_(map) {}
  MapLook(const MapLook&) = delete;
  MapLook& operator=(const MapLook&) = delete;
  virtual ~MapLook() = default;

  /// Raises RuntimeError once the call that it was lent for has ended.
  const planning::OccupancyMap& get() const;
  void Return() { it_ = nullptr; }

  mutable InUse use{"map"};

 private:
  const planning::OccupancyMap* it_;
};

/// A map that Python owns.
class OwnMap : public MapLook {
 public:
  explicit OwnMap(const planning::OccupancyMapOptions& options) : MapLook(&map_), map_(options) {}
  planning::OccupancyMap& map() { return map_; }

 private:
  planning::OccupancyMap map_;
};

}  // namespace touchdown::binding
