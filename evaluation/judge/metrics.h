// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "evaluation/judge/trial_result.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_prediction.h"

namespace touchdown::evaluation {

/// Accumulates a trial's figures from true states, in flight until first contact. Feed it in time
/// order and stop at first contact.
class Metrics {
 public:
  /// Every physics step. @param rotor_thrusts [N]. @param dt length of the step [s].
  void Step(const estimation::Commands& rotor_thrusts, bool saturated, double dt);

  /// Every 20 ms.
  void Sample(double t, const estimation::VehicleState& vehicle, const estimation::PadState& pad);

  /// The filter's estimate against the truth, after a measurement while it is converged.
  /// @param own_error the vehicle's estimate of its own position less the truth [m]. The filter's frame is off by this.
  /// The positions are compared as seen from the vehicle.
  void Estimate(const estimation::PadState& estimate, const estimation::PadState& truth,
                const Eigen::Vector3d& own_error);

  /// The vehicle's estimate of its own state against the truth, every 20 ms.
  void OwnState(const estimation::VehicleState& estimate, const estimation::VehicleState& truth);

  /// Writes the figures into `result`; those at contact only if `touchdown` is set there.
  void Fill(TrialResult* result) const;

  /// Over the last 10 s; empty if the samples span less.
  std::optional<Following> LastFollowing() const;

 private:
  struct ErrorSample {
    double t;
    Eigen::Vector2d abs_error;  ///< vehicle minus pad, world axes [m]
    double relative_speed;      ///< [m/s]
  };
  std::deque<ErrorSample> recent_;  ///< of the last 10 s
  double effort_ = 0.0;
  long steps_ = 0;
  long saturated_ = 0;
  std::optional<Eigen::Vector3d> v_previous_;
  double t_first_ = 0.0;
  double t_previous_ = 0.0;
  double max_speed_ = 0.0;
  double max_acceleration_ = 0.0;
  double sum_position_ = 0.0;
  double sum_velocity_ = 0.0;
  double sum_nees_ = 0.0;
  int estimates_ = 0;
  /// Sum of squares and largest of an error.
  struct Spread {
    double sum = 0.0;
    double max = 0.0;
    void Add(double error);
  };
  Spread own_position_;
  Spread own_velocity_;
  Spread own_attitude_;
  int own_states_ = 0;
};

}  // namespace touchdown::evaluation
