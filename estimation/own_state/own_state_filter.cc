// SPDX-License-Identifier: BSD-3-Clause
// Bookkeeping of the own-state filter: inputs in, time order, replay, status. The history is a ring
// of inputs with the state after each. An input that is older than others is put in its place, and
// all from there on is processed again. Between two inputs the state is propagated by the IMU
// sample whose interval they lie in, which is the next one in the history. So a measurement between
// two samples splits the later one's interval. For a measurement ahead of the IMU, the last sample
// propagates the state. It is processed again when its own sample has come. Corrections are in
// own_state_update.cc.

#include "touchdown/estimation/own_state/own_state_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "estimation/base/chi_squared.h"
#include "touchdown/estimation/base/vehicle_model.h"

namespace touchdown::estimation {
namespace {

// Measurements other than the IMU come at most this often, all together [Hz].
constexpr double kMeasurementRate = 300.0;
// A vehicle that goes on flying in a gap of the IMU has not turned farther, 1 sigma [rad].
constexpr double kMostTurned = 0.3;

}  // namespace

OwnStateFilter::OwnStateFilter(const OwnStateOptions& options) : options_(options) {
  Validate(options_);
  for (int degrees = 1; degrees <= 3; ++degrees) {
    gate_[static_cast<std::size_t>(degrees)] =
        ChiSquaredQuantile(degrees, options_.gate_probability);
  }
  const auto entries = static_cast<std::size_t>(
      std::ceil(options_.max_delay * (options_.imu_rate_hz + kMeasurementRate)) + 16.0);
  inputs_.resize(entries);
  snapshots_.resize(entries);
}

void OwnStateFilter::Start(const VehicleState& state, const OwnStartSigma& sigma) {
  Validate(sigma);
  const bool finite = std::isfinite(state.t) && state.p_WB.allFinite() && state.v_WB.allFinite() &&
                      state.w_WB_B.allFinite();
  const double norm = state.q_WB.norm();
  if (!finite || !(std::abs(norm - 1.0) < 1e-6)) {
    std::ostringstream message;
    message << "OwnStateFilter::Start: state at t = " << state.t << " s with |q_WB| = " << norm
            << ", allowed: finite, |q_WB| = 1";
    throw std::invalid_argument(message.str());
  }
  OwnBelief belief;
  belief.state = {state.t,
                  state.p_WB,
                  state.v_WB,
                  state.q_WB,
                  Eigen::Vector3d::Zero(),
                  Eigen::Vector3d::Zero()};
  const auto square = [](double value) { return value * value; };
  auto diagonal = belief.cov.diagonal();
  diagonal.segment<3>(kPositionError).setConstant(square(sigma.position));
  diagonal.segment<3>(kVelocityError).setConstant(square(sigma.velocity));
  diagonal.segment<3>(kAccelerometerError).setConstant(square(sigma.accelerometer));
  diagonal.segment<3>(kGyroError).setConstant(square(sigma.gyro));
  // Yaw is about W's vertical, tilt about the horizontal axes; the error is in B.
  const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
  const Eigen::Vector3d in_W(square(sigma.tilt), square(sigma.tilt), square(sigma.yaw));
  belief.cov.block<3, 3>(kAttitudeError, kAttitudeError) =
      R_WB.transpose() * in_W.asDiagonal() * R_WB;
  last_imu_ = ImuSample{state.t, state.q_WB.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity),
                        state.w_WB_B};
  Begin(belief);
}

void OwnStateFilter::Begin(const OwnBelief& belief) {
  first_ = 0;
  size_ = 1;
  late_accepted_ = too_old_ = invalid_ = 0;
  hover_ = Hover{};
  Snapshot& start = snapshot(0);
  start.belief = belief;
  start.diagnostics = OwnDiagnostics{};
  start.imu_t = belief.state.t;
  input(0) = Input{};
  input(0).t = belief.state.t;
  input(0).imu = last_imu_;
}

