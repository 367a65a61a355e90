// SPDX-License-Identifier: BSD-3-Clause
// The simulated GPS of the paper: true position plus Gaussian noise of standard deviation sigma,
// independent in each horizontal axis and each sample. The paper's case studies have a sigma of
// 0.01, 0.5 and 1.0 m.

#include "sim/sensors/gps.h"

#include <cmath>
#include <numbers>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {

PadGps::PadGps(const PadGpsConfig& config, std::uint64_t seed)
    : config_(config),
      clock_(config.rate_hz),
      noise_(seed, "gps"),
      outliers_(seed, "gps outliers") {
  estimation::CheckWithin("gps.sigma", config.sigma, 0.0, 10.0);
  estimation::CheckWithin("gps.outlier_probability", config.outlier_probability, 0.0, 1.0);
  estimation::CheckWithin("gps.outlier_size", config.outlier_size, 0.0, 1.0e4);
}

std::optional<estimation::PadGpsFix> PadGps::Poll(double t, const estimation::PadState& pad) {
  if (!clock_.Due(t)) return std::nullopt;
  estimation::PadGpsFix fix;
  fix.t = t;
  fix.p_WP.x() = pad.p_WP.x() + noise_.Normal(config_.sigma);
  fix.p_WP.y() = pad.p_WP.y() + noise_.Normal(config_.sigma);
  fix.sigma = config_.sigma;
  // Drawn whether they are used or not, so that fixes around an outage or an outlier do not change.
  const bool outlier = outliers_.Uniform(0.0, 1.0) < config_.outlier_probability;
  const double direction = outliers_.Uniform(0.0, 2.0 * std::numbers::pi);
  if (outlier) {
    fix.p_WP += config_.outlier_size * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  }
  if (t >= config_.outage_begin_s && t < config_.outage_end_s) return std::nullopt;
  return fix;
}

}  // namespace touchdown::sim
