// SPDX-License-Identifier: BSD-3-Clause
// Sensors and filter in one: true states in, estimates out.
#pragma once

#include <cstdint>
#include <stdexcept>

#include "sim/sensors/own_sensor_rig.h"
#include "touchdown/estimation/own_state/own_state_filter.h"

namespace touchdown::sim {

struct OwnStateSourceConfig : OwnSensorRigConfig {
  estimation::OwnStateOptions filter;
};

class OwnStateSource {
 public:
  OwnStateSource(const OwnStateSourceConfig& config, std::uint64_t seed,
                 const estimation::VehicleState& start, double timestep)
      : rig_(config, seed), filter_(FilterOptionsFor(config, config.filter)) {
    rig_.Hover(start, timestep, Taker{&filter_});
    if (!filter_.started()) throw std::invalid_argument("the hover is too short");
    now_ = config.hover_before;
  }

  /// Does not allocate.
  estimation::VehicleState Step(const estimation::VehicleState& truth) {
    rig_.Poll(truth, Taker{&filter_});
    now_ = truth.t + rig_.config().hover_before;
    estimate_ = filter_.Estimate(now_);
    estimate_.t = truth.t;
    return estimate_;
  }

  const estimation::VehicleState& estimate() const { return estimate_; }

  estimation::VehicleState EstimateAt(double t) const {
    return filter_.Estimate(t + rig_.config().hover_before);
  }
  estimation::OwnStatus status() const { return filter_.Status(now_); }
  const estimation::OwnStateFilter& filter() const { return filter_; }
  const Imu& imu() const { return rig_.imu(); }

 private:
  struct Taker {
    estimation::OwnStateFilter* filter;
    void operator()(const estimation::ImuSample& m) const { filter->AddImu(m); }
    void operator()(const estimation::OwnPositionFix& m) const { filter->AddPosition(m); }
    void operator()(const estimation::OwnVelocityFix& m) const { filter->AddVelocity(m); }
    void operator()(const estimation::HeightSample& m) const { filter->AddHeight(m); }
    void operator()(const estimation::HeadingSample& m) const { filter->AddHeading(m); }
  };

  OwnSensorRig rig_;
  estimation::OwnStateFilter filter_;
  double now_ = 0.0;
  estimation::VehicleState estimate_;
};

}  // namespace touchdown::sim
