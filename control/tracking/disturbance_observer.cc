// SPDX-License-Identifier: BSD-3-Clause
// Two extended state observers, one for the velocity and one for the angular rate. Each predicts
// the measured quantity by the model and the disturbance, and the disturbance as a constant. The
// innovation corrects both (J. Han, "From PID to active disturbance rejection control", IEEE Trans.
// Industrial Electronics 56(3), 2009). Both poles lie at one bandwidth w (Z. Gao, "Scaling and
// bandwidth-parameterization based controller tuning", ACC 2003). The estimate is the true
// disturbance behind w^2 / (s + w)^2: no steady error, no overshoot. The noise of the velocity
// reaches it with a slope of -1 above w. In discrete time both poles are at z = exp(-w dt) with the
// gains 1 - z^2 and (1 - z)^2 / dt.
//
// The thrusts of the model are those that were commanded after the mixer's limits, behind the
// rotors' lag. So saturation cannot wind the observer up.

#include "control/tracking/disturbance_observer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::control {
namespace {

constexpr double kGainTime = 1.0;  // [s]
constexpr double kLeastGain = 0.5,
                 kGreatestGain = 2.0;  // mass and thrust off by a third, either way
constexpr double kLeastLift = 0.3;     // of the weight: with less the factor is not seen

constexpr double kRateTime = 0.1;  // the force's rate is smoothed for so long [s]

constexpr double kGustMemory = 30.0;  // [s]
// What a hover tells of gusts: they are this share of the wind's force, as if seen for so long.
constexpr double kHoverGusts = 0.3;     // [-]
constexpr double kHoverGustTime = 1.0;  // [s]

constexpr double kHoverTimes = 10.0;  // so many steady times are a long hover ...
constexpr double kHoverStep = 0.002;  // ... in such steps [s]

constexpr double kLongestStep = 0.1;             // a longer gap restarts the observers [s]
constexpr double kGreatestAcceleration = 100.0;  // quicker changes are jumps of an estimate [m/s^2]
constexpr double kGreatestSpinUp = 5000.0;       // the same [rad/s^2]

void Require(const char* name, double value, double low, double high) {
  if (value > low && value <= high) return;
  throw std::invalid_argument(std::string("DisturbanceObserverOptions.") + name + " = " +
                              std::to_string(value) + ", allowed: (" + std::to_string(low) + ", " +
                              std::to_string(high) + "]");
}

void Shorten(double longest, Eigen::Vector3d* v) {
  const double length = v->norm();
  if (length > longest) *v *= longest / length;
}

// All thrust at the longest arm, or the greatest of moments that are made alone [N m].
double GreatestMoment(const estimation::VehicleModel& model) {
  double thrust = 0.0, arm = 0.0, alone = 0.0;
  for (const estimation::Actuator& actuator : model.actuators) {
    if (actuator.thrust > 0.0) {
      thrust += actuator.max;
      arm = std::max(arm, actuator.p_BR.head<2>().norm());
    } else {
      alone = std::max(alone, actuator.moment_B.norm() *
                                  std::max(std::abs(actuator.min), std::abs(actuator.max)));
    }
  }
  return std::max(thrust * arm, alone);
}

bool Finite(const estimation::VehicleState& s) {
  return std::isfinite(s.t) && s.v_WB.allFinite() && s.q_WB.coeffs().allFinite() &&
         s.w_WB_B.allFinite();
}

}  // namespace

void Validate(const DisturbanceObserverOptions& options) {
  Require("force_bandwidth", options.force_bandwidth, 0.0, 100.0);
  Require("moment_bandwidth", options.moment_bandwidth, 0.0, 100.0);
  Require("steady_time", options.steady_time, 0.0, 60.0);
  Require("force_max", options.force_max, 0.0, 10.0);
  Require("moment_max", options.moment_max, 0.0, 1.0);
}

DisturbanceObserver::DisturbanceObserver(const estimation::VehicleModel& model,
                                         const DisturbanceObserverOptions& options)
    : model_(model),
      options_(options),
      mixer_(model),
      force_max_(options.force_max * model.HoverThrust()),
      moment_max_(options.moment_max * GreatestMoment(model)) {
  Validate(model_);
  Validate(options_);
  thrusts_ = commanded_ = mixer_.Level(model.HoverThrust());
}

const Disturbance& DisturbanceObserver::Update(const estimation::VehicleState& state,
                                               bool held) noexcept {
  if (!Finite(state)) return disturbance_;
  const double dt = state.t - last_.t;
  if (started_ && dt <= 0.0) return disturbance_;
  const bool follows = started_ && dt <= kLongestStep;
  if (follows) {
    Predict(dt);
  } else {
    thrusts_ = commanded_;  // after a gap the rotors have followed
  }
  const bool jumped = (state.v_WB - last_.v_WB).norm() > kGreatestAcceleration * dt ||
                      (state.w_WB_B - last_.w_WB_B).norm() > kGreatestSpinUp * dt;
  if (follows && !held && !jumped) {
    Correct(state, dt);
  } else {
    v_WB_ = state.v_WB;
    w_WB_B_ = state.w_WB_B;
    force_rate_W_.setZero();
  }
  last_ = state;
  started_ = true;
  return disturbance_;
}

