// SPDX-License-Identifier: BSD-3-Clause
// Running sums of a trial's figures. The mean absolute error over the last 5 s before contact, per
// world axis, is the paper's Table 1.
#include "evaluation/judge/metrics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "touchdown/estimation/pad/pad_motion_model.h"

namespace touchdown::evaluation {
namespace {

constexpr double kErrorWindow = 5.0;       // the paper's [s]
constexpr double kFollowingWindow = 10.0;  // [s]
constexpr double kClockSlack = 1e-6;       // [s]

}  // namespace

void Metrics::Step(const estimation::Commands& rotor_thrusts, bool saturated, double dt) {
  for (const double thrust : rotor_thrusts) effort_ += thrust * thrust * dt;
  ++steps_;
  if (saturated) ++saturated_;
}

void Metrics::Sample(double t, const estimation::VehicleState& vehicle,
                     const estimation::PadState& pad) {
  if (!v_previous_) t_first_ = t;
  recent_.push_back(
      {t, (vehicle.p_WB - pad.p_WP).head<2>().cwiseAbs(), (vehicle.v_WB - pad.v_WP).norm()});
  while (recent_.front().t < t - kFollowingWindow) recent_.pop_front();
  max_speed_ = std::max(max_speed_, vehicle.v_WB.norm());
  if (v_previous_ && t > t_previous_) {
    const double acceleration = (vehicle.v_WB - *v_previous_).norm() / (t - t_previous_);
    max_acceleration_ = std::max(max_acceleration_, acceleration);
  }
  v_previous_ = vehicle.v_WB;
  t_previous_ = t;
}

void Metrics::Estimate(const estimation::PadState& estimate, const estimation::PadState& truth,
                       const Eigen::Vector3d& own_error) {
  const Eigen::Vector2d p = (truth.p_WP + own_error).head<2>();  // in the frame of the filter
  sum_position_ += (estimate.p_WP.head<2>() - p).squaredNorm();
  sum_velocity_ += (estimate.v_WP - truth.v_WP).head<2>().squaredNorm();
  sum_nees_ += estimation::PositionNees(estimate, p);
  ++estimates_;
}

void Metrics::Spread::Add(double error) {
  sum += error * error;
  max = std::max(max, error);
}

void Metrics::OwnState(const estimation::VehicleState& estimate,
                       const estimation::VehicleState& truth) {
  own_position_.Add((estimate.p_WB - truth.p_WB).norm());
  own_velocity_.Add((estimate.v_WB - truth.v_WB).norm());
  own_attitude_.Add(estimate.q_WB.angularDistance(truth.q_WB));
  ++own_states_;
}

void Metrics::Fill(TrialResult* result) const {
  result->effort_n2s = effort_;
  if (steps_ > 0) {
    result->saturation_share = static_cast<double>(saturated_) / static_cast<double>(steps_);
  }
  result->max_speed_mps = max_speed_;
  result->max_acceleration_mps2 = max_acceleration_;
  if (estimates_ > 0) {
    result->estimator =
        EstimatorQuality{std::sqrt(sum_position_ / estimates_),
                         std::sqrt(sum_velocity_ / estimates_), sum_nees_ / estimates_, estimates_};
  }
  if (own_states_ > 0) {
    const auto rms = [this](const Spread& spread) { return std::sqrt(spread.sum / own_states_); };
    result->own_state = OwnStateQuality{rms(own_position_), own_position_.max,  rms(own_velocity_),
                                        own_velocity_.max,  rms(own_attitude_), own_attitude_.max};
  }
  if (!result->touchdown || recent_.empty()) return;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const ErrorSample& sample : recent_) {
    if (sample.t < recent_.back().t - kErrorWindow) continue;
    sum += sample.abs_error;
    ++count;
  }
  result->mean_abs_error_x_m = sum.x() / count;
  result->mean_abs_error_y_m = sum.y() / count;
}

std::optional<Following> Metrics::LastFollowing() const {
  if (t_previous_ - t_first_ < kFollowingWindow - kClockSlack) return std::nullopt;
  Following following;
  for (const ErrorSample& sample : recent_) {
    const double error = sample.abs_error.norm();
    following.mean_error_m += error;
    following.max_error_m = std::max(following.max_error_m, error);
    following.relative_speed_mps += sample.relative_speed;
  }
  following.mean_error_m /= static_cast<double>(recent_.size());
  following.relative_speed_mps /= static_cast<double>(recent_.size());
  return following;
}

}  // namespace touchdown::evaluation
