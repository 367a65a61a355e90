// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/estimation/pad/pad_prediction.h"

#include <limits>

namespace touchdown::estimation {
namespace {

class Unknown final : public PadPrediction {
 public:
  PadState At(double /*t*/) const noexcept override {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    PadState pad;
    for (Eigen::Vector3d* part : {&pad.p_WP, &pad.v_WP, &pad.a_WP, &pad.j_WP})
      part->setConstant(kNan);
    pad.yaw = pad.yaw_rate = kNan;
    pad.cov_p.setConstant(kNan);
    return pad;
  }
};

}  // namespace

const PadPrediction& UnknownPad() noexcept {
  static const Unknown unknown;
  return unknown;
}

}  // namespace touchdown::estimation
