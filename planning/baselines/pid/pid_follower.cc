// SPDX-License-Identifier: BSD-3-Clause
// The horizontal law acts on the vehicle's position, so that it corrects what the tracking law
// leaves. The height law acts on the reference, because the mission's own height already waits for
// the vehicle. A period's reference has constant acceleration, which a single cubic segment
// represents exactly.

#include "planning/baselines/pid/pid_follower.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "planning/replan/replan_checks.h"
#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::planning {

namespace {

constexpr double kPeriod = 1.0 / PidFollower::kRate;
constexpr double kClockSlack = 1e-6;  // [s]
constexpr double kStanding = 0.05;    // [m/s]

using Segment = Eigen::Matrix<double, 3, 4>;

/// Control points of p + v t + a t^2 / 2 over one knot interval h.
Segment Parabola(const SplineState& start, const Eigen::Vector3d& a, double h) {
  const Eigen::Vector3d hv = h * start.v, hha = h * h * a;
  Segment points;
  points << start.p - hv + hha / 3.0, start.p - hha / 6.0, start.p + hv + hha / 3.0,
      start.p + 2.0 * hv + 11.0 / 6.0 * hha;
  return points;
}

const Limits& Checked(const Limits& limits) {
  for (const double limit : {limits.speed, limits.acceleration}) {
    if (limit > 0.0) continue;
    throw std::invalid_argument("PidFollower: a limit is " + std::to_string(limit) +
                                ", it must be > 0");
  }
  return limits;
}

}  // namespace

PidFollower::PidFollower(const PidGains& gains, const Limits& limits)
    : limits_(Checked(limits)), law_(gains) {
  CommitHover(Eigen::Vector3d::Zero(), 0.0);
}

void PidFollower::CommitHover(const Eigen::Vector3d& p_W, double t) {
  SplineState hover;
  hover.p = p_W;
  next_.Assign(Parabola(hover, Eigen::Vector3d::Zero(), kPeriod), kPeriod, t);
  current_ = result_.curve = next_;
  takes_over_ = t;
  climb_.reset();
  law_.Reset();
}

FlatState PidFollower::Reference(double t) const { return InForce(t).EvaluateOnward(t); }

void PidFollower::TakeOverAt(double t) {
  if (result_.status != ReplanStatus::kKept) takes_over_ = std::max(takes_over_, t);
}

/// False if there is nothing to do.
bool PidFollower::Begin(const ReplanInput& input) {
  result_.status = ReplanStatus::kKept;
  result_.reason = ReplanReason::kNone;
  result_.from_odometry = false;
  result_.times = {};
  result_.idle = std::isfinite(input.t_now) && input.t_now < takes_over_ - kClockSlack;
  if (result_.idle || !WrongInState(input)) return !result_.idle;
  result_.reason = ReplanReason::kInvalidInput;
  return false;
}

SplineState PidFollower::Start(const ReplanInput& input) {
  const FlatState now = Reference(input.t_now);
  result_.from_odometry = (now.p_WB - input.vehicle.p_WB).norm() > kLostTrack;
  if (!result_.from_odometry) {
    const FlatState at = Reference(input.t_start);
    return {at.p_WB, at.v_WB, at.a_WB};
  }
  const double latency = input.t_start - input.t_now;
  return {input.vehicle.p_WB + latency * input.vehicle.v_WB, input.vehicle.v_WB,
          Eigen::Vector3d::Zero()};
}

void PidFollower::Commit(const SplineState& start, const Eigen::Vector3d& a, double t) {
  current_ = next_;
  next_.Assign(Parabola(start, a, kPeriod), kPeriod, t);
  takes_over_ = t;
  result_.curve = next_;
}

const ReplanResult& PidFollower::Replan(const ReplanInput& input, const OccupancyMap& /*map*/) {
  if (!Begin(input)) return result_;
  StageTimer total(&result_.times.total);
  if (WrongInTarget(input, 0.0)) {
    result_.reason = ReplanReason::kInvalidInput;
    return result_;
  }
  climb_.reset();
  const SplineState start = Start(input);
  const estimation::PadState pad = input.pad->At(input.t_now);
  PidError error;
  error.position = (pad.p_WP - input.vehicle.p_WB).head<2>();
  error.pad_velocity = pad.v_WP.head<2>();
  error.velocity = error.pad_velocity - input.vehicle.v_WB.head<2>();
  const SplineState wanted = EndStateAt(*input.pad, input.endpoint, input.t_start).state;
  const double v_z = wanted.v.z() + law_.gains().height * (wanted.p.z() - start.p.z());
  Commit(start, law_.Step(error, v_z, start.v, limits_, kPeriod), input.t_start);
  result_.status = ReplanStatus::kPlanned;
  return result_;
}

const ReplanResult& PidFollower::Rest(const ReplanInput& input, double climb,
                                      const OccupancyMap& /*map*/) {
  if (!Begin(input)) return result_;
  StageTimer total(&result_.times.total);
  const SplineState start = Start(input);
  law_.Reset();
  if (climb_ != climb) {
    climb_ = climb;
    rest_height_ = start.p.z() + climb;
  }
  const double v_z = climb > 0.0 ? law_.gains().height * (rest_height_ - start.p.z()) : 0.0;
  Commit(start, law_.Towards({0.0, 0.0, v_z}, start.v, limits_), input.t_start);
  const bool stands = start.v.norm() < kStanding;
  result_.status = climb > 0.0 && !stands ? ReplanStatus::kClimbing
                   : stands               ? ReplanStatus::kHolding
                                          : ReplanStatus::kBraking;
  return result_;
}

}  // namespace touchdown::planning
