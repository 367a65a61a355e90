// SPDX-License-Identifier: BSD-3-Clause
// What a record says of how a flight went, for one who looks on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// The true states at one time.
struct TrackSample {
  estimation::VehicleState vehicle;
  estimation::PadState pad;
};

/// The pad as it was believed to be at one time, with the covariance of its place.
struct TrackBelief {
  double t = 0.0;  ///< [s]
  estimation::PadState pad;
};

struct TrackEvent {
  double t = 0.0;    ///< [s]
  std::string kind;  ///< as in the record
  std::string text;
};

/// The first contact of a landing.
struct TrackTouchdown {
  double t = 0.0;        ///< [s]
  double error_m = 0.0;  ///< horizontal, to the pad's centre
};

class FlightTrack {
 public:
  /// Reads a record that ReadRecord has read. @throws BadInput naming the file.
  explicit FlightTrack(const std::string& record_path);

  double t_end() const { return samples_.back().vehicle.t; }  ///< of the last sample [s]

  /// Between samples, states are interpolated. @param t is clamped to [0, t_end()] [s].
  TrackSample At(double t) const;

  /// What was believed of the pad, from when on anything was; at times of samples.
  const std::vector<TrackBelief>& beliefs() const { return beliefs_; }
  /// All that happened, in order.
  const std::vector<TrackEvent>& events() const { return events_; }
  /// Of a flight that landed.
  const std::optional<TrackTouchdown>& touchdown() const { return touchdown_; }

 private:
  std::vector<TrackSample> samples_;
  std::vector<TrackBelief> beliefs_;
  std::vector<TrackEvent> events_;
  std::optional<TrackTouchdown> touchdown_;
};

}  // namespace touchdown::evaluation