OwnUpdate OwnStateFilter::AddImu(const ImuSample& sample) {
  if (!std::isfinite(sample.t) || !sample.f_B.allFinite() || !sample.w_WB_B.allFinite()) {
    ++invalid_;
    return OwnUpdate::kInvalid;
  }
  if ((has_imu_ || started()) && sample.t <= last_imu_.t) {
    ++too_old_;
    return OwnUpdate::kTooOld;
  }
  if (!started()) return Align(sample);
  Input added;
  added.t = sample.t;
  added.kind = Kind::kImu;
  added.imu = sample;
  has_imu_ = true;
  last_imu_ = sample;
  return Insert(added);
}

OwnUpdate OwnStateFilter::AddPosition(const OwnPositionFix& fix) {
  const Eigen::Vector3d sigma(fix.sigma_horizontal, fix.sigma_horizontal, fix.sigma_vertical);
  return Add({fix.t, Kind::kPosition, {}, fix.p_WB, sigma});
}

OwnUpdate OwnStateFilter::AddVelocity(const OwnVelocityFix& fix) {
  return Add({fix.t, Kind::kVelocity, {}, fix.v_WB_B, Eigen::Vector3d::Constant(fix.sigma)});
}

OwnUpdate OwnStateFilter::AddHeight(const HeightSample& sample) {
  return Add({sample.t,
              Kind::kHeight,
              {},
              Eigen::Vector3d::Constant(sample.height),
              Eigen::Vector3d::Constant(sample.sigma)});
}

OwnUpdate OwnStateFilter::AddHeading(const HeadingSample& sample) {
  return Add({sample.t,
              Kind::kHeading,
              {},
              Eigen::Vector3d::Constant(sample.yaw),
              Eigen::Vector3d::Constant(sample.sigma)});
}

OwnUpdate OwnStateFilter::Add(const Input& added) {
  const bool good = std::isfinite(added.t) && added.value.allFinite() && added.sigma.allFinite() &&
                    added.sigma.minCoeff() >= 0.0;
  if (!good) {
    ++invalid_;
    return OwnUpdate::kInvalid;
  }
  Input floored = added;
  floored.sigma = added.sigma.cwiseMax(kLeastOwnSigma);
  return started() ? Insert(floored) : Keep(floored);
}

OwnUpdate OwnStateFilter::Insert(const Input& added) {
  // After all that is not newer. An IMU sample goes before measurements of its own time stamp.
  int place = size_;
  while (place > 0 && (input(place - 1).t > added.t ||
                       (added.kind == Kind::kImu && place > 1 && input(place - 1).t == added.t &&
                        input(place - 1).kind != Kind::kImu))) {
    --place;
  }
  if (added.t > last_imu_.t + options_.max_imu_gap) {
    ++invalid_;
    return OwnUpdate::kInvalid;
  }
  const double newest = input(size_ - 1).t;
  if (place == 0 || added.t < newest - options_.max_delay) {
    ++too_old_;
    return OwnUpdate::kTooOld;
  }
  const bool full = size_ == static_cast<int>(inputs_.size());
  if (full) {
    if (place == 1) {  // only the oldest state would be before it, and that is dropped
      ++too_old_;
      return OwnUpdate::kTooOld;
    }
    first_ = static_cast<int>(Slot(1));
    --size_;
    --place;
  }
  for (int i = size_; i > place; --i) input(i) = input(i - 1);
  input(place) = added;
  ++size_;

  // Measurements since the last IMU sample were propagated with other readings: they waited for
  // this sample, or it splits their interval. All from that sample on is processed again.
  int from = place;
  if (added.kind == Kind::kImu) {
    while (from > 1 && input(from - 1).kind != Kind::kImu) --from;
    while (from < place && input(from).t <= input(from - 1).t) ++from;  // unchanged
  }
  OwnUpdate update = OwnUpdate::kAccepted;
  for (int i = from; i < size_; ++i) {
    const OwnUpdate outcome = Replay(i);
    if (i == place) update = outcome;
  }
  const bool late = added.kind != Kind::kImu && place + 1 < size_;
  if (late && update == OwnUpdate::kAccepted) {
    ++late_accepted_;
    update = OwnUpdate::kAcceptedLate;
  }
  return update;
}

