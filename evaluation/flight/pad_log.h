// SPDX-License-Identifier: BSD-3-Clause
// What a flight's pad filter was given, and what it should have said: a filter can be run on it again.
#pragma once

#include <variant>
#include <vector>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// A sighting, with what the vehicle took for its state at the sighting's time stamp when it came.
struct BelievedSighting {
  estimation::PadSighting sighting;
  estimation::VehicleState believed;
};

/// A measurement as it came to the filter.
struct PadArrival {
  double t = 0.0;  ///< when it came [s]; its own time stamp is older if it came late
  std::variant<estimation::PadGpsFix, BelievedSighting> measurement;
};

/// The pad as it was at the time t [s].
struct PadTruth {
  double t = 0.0;
  bool flying = true;  ///< the vehicle had not touched it yet
  estimation::PadState pad;
};

struct PadLog {
  std::vector<PadArrival> arrivals;
  std::vector<PadTruth> truth;  ///< every 1 / kPadLogRate
};
inline constexpr double kPadLogRate = 50.0;  ///< [Hz]

}  // namespace touchdown::evaluation