void DisturbanceObserver::Command(const estimation::Commands& thrusts) noexcept {
  if (thrusts.allFinite()) commanded_ = thrusts;
}

void DisturbanceObserver::Hover(const estimation::VehicleState& state,
                                const estimation::Commands& thrusts) noexcept {
  Command(thrusts);
  thrusts_ = commanded_;
  estimation::VehicleState hover = state;
  for (long left = std::lround(kHoverTimes * options_.steady_time / kHoverStep); left >= 0;
       --left) {
    hover.t = state.t - left * kHoverStep;
    Update(hover, false);
  }
  // At a start the actuators are told the model's commands, which say nothing of the moment.
  disturbance_.moment_B.setZero();
  force_rate_W_.setZero();
  gust_square_ = kHoverGusts * kHoverGusts * steady_force_W_.squaredNorm();
  gust_time_ = kHoverGustTime;
}

void DisturbanceObserver::Predict(double dt) noexcept {
  const Eigen::Matrix3d R_WB = last_.q_WB.toRotationMatrix();
  const Wrench wrench = mixer_.Apply(thrusts_);
  const Eigen::Vector3d drag_B = model_.rotor_drag.cwiseProduct(R_WB.transpose() * last_.v_WB);
  const Eigen::Vector3d force_W =
      R_WB * (disturbance_.thrust_gain * wrench.thrust * Eigen::Vector3d::UnitZ() - drag_B) +
      disturbance_.force_W;
  v_WB_ += dt * (force_W / model_.mass_kg - estimation::kGravity * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d& w = last_.w_WB_B;
  const Eigen::Vector3d moment_B =
      wrench.moment_B - model_.GyroscopicMoment(w) + disturbance_.moment_B;
  w_WB_B_ += dt * model_.AccelerationUnder(moment_B);
  thrusts_ += (1.0 - std::exp(-dt / model_.rotor_lag_s)) * (commanded_ - thrusts_);
}

// A lasting vertical disturbance is a wrong mass, wrong rotors, or air that acts alike. It becomes
// a factor on the thrust, which answers every error, and no force. The sum of both stays as it is.
void DisturbanceObserver::LearnGain(double dt) noexcept {
  double& gain = disturbance_.thrust_gain;
  const Eigen::Vector3d thrust_W =
      mixer_.Apply(thrusts_).thrust * (last_.q_WB * Eigen::Vector3d::UnitZ());
  if (gain * thrust_W.z() < kLeastLift * model_.HoverThrust()) return;
  const double moved = (1.0 - std::exp(-dt / kGainTime)) * disturbance_.force_W.z() / thrust_W.z();
  const double learnt = std::clamp(gain + moved, kLeastGain, kGreatestGain) - gain;
  gain += learnt;
  disturbance_.force_W -= learnt * thrust_W;
}

void DisturbanceObserver::Correct(const estimation::VehicleState& state, double dt) noexcept {
  const double z_v = std::exp(-options_.force_bandwidth * dt);
  const Eigen::Vector3d e_v = state.v_WB - v_WB_;
  v_WB_ += (1.0 - z_v * z_v) * e_v;
  const Eigen::Vector3d change_W = model_.mass_kg * (1.0 - z_v) * (1.0 - z_v) / dt * e_v;
  disturbance_.force_W += change_W;
  force_rate_W_ += (1.0 - std::exp(-dt / kRateTime)) * (change_W / dt - force_rate_W_);
  LearnGain(dt);
  Shorten(force_max_, &disturbance_.force_W);
  steady_force_W_ +=
      (1.0 - std::exp(-dt / options_.steady_time)) * (disturbance_.force_W - steady_force_W_);
  NoteGust(dt);

  const double z_w = std::exp(-options_.moment_bandwidth * dt);
  const Eigen::Vector3d e_w = state.w_WB_B - w_WB_B_;
  w_WB_B_ += (1.0 - z_w * z_w) * e_w;
  disturbance_.moment_B += (1.0 - z_w) * (1.0 - z_w) / dt * model_.MomentFor(e_w);
  Shorten(moment_max_, &disturbance_.moment_B);
}

// A gust may follow a lull of many seconds, so the memory is long.
void DisturbanceObserver::NoteGust(double dt) noexcept {
  gust_time_ = std::min(gust_time_ + dt, kGustMemory);
  const double square = (disturbance_.force_W - steady_force_W_).squaredNorm();
  gust_square_ += dt / gust_time_ * (square - gust_square_);
}

}  // namespace touchdown::control