OwnUpdate OwnStateFilter::Replay(int i) {
  // The IMU sample whose interval holds the time between input i - 1 and input i.
  int next = i;
  while (next < size_ && input(next).kind != Kind::kImu) ++next;
  Snapshot& state = snapshot(i);
  state = snapshot(i - 1);
  const Input& now = input(i);
  Carry(now.t, next < size_ ? input(next).imu : last_imu_, state);
  if (now.kind != Kind::kImu) return Measure(now, state);
  const double gap = now.t - state.imu_t;
  state.imu_t = now.t;
  ++state.diagnostics.imu_samples;
  if (gap > options_.max_imu_gap) {
    ++state.diagnostics.imu_gaps;
    const double dv = options_.gap_acceleration * gap;
    const double turn = std::min(options_.gap_rate * gap, kMostTurned);
    auto diagonal = state.belief.cov.diagonal();
    diagonal.segment<3>(kPositionError).array() += 0.25 * dv * dv * gap * gap;
    diagonal.segment<3>(kVelocityError).array() += dv * dv;
    diagonal.segment<3>(kAttitudeError).array() += turn * turn;
  }
  return OwnUpdate::kAccepted;
}

/// A reading says nothing of the whole of a gap: the state goes on as it was.
void OwnStateFilter::Carry(double t, const ImuSample& imu, Snapshot& state) const {
  const double dt = t - state.belief.state.t, unseen = dt - options_.max_imu_gap;
  if (unseen > 0.0) state.belief.state.p_WB += unseen * state.belief.state.v_WB;
  const double seen = std::min(dt, options_.max_imu_gap);
  if (seen > 0.0) state.belief = PropagateOwnBelief(state.belief, imu, seen, options_.imu);
  state.belief.state.t = t;
}

OwnStatus OwnStateFilter::Status(double t) const {
  if (!started()) return has_imu_ ? OwnStatus::kAligning : OwnStatus::kNoImu;
  if (t - last_imu_.t > options_.max_imu_gap) return OwnStatus::kImuStale;
  const auto diagonal = belief().cov.diagonal();
  const auto beyond = [&diagonal](int part, double sigma) {
    return !(diagonal.segment<3>(part).maxCoeff() <= sigma * sigma);
  };
  if (beyond(kPositionError, options_.usable_position) ||
      beyond(kVelocityError, options_.usable_velocity) ||
      beyond(kAttitudeError, options_.usable_attitude)) {
    return OwnStatus::kUncertain;
  }
  const OwnDiagnostics& counts = snapshot(size_ - 1).diagnostics;
  const double fresh =
      std::max(counts.of(OwnSensor::kPosition).last_t, counts.of(OwnSensor::kVelocity).last_t);
  return t - fresh > options_.outage_after ? OwnStatus::kOutage : OwnStatus::kGood;
}

VehicleState OwnStateFilter::Estimate() const {
  const OwnState& state = belief().state;
  return {state.t, state.p_WB, state.v_WB, state.q_WB, last_imu_.w_WB_B - state.gyro_bias};
}

VehicleState OwnStateFilter::Estimate(double t) const {
  int at = size_ - 1;
  while (at > 0 && snapshot(at).belief.state.t > t) --at;
  int next = at + 1;
  while (next < size_ && input(next).kind != Kind::kImu) ++next;
  const ImuSample& imu = next < size_ ? input(next).imu : last_imu_;
  const OwnState& before = snapshot(at).belief.state;
  const double ahead = std::clamp(t - before.t, 0.0, options_.max_delay);
  const OwnState state = PropagateOwnState(before, imu, ahead);
  return {state.t, state.p_WB, state.v_WB, state.q_WB, imu.w_WB_B - state.gyro_bias};
}

double OwnStateFilter::PositionSigma() const {
  if (!started()) return std::numeric_limits<double>::infinity();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(belief().cov.topLeftCorner<3, 3>(), Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues().maxCoeff());
}

OwnDiagnostics OwnStateFilter::diagnostics() const {
  OwnDiagnostics counts;
  if (started()) counts = snapshot(size_ - 1).diagnostics;
  counts.late_accepted = late_accepted_;
  counts.too_old = too_old_;
  counts.invalid = invalid_;
  return counts;
}

}  // namespace touchdown::estimation
