// SPDX-License-Identifier: BSD-3-Clause
// Given states are kept in a ring, so that the vehicle's position is known for late measurements. Between two of
// them, and for a moment after the newest, the state has constant velocity and turn rate.
#include "control/onboard/own_state.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/covariance.h"
#include "estimation/base/rotation_vector.h"

namespace touchdown::control {
namespace {

using estimation::OwnUpdate;
using estimation::VehicleState;

constexpr double kDensest = 1000.0;  // given states are kept [Hz]
constexpr double kAhead = 0.1;       // of the time that was advanced to: no measurement is [s]

constexpr double kLargest = 1e10;  // [m], [m/s], [rad/s]: no simulator goes on beyond it

// Written so that NaN fails each.
bool IsPossible(const VehicleState& s) {
  const auto within = [](const Eigen::Vector3d& a) { return (a.array().abs() < kLargest).all(); };
  return IsFlightTime(s.t) && within(s.p_WB) && within(s.v_WB) && within(s.w_WB_B) &&
         std::abs(s.q_WB.norm() - 1.0) < 1e-3;
}

VehicleState CarriedTo(double t, const VehicleState& from) {
  const double dt = t - from.t;
  if (dt == 0.0) return from;
  VehicleState state = from;
  state.t = t;
  state.p_WB += dt * from.v_WB;
  state.q_WB = from.q_WB * estimation::ExpRotation(dt * from.w_WB_B);
  return state;
}

Taken TakenAs(OwnUpdate update) {
  switch (update) {
    case OwnUpdate::kWaiting:
      return Taken::kWaiting;
    case OwnUpdate::kStarted:
    case OwnUpdate::kAccepted:
    case OwnUpdate::kAcceptedLate:
    case OwnUpdate::kReset:
      return Taken::kUsed;
    case OwnUpdate::kGated:
      return Taken::kGated;
    case OwnUpdate::kTooOld:
      return Taken::kTooOld;
    case OwnUpdate::kInvalid:
      break;
  }
  return Taken::kInvalid;
}

}  // namespace

OwnState::OwnState(const OnboardOptions& options)
    : ahead_(options.own_clock_ahead), span_(options.history) {
  if (options.own_state) {
    filter_.emplace(*options.own_state);
  } else {
    given_.resize(static_cast<std::size_t>(std::ceil(span_ * kDensest)) + 2);
  }
}

bool OwnState::known() const { return filter_ ? filter_->started() : size_ > 0; }

Taken OwnState::Take(const VehicleState& state) {
  if (filter_) return Taken::kUnasked;
  if (!IsPossible(state) || IsAhead(state.t)) return Taken::kInvalid;
  if (!advanced_ && !Reaches(state.t)) size_ = 0;  // the newest may be of a wrong time
  int at = size_;                                  // in front of which it belongs
  while (at > 0 && given(at - 1).t > state.t) --at;
  if (at > 0 && given(at - 1).t == state.t) return Taken::kDoubled;
  if (size_ > 0 && state.t < given(size_ - 1).t - span_) return Taken::kTooOld;
  const int room = static_cast<int>(given_.size());
  if (size_ == room) {
    if (at == 0) return Taken::kTooOld;
    first_ = (first_ + 1) % room;
    --size_;
    --at;
  }
  ++size_;
  for (int i = size_ - 1; i > at; --i) given_[Slot(i)] = given(i - 1);
  given_[Slot(at)] = state;
  if (at == size_ - 1) TakeNewest(state);
  return Taken::kUsed;
}

void OwnState::TakeNewest(const VehicleState& state) {
  if (advanced_ && state.t < *advanced_) return Advance(*advanced_);
  now_ = state;
}

bool OwnState::IsAhead(double t) const { return advanced_ && !(t <= *advanced_ + kAhead); }

template <typename Measurement>
Taken OwnState::Added(const Measurement& measured, Stamps* stamps,
                      OwnUpdate (estimation::OwnStateFilter::*add)(const Measurement&)) {
  if (!filter_) return Taken::kUnasked;
  if (IsAhead(measured.t - ahead_)) return Taken::kInvalid;
  if (stamps->Has(measured.t)) return Taken::kDoubled;
  const Taken taken = TakenAs((*filter_.*add)(measured));
  if (IsLookedAt(taken)) stamps->Add(measured.t);
  if (taken != Taken::kUsed) return taken;
  TakeNewest(Newest());
  return taken;
}

Taken OwnState::Take(const estimation::ImuSample& sample) {
  return Added(sample, &imu_, &estimation::OwnStateFilter::AddImu);
}
Taken OwnState::Take(const estimation::OwnPositionFix& fix) {
  return Added(fix, &positions_, &estimation::OwnStateFilter::AddPosition);
}
Taken OwnState::Take(const estimation::OwnVelocityFix& fix) {
  return Added(fix, &velocities_, &estimation::OwnStateFilter::AddVelocity);
}
Taken OwnState::Take(const estimation::HeightSample& sample) {
  return Added(sample, &heights_, &estimation::OwnStateFilter::AddHeight);
}
Taken OwnState::Take(const estimation::HeadingSample& sample) {
  return Added(sample, &headings_, &estimation::OwnStateFilter::AddHeading);
}

VehicleState OwnState::Newest() const {
  VehicleState state = filter_->Estimate();
  state.t -= ahead_;
  return state;
}

void OwnState::Forget() { size_ = 0; }

void OwnState::Advance(double t) {
  advanced_ = t;
  if (filter_) {
    if (filter_->started()) now_ = filter_->Estimate(t + ahead_);
  } else {
    while (size_ > 0 && IsAhead(given(size_ - 1).t)) --size_;
    if (size_ > 0) now_ = At(t);
  }
  now_.t = t;
}

// Of the given ones, the newest that is no later than t; the oldest where all are.
const VehicleState& OwnState::LatestAt(double t) const {
  int at = size_ - 1;
  while (at > 0 && given(at).t > t) --at;
  return given(at);
}

VehicleState OwnState::At(double t) const {
  if (filter_) {
    VehicleState state = filter_->Estimate(t + ahead_);
    state.t -= ahead_;
    return state;
  }
  if (size_ == 0) return now_;
  const VehicleState& from = LatestAt(t);
  return CarriedTo(std::clamp(t, from.t, from.t + kCounts), from);
}

bool OwnState::Reaches(double t) const {
  if (!known()) return false;
  if (filter_) return t >= now_.t - filter_->options().max_delay;
  return t >= std::max(given(0).t, given(size_ - 1).t - span_);
}

estimation::OwnStatus OwnState::Status(double t) const {
  if (filter_) {
    const bool ahead = filter_->started() && Newest().t > t + kAhead;
    return ahead ? estimation::OwnStatus::kImuStale : filter_->Status(t + ahead_);
  }
  if (size_ == 0) return estimation::OwnStatus::kAligning;
  return std::abs(t - LatestAt(t).t) <= kCounts ? estimation::OwnStatus::kGood
                                                : estimation::OwnStatus::kImuStale;
}

double OwnState::HorizontalSigma() const {
  if (!filter_) return 0.0;
  return std::sqrt(estimation::LargestVariance(filter_->belief().cov.topLeftCorner<2, 2>()));
}

double OwnState::PositionSigma() const { return LargestSigma(estimation::kPositionError); }
double OwnState::AttitudeSigma() const { return LargestSigma(estimation::kAttitudeError); }

double OwnState::LargestSigma(int first) const {
  if (!filter_) return 0.0;
  return std::sqrt(filter_->belief().cov.diagonal().segment<3>(first).maxCoeff());
}

}  // namespace touchdown::control
