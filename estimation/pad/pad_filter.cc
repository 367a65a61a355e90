// SPDX-License-Identifier: BSD-3-Clause
// Bookkeeping of the pad filter: measurements in, time order, gating, restarts. A late measurement
// is inserted at its own time. The state before the first newer one is restored, and the newer ones
// are processed again. So the result is that of an ordered sequence. The Kalman updates themselves
// are in pad_filter_update.cc.

#include "touchdown/estimation/pad/pad_filter.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/chi_squared.h"
#include "estimation/base/covariance.h"
#include "touchdown/estimation/pad/pad_predictor.h"

namespace touchdown::estimation {
namespace {

// Heading in W of the pad's x axis from its direction in B's x-y plane. The axis is horizontal in
// W, which gives its component along z_B.
double PadYawInWorld(const Eigen::Quaterniond& q_WB, double yaw_BP) {
  const Eigen::Matrix3d R_WB = q_WB.toRotationMatrix();
  Eigen::Vector3d x_P_B(std::cos(yaw_BP), std::sin(yaw_BP), 0.0);
  const double upright = R_WB(2, 2);
  if (std::abs(upright) > 1e-6) x_P_B.z() = -R_WB.row(2).head<2>().dot(x_P_B.head<2>()) / upright;
  const Eigen::Vector3d x_P_W = R_WB * x_P_B;
  return std::atan2(x_P_W.y(), x_P_W.x());
}

}  // namespace

PadFilter::PadFilter(const PadFilterOptions& options) : options_(options) {
  Validate(options_);
  for (int degrees = 1; degrees <= 3; ++degrees) {
    gate_[degrees] = ChiSquaredQuantile(degrees, options_.gate_probability);
  }
}

PadUpdate PadFilter::AddGps(const PadGpsFix& fix) {
  Measurement measurement;
  measurement.t = fix.t;
  measurement.p_WP = fix.p_WP;
  const double sigma = std::max(fix.sigma, kLeastGpsSigma);
  measurement.cov_p = sigma * sigma * Eigen::Matrix2d::Identity();
  if (!(fix.sigma >= 0.0)) measurement.t = std::nan("");
  return Add(measurement);
}

PadUpdate PadFilter::AddSighting(const PadSighting& sighting, const VehicleState& vehicle) {
  const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
  const Eigen::Vector3d p_BP_W = R_WB * sighting.p_BP_B;
  const double range = sighting.p_BP_B.norm();
  const Eigen::Matrix3d cov_W =
      R_WB * sighting.sigma_p.array().square().matrix().asDiagonal() * R_WB.transpose();
  const double own_attitude = options_.own_attitude_sigma;
  const double own = std::pow(options_.own_position_sigma, 2) + std::pow(own_attitude * range, 2);

  Measurement measurement;
  measurement.t = sighting.t;
  measurement.is_tag = true;
  measurement.near = range < options_.hand_over_distance;
  measurement.p_WP = (vehicle.p_WB + p_BP_W).head<2>();
  measurement.cov_p = cov_W.topLeftCorner<2, 2>() + own * Eigen::Matrix2d::Identity();
  measurement.yaw = PadYawInWorld(vehicle.q_WB, sighting.yaw_BP);
  measurement.yaw_variance = std::pow(sighting.sigma_yaw, 2) + std::pow(own_attitude, 2);
  if (!(sighting.sigma_p.minCoeff() > 0.0) || !(sighting.sigma_yaw > 0.0) ||
      sighting.tags_seen < 0) {
    measurement.t = std::nan("");
  }
  return Add(measurement);
}

PadUpdate PadFilter::Add(const Measurement& measurement) {
  const bool finite = std::isfinite(measurement.t) && measurement.p_WP.allFinite() &&
                      measurement.cov_p.allFinite() && std::isfinite(measurement.yaw) &&
                      std::isfinite(measurement.yaw_variance);
  if (!finite) {
    ++current_.diagnostics.invalid;
    return PadUpdate::kInvalid;
  }
  return Insert(measurement);
}

PadUpdate PadFilter::Insert(const Measurement& measurement) {
  const auto begin = history_.begin();
  auto end = begin + history_size_;
  auto place = std::upper_bound(begin, end, measurement.t, [](double t, const Entry& entry) {
    return t < entry.measurement.t;
  });
  const bool late = place != end;

  if (late) {
    const double newest = (end - 1)->measurement.t;
    const bool older_than_all = place == begin && history_size_ == kHistory;
    if (measurement.t < newest - options_.max_delay || older_than_all) {
      ++current_.diagnostics.too_old;
      return PadUpdate::kTooOld;
    }
  }

  // What the replay cannot know: the counts of measurements that never entered the history.
  PadDiagnostics outside = current_.diagnostics;
  Snapshot state = late ? place->before : current_;

  if (history_size_ == kHistory) {
    std::move(begin + 1, place, begin);
    --place;
  } else {
    std::move_backward(place, end, end + 1);
    ++history_size_;
    ++end;
  }
  place->measurement = measurement;
  place->before = state;
  PadUpdate update = Process(measurement, state);
  for (auto entry = place + 1; entry != end; ++entry) {
    entry->before = state;
    Process(entry->measurement, state);
  }

  current_ = state;
  current_.diagnostics.invalid = outside.invalid;
  current_.diagnostics.too_old = outside.too_old;
  current_.diagnostics.late_accepted = outside.late_accepted;
  if (late && update == PadUpdate::kAccepted) {
    update = PadUpdate::kAcceptedLate;
    ++current_.diagnostics.late_accepted;
  }
  return update;
}

PadUpdate PadFilter::Process(const Measurement& measurement, Snapshot& state) const {
  PadDiagnostics& diagnostics = state.diagnostics;
  if (!state.initialized) {
    Restart(measurement, state);
    return PadUpdate::kInitialized;
  }
  const bool handed_over = options_.model == PadModel::kPaper &&
                           measurement.t - state.last_near_tag_t < options_.hand_over_timeout;
  if (!measurement.is_tag && handed_over) {
    ++diagnostics.not_used;
    return PadUpdate::kNotUsed;
  }

  const PadBelief previous = state.belief;
  state.belief = PropagateBelief(previous, measurement.t, options_.noise);
  const auto update = [this, &measurement](Snapshot& s) {
    return measurement.is_tag ? UpdateTag(measurement, s) : UpdateGps(measurement, s);
  };
  int& in_row = measurement.is_tag ? state.tag_gated_in_row : state.gps_gated_in_row;
  bool accepted = update(state);
  if (!accepted && in_row == 1) {
    // Widened before the step, so that the position has had time to spread.
    Snapshot widened = state;
    widened.belief = previous;
    WidenForManeuver(widened.belief);
    widened.belief = PropagateBelief(widened.belief, measurement.t, options_.noise);
    accepted = update(widened);
    if (accepted) {
      state.belief = widened.belief;
      state.anchor = widened.anchor;
      ++diagnostics.maneuvers;
    }
  }
  if (!accepted) {
    ++(measurement.is_tag ? diagnostics.tag_gated : diagnostics.gps_gated);
    ++in_row;
    // While tags guide, a GPS that disagrees with them is wrong.
    const bool may_restart =
        measurement.is_tag || measurement.t - diagnostics.last_tag_t > options_.gps_restart_silence;
    if (in_row < options_.restart_after || !may_restart) return PadUpdate::kGated;
    ++diagnostics.restarts;
    Restart(measurement, state);
    return PadUpdate::kInitialized;
  }

  ChangeMotion(state.belief);
  if (measurement.is_tag) {
    state.tag_gated_in_row = 0;
    ++diagnostics.tag_accepted;
    diagnostics.last_tag_t = measurement.t;
    if (measurement.near) state.last_near_tag_t = measurement.t;
  } else {
    state.gps_gated_in_row = 0;
    ++diagnostics.gps_accepted;
    diagnostics.last_gps_t = measurement.t;
  }
  return PadUpdate::kAccepted;
}

bool PadFilter::Converged(double t) const {
  if (!current_.initialized) return false;
  const PadBelief belief = BeliefAt(t);
  double variance = std::max(belief.cov(2, 2), belief.cov(3, 3));
  if (belief.motion != PadMotion::kVelocity) {  // along and across the heading
    variance = std::max(belief.cov(2, 2), belief.mean(2) * belief.mean(2) * belief.cov(3, 3));
  }
  return PositionSigma(t) <= options_.converged_position_sigma &&
         std::sqrt(variance) <= options_.converged_velocity_sigma;
}

PadBelief PadFilter::BeliefAt(double t) const {
  return PropagateBelief(current_.belief, t, options_.noise);
}

PadState PadFilter::Estimate(double t) const {
  return ToPadState(BeliefAt(t), options_.pad_height);
}

double PadFilter::PositionSigma(double t) const {
  if (!current_.initialized) return std::numeric_limits<double>::infinity();
  return std::sqrt(LargestVariance(BeliefAt(t).cov.topLeftCorner<2, 2>()));
}

double PadFilter::TagAge(double t) const { return t - current_.diagnostics.last_tag_t; }

}  // namespace touchdown::estimation
