// SPDX-License-Identifier: BSD-3-Clause
// Kalman updates of the pad filter: Joseph form, Mahalanobis gate, and the changes between the
// Cartesian start and the model's own state. The paper's measurement is [Px, Py, phi] (eq. 11). Far
// away phi is the direction between fixes that lie significantly apart; near the pad it is the
// tags' heading. The paper does not say how. The chord's heading is that of its middle, so its
// variance is widened by the heading's own noise in half the chord's time.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "estimation/base/covariance.h"
#include "touchdown/estimation/pad/pad_filter.h"

namespace touchdown::estimation {
namespace {

// Joseph form update with the innovation of M measured quantities; false, and no change, beyond
// the gate.
template <int M>
bool Update(PadBelief& belief, const Eigen::Matrix<double, M, 1>& innovation,
            const Eigen::Matrix<double, M, 5>& H, const Eigen::Matrix<double, M, M>& R,
            double gate) {
  const Eigen::Matrix<double, M, M> S = H * belief.cov * H.transpose() + R;
  const Eigen::LLT<Eigen::Matrix<double, M, M>> factor(S);
  if (factor.info() != Eigen::Success) return false;
  if (!(innovation.dot(factor.solve(innovation)) <= gate)) return false;
  const Eigen::Matrix<double, 5, M> gain = factor.solve(H * belief.cov).transpose();
  const PadMatrix keep = PadMatrix::Identity() - gain * H;
  belief.mean += gain * innovation;
  const PadMatrix cov = keep * belief.cov * keep.transpose() + gain * R * gain.transpose();
  belief.cov = 0.5 * (cov + cov.transpose());
  return true;
}

bool UpdatePosition(PadBelief& belief, const Eigen::Vector2d& p_WP, const Eigen::Matrix2d& R,
                    double gate) {
  Eigen::Matrix<double, 2, 5> H = Eigen::Matrix<double, 2, 5>::Zero();
  H.leftCols<2>().setIdentity();
  const Eigen::Vector2d innovation = p_WP - belief.mean.head<2>();
  return Update<2>(belief, innovation, H, R, gate);
}

bool UpdatePositionAndHeading(PadBelief& belief, const Eigen::Vector2d& p_WP,
                              const Eigen::Matrix2d& cov_p, double heading, double heading_variance,
                              double gate) {
  Eigen::Matrix<double, 3, 5> H = Eigen::Matrix<double, 3, 5>::Zero();
  H.leftCols<2>().topRows<2>().setIdentity();
  H(2, 3) = 1.0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  R.topLeftCorner<2, 2>() = cov_p;
  R(2, 2) = heading_variance;
  Eigen::Vector3d innovation;
  innovation << p_WP - belief.mean.head<2>(), WrapAngle(heading - belief.mean(3));
  return Update<3>(belief, innovation, H, R, gate);
}

// The same motion described from the other end of the vehicle.
void TurnAround(PadBelief& belief) {
  belief.mean(2) = -belief.mean(2);
  belief.mean(3) += std::numbers::pi;
  belief.cov.row(2) *= -1.0;
  belief.cov.col(2) *= -1.0;
}

// From Cartesian velocity to speed along a heading that a tag has shown. The velocity across the
// heading, zero for a wheeled pad, is dropped; keeping its information out is on the safe side.
void TakeHeading(PadBelief& belief, PadMotion motion, double heading, double heading_variance,
                 double turn_variance) {
  PadMatrix map = PadMatrix::Zero();
  map.topLeftCorner<2, 2>().setIdentity();
  map(2, 2) = std::cos(heading);
  map(2, 3) = std::sin(heading);
  belief.motion = motion;
  belief.mean = (map * belief.mean).eval();
  belief.mean(3) = heading;
  belief.cov = (map * belief.cov * map.transpose()).eval();
  belief.cov(3, 3) = heading_variance;
  if (motion == PadMotion::kTurn) belief.cov(4, 4) = turn_variance;
}

PadMotion MotionOf(PadModel model) {
  return model == PadModel::kPaper ? PadMotion::kHeading : PadMotion::kTurn;
}

}  // namespace

void PadFilter::Restart(const Measurement& measurement, Snapshot& state) const {
  state.initialized = true;
  state.gps_gated_in_row = 0;
  state.tag_gated_in_row = 0;
  state.anchor = HeadingAnchor{};
  state.belief = PadBelief{};
  state.belief.t = measurement.t;
  state.belief.mean.head<2>() = measurement.p_WP;
  state.belief.cov.topLeftCorner<2, 2>() = measurement.cov_p;
  state.belief.cov(2, 2) = state.belief.cov(3, 3) = options_.speed_prior * options_.speed_prior;
  if (measurement.is_tag) {
    TakeHeading(state.belief, MotionOf(options_.model), measurement.yaw, measurement.yaw_variance,
                options_.turn_rate_prior * options_.turn_rate_prior);
    ++state.diagnostics.tag_accepted;
    state.diagnostics.last_tag_t = measurement.t;
    if (measurement.near) state.last_near_tag_t = measurement.t;
  } else {
    ++state.diagnostics.gps_accepted;
    state.diagnostics.last_gps_t = measurement.t;
  }
}

bool PadFilter::UpdateGps(const Measurement& measurement, Snapshot& state) const {
  PadBelief& belief = state.belief;
  if (belief.motion != PadMotion::kHeading) {
    return UpdatePosition(belief, measurement.p_WP, measurement.cov_p, gate_[2]);
  }

  // The paper's model: heading from the motion of the fixes.
  HeadingAnchor& anchor = state.anchor;
  const double variance = measurement.cov_p(0, 0);
  const Eigen::Vector2d chord = measurement.p_WP - anchor.p_WP;
  const double spread = variance + anchor.variance;
  const double limit = options_.chord_significance * options_.chord_significance;
  const bool significant = anchor.set && chord.squaredNorm() > limit * spread;
  if (!significant) {
    const bool accepted = UpdatePosition(belief, measurement.p_WP, measurement.cov_p, gate_[2]);
    if (accepted && !anchor.set) anchor = {true, measurement.t, measurement.p_WP, variance};
    return accepted;
  }
  double heading = std::atan2(chord.y(), chord.x());
  // A pad that reverses moves against its heading.
  if (std::abs(WrapAngle(heading - belief.mean(3))) > 0.5 * std::numbers::pi)
    heading += std::numbers::pi;
  const double heading_variance =
      spread / chord.squaredNorm() + options_.noise.heading * (measurement.t - anchor.t) / 3.0;
  const bool accepted = UpdatePositionAndHeading(belief, measurement.p_WP, measurement.cov_p,
                                                 heading, heading_variance, gate_[3]);
  if (accepted) anchor = {true, measurement.t, measurement.p_WP, variance};
  return accepted;
}

bool PadFilter::UpdateTag(const Measurement& measurement, Snapshot& state) const {
  PadBelief& belief = state.belief;
  if (belief.motion == PadMotion::kVelocity) {
    if (!UpdatePosition(belief, measurement.p_WP, measurement.cov_p, gate_[2])) return false;
    TakeHeading(belief, MotionOf(options_.model), measurement.yaw, measurement.yaw_variance,
                options_.turn_rate_prior * options_.turn_rate_prior);
    return true;
  }
  // The motion's heading does not distinguish forward from backward; the tag does.
  PadBelief candidate = belief;
  if (std::abs(WrapAngle(measurement.yaw - candidate.mean(3))) > 0.5 * std::numbers::pi)
    TurnAround(candidate);
  if (!UpdatePositionAndHeading(candidate, measurement.p_WP, measurement.cov_p, measurement.yaw,
                                measurement.yaw_variance, gate_[3])) {
    return false;
  }
  belief = candidate;
  return true;
}

void PadFilter::WidenForManeuver(PadBelief& belief) const {
  const double speed_variance = options_.maneuver_speed * options_.maneuver_speed;
  belief.cov(2, 2) += speed_variance;
  if (belief.motion == PadMotion::kVelocity) {
    belief.cov(3, 3) += speed_variance;
    return;
  }
  belief.cov(3, 3) += options_.maneuver_heading * options_.maneuver_heading;
  if (belief.motion == PadMotion::kTurn) {
    belief.cov(4, 4) += options_.maneuver_turn_rate * options_.maneuver_turn_rate;
  }
}

void PadFilter::ChangeMotion(PadBelief& belief) const {
  if (belief.motion == PadMotion::kVelocity) {
    const Eigen::Vector2d v_WP = belief.mean.segment<2>(2);
    const double speed = v_WP.norm();
    const double variance = LargestVariance(belief.cov.block<2, 2>(2, 2));
    if (speed < options_.min_speed || speed < options_.heading_significance * std::sqrt(variance)) {
      return;
    }
    PadMatrix map = PadMatrix::Identity();
    map.block<2, 2>(2, 2) << v_WP.x() / speed, v_WP.y() / speed, -v_WP.y() / (speed * speed),
        v_WP.x() / (speed * speed);
    belief.motion = MotionOf(options_.model);
    belief.mean.segment<2>(2) << speed, std::atan2(v_WP.y(), v_WP.x());
    belief.cov = (map * belief.cov * map.transpose()).eval();
    if (belief.motion == PadMotion::kTurn) {
      belief.cov(4, 4) = options_.turn_rate_prior * options_.turn_rate_prior;
    }
    return;
  }
  if (belief.cov(3, 3) <= options_.heading_lost_sigma * options_.heading_lost_sigma) return;
  const double speed = belief.mean(2);
  const double c = std::cos(belief.mean(3));
  const double s = std::sin(belief.mean(3));
  PadMatrix map = PadMatrix::Identity();
  map.block<2, 2>(2, 2) << c, -speed * s, s, speed * c;
  map(4, 4) = 0.0;
  belief.motion = PadMotion::kVelocity;
  belief.mean.segment<2>(2) << speed * c, speed * s;
  belief.mean(4) = 0.0;
  belief.cov = (map * belief.cov * map.transpose()).eval();
}

}  // namespace touchdown::estimation
