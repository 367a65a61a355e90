// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "control/tracking/mixer.h"
#include "touchdown/control/tracking/controller.h"

namespace touchdown::control {

struct DisturbanceObserverOptions {
  double force_bandwidth = 9.0;    ///< both poles of the force's observer at -this [rad/s]
  double moment_bandwidth = 10.0;  ///< of the moment's [rad/s]
  double steady_time = 2.0;        ///< the steady force is the force's mean over about this [s]
  double force_max = 1.0;          ///< of the estimated force, as a share of the weight [-]
  double moment_max = 0.1;         ///< of the estimated moment, as a share of the greatest thrust
                                   ///< times the longest arm, or of the moments made alone [-]
};

/// Throws std::invalid_argument naming the first option out of its range.
void Validate(const DisturbanceObserverOptions& options);

/// Estimates the force, moment and thrust factor that the vehicle's model does not explain. It uses
/// the vehicle's own state and the thrusts it commanded, behind the rotors' lag. In steady wind the
/// estimate has no bias. It has its own memory: the tracking laws have none. Not to be shared
/// between threads.
class DisturbanceObserver {
 public:
  /// Rotors start at hover thrust. Throws std::invalid_argument for a model or an option out of
  /// range.
  explicit DisturbanceObserver(const estimation::VehicleModel& model,
                               const DisturbanceObserverOptions& options = {});

  /// Takes the state at state.t, before thrusts for it are commanded. Once per control step, in
  /// time order. A state is ignored if it is not finite, or if its velocity jumped farther than
  /// forces can make it. A filter's velocity does so when its sensors are back. Does not allocate.
  /// @param held nothing is learned now: feet in contact push too.
  const Disturbance& Update(const estimation::VehicleState& state, bool held) noexcept;

  /// The thrusts [N] that the rotors are told from the last Update on, after the mixer. A thrust
  /// that the vehicle cannot give must not count as a disturbance.
  void Command(const estimation::Commands& thrusts) noexcept;

  /// Learns as after a long hover that ends now, at state.t: the force and factor that keep the
  /// vehicle at the state's velocity and attitude with these thrusts [N]. Before the first Update.
  /// Does not allocate.
  void Hover(const estimation::VehicleState& state, const estimation::Commands& thrusts) noexcept;

  const Disturbance& disturbance() const { return disturbance_; }
  /// How the force changes now [N/s], before its limit, and with what goes into the thrust factor.
  const Eigen::Vector3d& force_rate_W() const { return force_rate_W_; }
  /// The force without its quick changes [N]: what plans can account for.
  const Eigen::Vector3d& steady_force_W() const { return steady_force_W_; }
  /// Root mean square of the quick changes [N], over 30 s: how strong gusts are.
  double gust_force() const { return std::sqrt(gust_square_); }

 private:
  void Predict(double dt) noexcept;
  void LearnGain(double dt) noexcept;
  void Correct(const estimation::VehicleState& state, double dt) noexcept;
  void NoteGust(double dt) noexcept;

  estimation::VehicleModel model_;
  DisturbanceObserverOptions options_;
  Mixer mixer_;
  double force_max_;   ///< [N]
  double moment_max_;  ///< [N m]
  bool started_ = false;
  estimation::VehicleState last_;
  estimation::Commands thrusts_;  ///< behind the lag [N]
  estimation::Commands commanded_;
  Eigen::Vector3d v_WB_ = Eigen::Vector3d::Zero();    ///< as the model has it
  Eigen::Vector3d w_WB_B_ = Eigen::Vector3d::Zero();  ///< the same
  Disturbance disturbance_;
  Eigen::Vector3d force_rate_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d steady_force_W_ = Eigen::Vector3d::Zero();
  double gust_square_ = 0.0;  ///< mean square of the force's quick changes [N^2]
  double gust_time_ = 0.0;    ///< the mean is over this [s]
};

}  // namespace touchdown::control
