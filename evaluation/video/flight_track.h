// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight over time, for one who watches it.
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

/// The estimated pad at one time, with the covariance of its place.
struct TrackBelief {
  double t = 0.0;  ///< [s]
  estimation::PadState pad;
};

/// The record's other data of a sample beside the true states.
struct TrackFigures {
  Eigen::Vector3d p_believed_WB =
      Eigen::Vector3d::Zero();  ///< where the vehicle believed to be [m]
  Eigen::Vector3d p_reference_WB = Eigen::Vector3d::Zero();  ///< its reference [m]
  Eigen::Vector3d v_air_W = Eigen::Vector3d::Zero();         ///< at the vehicle [m/s]
  std::vector<double> thrusts;                               ///< of the rotors [N]
  std::string mode;
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

  /// The samples themselves, and what else the record has of each.
  const std::vector<TrackSample>& samples() const { return samples_; }
  const std::vector<TrackFigures>& figures() const { return figures_; }
  /// The estimated pad, from the first estimate on; at times of samples.
  const std::vector<TrackBelief>& beliefs() const { return beliefs_; }
  /// All that happened, in order.
  const std::vector<TrackEvent>& events() const { return events_; }
  /// Of a flight that landed.
  const std::optional<TrackTouchdown>& touchdown() const { return touchdown_; }

 private:
  std::vector<TrackSample> samples_;
  std::vector<TrackFigures> figures_;
  std::vector<TrackBelief> beliefs_;
  std::vector<TrackEvent> events_;
  std::optional<TrackTouchdown> touchdown_;
};

}  // namespace touchdown::evaluation
