// SPDX-License-Identifier: BSD-3-Clause
// The certified lower bound on the time to land (docs/t_star.md). Along a unit vector n the motion is that of a
// one-dimensional double integrator with |v_n| <= vmax and |a_n| <= amax. Its farthest point at time T is reached by
// the bang-coast-bang profile, in closed form. The end set is widened by the most that the pad can move within an
// interval of arrival times. The interval is excluded if along one n that point is short of the end set. Intervals are
// excluded one after the other from the start on, wide ones first, so nothing has to be monotone in T.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "evaluation/judge/landing_time.h"

namespace touchdown::evaluation {
namespace {

constexpr int kDirections = 600;
constexpr double kFirstStep = 0.05;    // [s]
constexpr double kLastStep = 1e-4;     // [s]
constexpr double kRounding = 1e-9;     // what a margin must exceed [m, m/s]
constexpr double kGridSpacing = 0.15;  // between neighbours on the sphere of directions [rad]
constexpr int kRefinements = 6;

// Well spread over the sphere: a Fibonacci lattice, and the axes.
std::vector<Eigen::Vector3d> Directions() {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int axis = 0; axis < 3; ++axis) {
    directions.push_back(Eigen::Vector3d::Unit(axis));
    directions.push_back(-Eigen::Vector3d::Unit(axis));
  }
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(golden_angle * i),
                            radius * std::sin(golden_angle * i), z);
  }
  return directions;
}

// Farthest a point gets in time T from rest if it ends with velocity u, |u| <= min(vmax, amax T).
// Nondecreasing in T and in u.
double Reach(double T, double u, double vmax, double amax) {
  const double peak = std::min(vmax, 0.5 * (amax * T + u));
  const double ramps = (2.0 * peak - u) / amax;
  return (2.0 * peak * peak - u * u) / (2.0 * amax) + peak * (T - ramps);
}

class Exclusion {
 public:
  Exclusion(const LandingTimeTask& task, const estimation::PadPrediction& pad)
      : task_(task), pad_(pad), directions_(Directions()), best_(directions_.front()) {}

  // True: no landing at any T in [from, to]. The direction that proved it is tried first next time.
  bool Excludes(double from, double to) {
    SetInterval(from, to);
    if (Margin(best_) > kRounding) return true;
    double margin = -INFINITY;
    for (const Eigen::Vector3d& n : directions_) {
      const double m = Margin(n);
      if (m <= margin) continue;
      margin = m;
      best_ = n;
      if (margin > kRounding) return true;
    }
    return Refine(margin);
  }

 private:
  void SetInterval(double from, double to) {
    const double half = 0.5 * (to - from);
    const sim::PadMotionBounds& rates = task_.pad_rates;
    latest_ = to;
    at_ = pad_.At(from + half);
    const double yaw_rate = std::abs(at_.yaw_rate) + rates.yaw_acceleration * half;
    // A turn moves no point of the deck by more than its corners.
    widen_p_ = task_.pad_position_error + rates.speed * half +
               task_.deck_radius() * (task_.pad_yaw_error + yaw_rate * half);
    widen_v_ = task_.pad_velocity_error + rates.acceleration * half;
    turning_ = (yaw_rate + task_.pad_yaw_rate_error) * (task_.deck_radius() + task_.foot_reach);
    x_WP_ = {std::cos(at_.yaw), std::sin(at_.yaw)};
    top_ = std::min(task_.speed, task_.acceleration * to);
  }

  // How far the reachable set along n stays short of the end set, in position or in velocity.
  double Margin(const Eigen::Vector3d& n) const {
    const double n_h = n.head<2>().norm();
    const double v = n.dot(at_.v_WP);
    const double spread = (task_.horizontal_speed + turning_) * n_h +
                          task_.vertical_speed * std::abs(n.z()) + widen_v_;
    const double too_slow = v - spread - top_;
    const double too_fast = -top_ - (v + spread);
    if (too_slow > kRounding || too_fast > kRounding) return std::max(too_slow, too_fast);
    const double u = std::clamp(v + spread, -top_, top_);
    const double along_deck = std::abs(n.x() * x_WP_.x() + n.y() * x_WP_.y()) +
                              std::abs(n.y() * x_WP_.x() - n.x() * x_WP_.y());
    // A foot may also meet the deck's side, below its upper face.
    const double deck =
        task_.deck_half_size * along_deck + task_.deck_thickness * std::max(0.0, n.z());
    const double nearest = n.dot(at_.p_WP - task_.p_WB) - deck - task_.foot_reach - widen_p_;
    return nearest - Reach(latest_, u, task_.speed, task_.acceleration);
  }

  // The grid's best direction is improved by a pattern search: any direction is a proof.
  bool Refine(double margin) {
    double radius = 0.5 * kGridSpacing;
    for (int i = 0; i < kRefinements; ++i, radius *= 0.5) {
      const Eigen::Vector3d centre = best_;
      const Eigen::Vector3d side = centre.unitOrthogonal();
      const Eigen::Vector3d other = centre.cross(side);
      for (int k = 0; k < 8; ++k) {
        const double angle = std::numbers::pi / 4.0 * k;
        const Eigen::Vector3d n =
            (centre + radius * (std::cos(angle) * side + std::sin(angle) * other)).normalized();
        const double m = Margin(n);
        if (m <= margin) continue;
        margin = m;
        best_ = n;
      }
      if (margin > kRounding) return true;
    }
    return false;
  }

  LandingTimeTask task_;
  const estimation::PadPrediction& pad_;
  std::vector<Eigen::Vector3d> directions_;
  Eigen::Vector3d best_;
  // For the interval: the pad in its middle, and bounds for every T in it.
  estimation::PadState at_;
  Eigen::Vector2d x_WP_;  // its x axis
  double latest_ = 0.0;
  double widen_p_ = 0.0;  // [m]
  double widen_v_ = 0.0;  // [m/s]
  double turning_ = 0.0;  // of the deck point, fastest [m/s]
  double top_ = 0.0;      // fastest of the vehicle [m/s]
};

}  // namespace

double LandingTimeLowerBound(const LandingTimeTask& task, const estimation::PadPrediction& pad) {
  const auto check = [](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("{} is {}; it must be > 0", name, value));
    }
  };
  check("speed limit [m/s]", task.speed);
  check("acceleration limit [m/s^2]", task.acceleration);
  check("horizon [s]", task.horizon);
  Exclusion exclusion(task, pad);
  double excluded = 0.0;
  double step = kFirstStep;
  while (excluded < task.horizon && step >= kLastStep) {
    const double to = std::min(excluded + step, task.horizon);
    if (exclusion.Excludes(excluded, to)) {
      excluded = to;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  return excluded;
}

}  // namespace touchdown::evaluation
