// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "touchdown/estimation/measurements.h"
#include "touchdown/estimation/pad_prediction.h"
#include "touchdown/sim/random_stream.h"
#include "touchdown/sim/sample_clock.h"

namespace touchdown::sim {

struct PadGpsConfig {
  double sigma = 0.01;    ///< standard deviation of each horizontal axis [m], in [0, 10]
  double rate_hz = 10.0;  ///< [Hz], in (0, 1000]
};

/// GPS receiver on the pad vehicle: true horizontal position plus white Gaussian noise.
class PadGps {
 public:
  /// `seed` feeds the stream "gps". Throws std::invalid_argument naming the key, value and range.
  PadGps(const PadGpsConfig& config, std::uint64_t seed);

  /// A fix if one is due at time t [s], else nothing. Call once per simulation step.
  std::optional<estimation::PadGpsFix> Poll(double t, const estimation::PadState& pad);

 private:
  PadGpsConfig config_;
  SampleClock clock_;
  RandomStream noise_;
};

}  // namespace touchdown::sim
