// SPDX-License-Identifier: BSD-3-Clause
// Global reference and local target, after the measured facts of the published system.

#include "planning/baselines/ego/ego_reference.h"

#include <cmath>
#include <limits>

namespace touchdown::planning {

namespace {

constexpr double kLongestPiece = 4.0;   // [m]
constexpr double kShortestTime = 1e-3;  // of a piece [s]
constexpr double kStepsPerHorizon = 20.0;

}  // namespace

void EgoReference::Set(const Eigen::Vector3d& p, const Eigen::Vector3d& v,
                       const Eigen::Vector3d& goal, const Eigen::Vector3d& v_goal,
                       const EgoOptions& options) {
  const double distance = (goal - p).norm();
  const int pieces = static_cast<int>(std::floor(distance / kLongestPiece)) + 1;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= pieces; ++i) points.push_back(p + i * (goal - p) / pieces);
  const double time = std::max(distance / pieces / options.max_speed, kShortestTime);
  std::vector<double> durations(static_cast<std::size_t>(pieces), time);
  durations.front() *= 2.0;
  durations.back() *= 2.0;
  const SplineState start{p, v, Eigen::Vector3d::Zero()};
  const SplineState end{goal, v_goal, Eigen::Vector3d::Zero()};
  chain_ = QuinticChain::Through(points, durations, start, end);
  goal_ = {goal, v_goal};
  last_ = goal_;
  progress_ = 0.0;
}

LocalTarget EgoReference::Target(const Eigen::Vector3d& p, const EgoOptions& options) {
  const double step = options.horizon / kStepsPerHorizon / options.max_speed;
  const double end = chain_.duration();
  double nearest = std::numeric_limits<double>::infinity(), nearest_t = progress_;
  double t = progress_;
  for (; t < end; t += step) {
    const SplineState at = chain_.At(t);
    const double distance = (at.p - p).norm();
    if (t == progress_ && distance > options.horizon) return last_;
    if (distance < nearest) {
      nearest = distance;
      nearest_t = t;
    }
    if (distance >= options.horizon) {
      last_ = {at.p, at.v};
      break;
    }
  }
  progress_ = nearest_t;
  if (t >= end) last_ = goal_;
  const double braking = options.max_speed * options.max_speed / (2.0 * options.max_acceleration);
  if ((goal_.p - last_.p).norm() < braking) last_.v = goal_.v;
  return last_;
}

}  // namespace touchdown::planning
