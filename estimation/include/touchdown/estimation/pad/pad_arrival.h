// SPDX-License-Identifier: BSD-3-Clause
// The inputs of a pad filter, so that a filter can be run on them again.
#pragma once

#include <variant>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::estimation {

/// A sighting, with the vehicle's own state estimate at the sighting's time stamp, as it was when
/// it came.
struct BelievedSighting {
  PadSighting sighting;
  VehicleState believed;
};

/// A measurement as it came to the filter.
struct PadArrival {
  double t = 0.0;  ///< when it came [s]; its own time stamp is older if it came late
  std::variant<PadGpsFix, BelievedSighting> measurement;
};

}  // namespace touchdown::estimation
