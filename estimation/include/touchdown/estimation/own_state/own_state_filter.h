// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "touchdown/estimation/base/own_measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/own_state/own_state_model.h"
#include "touchdown/estimation/own_state/own_state_options.h"

namespace touchdown::estimation {

/// Error-state Kalman filter of the vehicle's own state from IMU, GPS, odometry, height, heading.
///
/// IMU samples, in time order, drive it. Every other measurement carries its own time stamp and may come up to max_delay
/// late or ahead of its IMU sample. It is inserted at its place in the history, and newer ones are processed again: the
/// result is that of an ordered sequence. Start() begins from a known state. Without it the filter begins by itself from
/// a hover, as soon as it has IMU samples for hover_time, a position and a heading.
///
/// A value type: copies are independent and allocate. No other call allocates after construction.
class OwnStateFilter {
 public:
  /// Throws std::invalid_argument naming the first option out of its range.
  explicit OwnStateFilter(const OwnStateOptions& options = {});

  /// Starts, or starts again, from a known state with zero biases. The position's sigma is
  /// `sigma.position`, and so on; counts begin anew. Throws std::invalid_argument if the state is
  /// not finite, its quaternion not of unit length, or a sigma out of range.
  void Start(const VehicleState& state, const OwnStartSigma& sigma);

  OwnUpdate AddImu(const ImuSample& sample);
  OwnUpdate AddPosition(const OwnPositionFix& fix);
  OwnUpdate AddVelocity(const OwnVelocityFix& fix);
  OwnUpdate AddHeight(const HeightSample& sample);
  OwnUpdate AddHeading(const HeadingSample& sample);

  bool started() const { return size_ > 0; }

  /// Status at time t [s], with Sentence() in words.
  OwnStatus Status(double t) const;

  /// State at the newest IMU sample or measurement: what a controller takes. Its angular rate is
  /// the last reading less the bias. Meaningful once started().
  VehicleState Estimate() const;

  /// The same at another time t [s]. Later: predicted with the last readings, at most max_delay ahead. Earlier: as
  /// far as the history reaches back, with all that is known by now. Images need it: their time stamp is past when
  /// they are processed. The result has the time it is for.
  VehicleState Estimate(double t) const;

  /// The nominal state with its biases, and the covariance of its error. Meaningful once started().
  const OwnBelief& belief() const { return snapshot(size_ - 1).belief; }

  /// Largest 1 sigma of the position [m]; infinite before the start.
  double PositionSigma() const;

  OwnDiagnostics diagnostics() const;
  const OwnStateOptions& options() const { return options_; }

 private:
  enum class Kind { kImu, kPosition, kVelocity, kHeight, kHeading };

  /// What came in, in time order.
  struct Input {
    double t = 0.0;
    Kind kind = Kind::kImu;
    ImuSample imu;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< measured; the first of it for scalars
    Eigen::Vector3d sigma = Eigen::Vector3d::Ones();
  };

  /// All that an input changes: after it.
  struct Snapshot {
    OwnBelief belief;
    OwnDiagnostics diagnostics;  ///< but late, too old and invalid, which are no part of a replay
    double imu_t = 0.0;          ///< of the last IMU sample passed [s]
  };

  /// Sums over the hover before the start, and the newest of each measurement.
  struct Hover {
    int samples = 0;
    double begin = 0.0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    std::optional<Input> position;
    std::optional<Input> heading;
  };

  std::size_t Slot(int i) const { return static_cast<std::size_t>(first_ + i) % inputs_.size(); }
  Input& input(int i) { return inputs_[Slot(i)]; }
  const Input& input(int i) const { return inputs_[Slot(i)]; }
  Snapshot& snapshot(int i) { return snapshots_[Slot(i)]; }
  const Snapshot& snapshot(int i) const { return snapshots_[Slot(i)]; }

  OwnUpdate Add(const Input& added);
  OwnUpdate Keep(const Input& added);
  OwnUpdate Align(const ImuSample& sample);
  void Begin(const OwnBelief& belief);
  OwnUpdate Insert(const Input& added);
  OwnUpdate Replay(int from);
  void Carry(double t, const ImuSample& imu, Snapshot& state) const;
  OwnUpdate Measure(const Input& measured, Snapshot& state) const;
  bool Correct(const Input& measured, OwnBelief& belief) const;

  OwnStateOptions options_;
  std::array<double, 4> gate_{};  ///< by degrees of freedom
  Hover hover_;
  ImuSample last_imu_;
  bool has_imu_ = false;
  int late_accepted_ = 0;
  int too_old_ = 0;
  int invalid_ = 0;

  // A ring of inputs and of what they led to; the first holds the oldest state, its input is spent.
  std::vector<Input> inputs_;
  std::vector<Snapshot> snapshots_;
  int first_ = 0;
  int size_ = 0;
};

}  // namespace touchdown::estimation
