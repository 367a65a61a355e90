// SPDX-License-Identifier: BSD-3-Clause
// The input of a flight's pad filter and the true pad. A filter can be run on it again.
#pragma once

#include <vector>

#include "touchdown/estimation/pad/pad_arrival.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// The pad as it was at the time t [s].
struct PadTruth {
  double t = 0.0;
  bool flying = true;  ///< the vehicle had not touched it yet
  estimation::PadState pad;
};

struct PadLog {
  std::vector<estimation::PadArrival> arrivals;
  std::vector<PadTruth> truth;  ///< every 1 / kPadLogRate
};
inline constexpr double kPadLogRate = 50.0;  ///< [Hz]

}  // namespace touchdown::evaluation
