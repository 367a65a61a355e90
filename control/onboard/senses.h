// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "control/onboard/own_state.h"
#include "control/onboard/pad_search.h"
#include "control/onboard/stamps.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/onboard/taken.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/pad/pad_arrival.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/planning/look/scout.h"
#include "touchdown/planning/map/occupancy_map.h"
#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::control {

/// An Onboard's estimates from its measurements: its own state, the pad filter, the map with its memory. Map and pad
/// filter use the frame of the own state: W as the vehicle estimates it.
class Senses {
 public:
  /// @throws std::invalid_argument naming the first option out of its range.
  Senses(const OnboardOptions& options, std::optional<planning::PersistentMap> memory);

  template <typename OwnMeasurement>
  Taken TakeOwn(const OwnMeasurement& measurement) {
    return own_.Take(measurement);
  }
  Taken Take(const estimation::PadGpsFix& fix);
  Taken Take(const estimation::PadSighting& sighting);
  /// Images are of the time `stamp` [s], whatever their own says.
  Taken Take(const estimation::PadImage& image, double stamp);
  Taken Take(const estimation::DepthImage& image, double stamp);

  /// The time stamp is ahead of all known times, or not a number.
  bool IsAhead(double t) const;

  /// The flight begins here: the space around the vehicle is free.
  void Begin();
  void Advance(double t) { own_.Advance(t); }
  void Forget() { own_.Forget(); }
  /// Of which time measurements are is not known now: those of pad and depth are refused.
  void Doubt(bool doubts) { doubts_ = doubts; }

  /// Since the stamp of the last depth image, or since Begin if none has come [s].
  double DepthAge(double t) const { return std::max(0.0, t - depth_t_); }

  /// The depth cameras whose images were used.
  const std::vector<planning::LookCamera>& cameras() const { return cameras_; }

  const OwnState& own() const { return own_; }
  const estimation::PadFilter& pad() const { return pad_; }
  const planning::OccupancyMap& map() const { return map_; }
  planning::OccupancyMap* mutable_map() { return &map_; }
  planning::PersistentMap TakeMemory();

  void LogPadTo(std::vector<estimation::PadArrival>* log) { pad_log_ = log; }

 private:
  static constexpr std::size_t kMostCameras = 8;  // depth cameras

  std::optional<Taken> Refused(double t, const Stamps& used) const;
  bool TagsGuide(double t) const;
  planning::PadOutline Outline(double t, double stamp) const;
  std::size_t CameraOf(const estimation::DepthImage& image);

  OwnState own_;
  estimation::PadFilter pad_;
  planning::OccupancyMap map_;
  planning::PersistentMap memory_;
  double deck_half_size_;
  double start_free_;
  bool doubts_ = false;
  bool pad_is_obstacle_;  // the goal is another than the pad
  Stamps fixes_, sightings_, pad_images_;
  std::vector<planning::LookCamera> cameras_;
  std::array<Stamps, kMostCameras> images_;  ///< of each
  double depth_t_ = 0.0;  // of the last depth image, or of Begin [s]
  PadSearch look_;
  estimation::DepthFrame frame_;
  std::vector<estimation::PadArrival>* pad_log_ = nullptr;
};

}  // namespace touchdown::control
