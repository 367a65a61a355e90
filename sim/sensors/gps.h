// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "estimation/base/sample_clock.h"
#include "sim/base/random_stream.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::sim {

struct PadGpsConfig {
  double sigma = 0.01;               ///< standard deviation of each horizontal axis [m], in [0, 10]
  double rate_hz = 10.0;             ///< [Hz], in (0, 1000]
  double outage_begin_s = 0.0;       ///< from here on no fix comes ... [s]
  double outage_end_s = 0.0;         ///< ... until here; no outage if not after its begin [s]
  double outlier_probability = 0.0;  ///< of each fix, in [0, 1]
  double outlier_size = 10.0;  ///< an outlier is off by this, anywhere around [m], in [0, 1e4]
};

/// GPS receiver on the pad vehicle: true horizontal position plus white Gaussian noise. An outlier
/// claims the same standard deviation as every fix.
class PadGps {
 public:
  /// `seed` feeds the streams "gps" and "gps outliers". Throws std::invalid_argument naming the key, value and range.
  PadGps(const PadGpsConfig& config, std::uint64_t seed);

  /// A fix if one is due at time t [s], else nothing. Call once per simulation step.
  std::optional<estimation::PadGpsFix> Poll(double t, const estimation::PadState& pad);

 private:
  PadGpsConfig config_;
  estimation::SampleClock clock_;
  RandomStream noise_;
  RandomStream outliers_;
};

}  // namespace touchdown::sim
