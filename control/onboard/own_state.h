// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "control/onboard/stamps.h"
#include "touchdown/control/onboard/onboard_options.h"
#include "touchdown/control/onboard/taken.h"
#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/own_state/own_state_filter.h"

namespace touchdown::control {

/// The vehicle's own state, how well it is known, and how it was: given or estimated.
class OwnState {
 public:
  /// @throws std::invalid_argument as OwnStateFilter.
  explicit OwnState(const OnboardOptions& options);

  /// A given state. States older than the newest only complete the history.
  Taken Take(const estimation::VehicleState& state);
  Taken Take(const estimation::ImuSample& sample);
  Taken Take(const estimation::OwnPositionFix& fix);
  Taken Take(const estimation::OwnVelocityFix& fix);
  Taken Take(const estimation::HeightSample& sample);
  Taken Take(const estimation::HeadingSample& sample);

  bool estimated() const { return filter_.has_value(); }
  /// It can be asked for a state.
  bool known() const;

  /// Brings now() to the time t [s]. Given states that are later, by more than a moment, are
  /// forgotten: before the first call the time was not known.
  void Advance(double t);
  /// Given states are forgotten: some may be of a wrong time. Estimated ones depend on more than their times.
  void Forget();
  /// The state by the newest measurement, or at the time of Advance if that is later.
  const estimation::VehicleState& now() const { return now_; }

  /// How it was at t [s], with all that is known by now; as far back as the history reaches.
  estimation::VehicleState At(double t) const;
  /// The history reaches back to t [s].
  bool Reaches(double t) const;

  estimation::OwnStatus Status(double t) const;
  /// Largest 1 sigma: of the position in W, in the horizontal plane and in any direction [m], and
  /// of the attitude [rad]. 0 where the state is given.
  double HorizontalSigma() const;
  double PositionSigma() const;
  double AttitudeSigma() const;

 private:
  template <typename Measurement>
  Taken Added(const Measurement& measured, Stamps* stamps,
              estimation::OwnUpdate (estimation::OwnStateFilter::*add)(const Measurement&));
  bool IsAhead(double t) const;
  estimation::VehicleState Newest() const;
  void TakeNewest(const estimation::VehicleState& state);
  const estimation::VehicleState& LatestAt(double t) const;
  std::size_t Slot(int i) const { return static_cast<std::size_t>(first_ + i) % given_.size(); }
  const estimation::VehicleState& given(int i) const { return given_[Slot(i)]; }
  double LargestSigma(int first) const;

  std::optional<estimation::OwnStateFilter> filter_;
  double ahead_;
  double span_;
  estimation::VehicleState now_;
  std::optional<double> advanced_;  ///< to this time [s]
  Stamps imu_, positions_, velocities_, heights_, headings_;

  std::vector<estimation::VehicleState> given_;  // a ring in time order, the newest last
  int first_ = 0;
  int size_ = 0;
};

/// Good enough to fly to the pad by.
constexpr bool IsUsable(estimation::OwnStatus status) {
  return status == estimation::OwnStatus::kGood || status == estimation::OwnStatus::kOutage;
}

/// An attitude is known, however well: there is something to control.
constexpr bool KnowsAttitude(estimation::OwnStatus status) {
  return IsUsable(status) || status == estimation::OwnStatus::kUncertain;
}

}  // namespace touchdown::control
