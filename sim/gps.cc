// SPDX-License-Identifier: BSD-3-Clause
// The simulated GPS of the paper: true position plus Gaussian noise of standard deviation sigma
// (0.01, 0.5 and 1.0 m in its case studies), independent in each horizontal axis and each sample.

#include "touchdown/sim/gps.h"

#include "touchdown/sim/argument_check.h"

namespace touchdown::sim {

PadGps::PadGps(const PadGpsConfig& config, std::uint64_t seed)
    : config_(config), clock_(config.rate_hz), noise_(seed, "gps") {
  CheckWithin("gps.sigma", config.sigma, 0.0, 10.0);
}

std::optional<estimation::PadGpsFix> PadGps::Poll(double t, const estimation::PadState& pad) {
  if (!clock_.Due(t)) return std::nullopt;
  estimation::PadGpsFix fix;
  fix.t = t;
  fix.p_WP.x() = pad.p_WP.x() + noise_.Normal(config_.sigma);
  fix.p_WP.y() = pad.p_WP.y() + noise_.Normal(config_.sigma);
  fix.sigma = config_.sigma;
  return fix;
}

}  // namespace touchdown::sim
