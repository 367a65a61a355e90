// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/sensors/own_state_source.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/own_state/own_state_options.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The sensors and the filter of the scenario's keys under own.
sim::OwnStateSourceConfig OwnSourceConfig(const Scenario& scenario);

/// What the vehicle takes for its own state: the truth, or an estimate, as the scenario's own_state
/// says. Everything that flies asks here; the truth is for cameras, physics and judge.
class OwnEstimate {
 public:
  /// @param start true state at t = 0. @param timestep of the physics [s]. `seed` feeds the sensors'
  /// own streams. @throws std::invalid_argument naming key, value and range.
  OwnEstimate(const Scenario& scenario, const estimation::VehicleState& start, double timestep,
              std::uint64_t seed);

  /// Takes the true state. Call once per physics step, first at t = 0. Does not allocate.
  void Sense(const estimation::VehicleState& truth);

  bool estimated() const { return source_.has_value(); }

  /// The state now.
  const estimation::VehicleState& now() const { return now_; }

  /// What is known by now of the state at a time that has passed, as far back as the filter's
  /// history reaches (0.5 s at least). @param truth the true state of then.
  estimation::VehicleState At(const estimation::VehicleState& truth) const;

  /// How far the estimate is to be trusted; the truth is always good.
  estimation::OwnStatus status() const;

  /// Largest horizontal 1 sigma of the position in W [m]; 0 for the truth.
  double HorizontalSigma() const;

  /// Largest 1 sigma of the position in W, of any direction [m], and of the attitude about any of B's axes [rad];
  /// 0 for the truth.
  double PositionSigma() const;
  double AttitudeSigma() const;

 private:
  double LargestSigma(int first) const;

  std::optional<sim::OwnStateSource> source_;
  estimation::VehicleState now_;
};

}  // namespace touchdown::evaluation
