// SPDX-License-Identifier: BSD-3-Clause
// True pad motions for the tests of estimation, and the sensors that watch them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "touchdown/estimation/pad/pad_filter.h"

namespace touchdown::estimation {

/// A wheeled pad driven by speed and turn rate, integrated in steps of 1 ms.
class PadDrive {
 public:
  using Rate = std::function<double(double)>;

  PadDrive(const PadVector& start, const Rate& speed, const Rate& turn, double duration) {
    PadVector x = start;
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int k = 0; k <= steps; ++k) {
      x(2) = speed(k * kStep);
      x(4) = turn(k * kStep);
      states_.push_back(x);
      x = Propagate(PadMotion::kTurn, x, kStep);
    }
  }

  /// Drawn from the turn-rate model itself: speed and turn rate are random walks.
  PadDrive(const PadVector& start, const PadNoise& noise, double duration,
           std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    PadVector x = start;
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int k = 0; k <= steps; ++k) {
      states_.push_back(x);
      x = Propagate(PadMotion::kTurn, x, kStep);
      x(0) += std::sqrt(noise.position * kStep) * normal(random);
      x(1) += std::sqrt(noise.position * kStep) * normal(random);
      x(2) += std::sqrt(noise.acceleration * kStep) * normal(random);
      x(4) += std::sqrt(noise.turn * kStep) * normal(random);
    }
  }

  /// [Px, Py, V, phi, omega] at t.
  PadVector At(double t) const {
    const auto before = static_cast<std::size_t>(std::floor(t / kStep + 1e-6));
    return Propagate(PadMotion::kTurn, states_.at(before), t - kStep * static_cast<double>(before));
  }

 private:
  static constexpr double kStep = 1e-3;
  std::vector<PadVector> states_;
};

inline PadVector PadStart(double x, double y, double speed, double heading, double turn = 0.0) {
  PadVector start;
  start << x, y, speed, heading, turn;
  return start;
}

inline PadDrive StraightDrive(double duration) {
  return {PadStart(7.0, -6.5, 0.8, 0.3), [](double) { return 0.8; }, [](double) { return 0.0; },
          duration};
}

inline PadDrive CircleDrive(double duration) {
  return {PadStart(1.0, 2.0, 0.8, 2.9), [](double) { return 0.8; }, [](double) { return 0.15; },
          duration};
}

/// Straight, a left turn of 90 degrees at 0.4 rad/s from 4 s on, straight.
inline PadDrive StraightTurnDrive(double duration) {
  return {PadStart(0.0, 0.0, 0.8, 0.0), [](double) { return 0.8; },
          [](double t) { return t > 4.0 && t < 4.0 + 0.5 * std::numbers::pi / 0.4 ? 0.4 : 0.0; },
          duration};
}

inline PadDrive StandingDrive(double duration) {
  return {PadStart(3.0, 1.0, 0.0, 1.0), [](double) { return 0.0; }, [](double) { return 0.0; },
          duration};
}

/// Forward at 0.8 m/s, from 3 s on braking at 0.8 m/s^2 into reverse at 0.5 m/s.
inline PadDrive ReversingDrive(double duration) {
  return {PadStart(0.0, 0.0, 0.8, -2.0),
          [](double t) { return std::max(-0.5, 0.8 - 0.8 * std::max(0.0, t - 3.0)); },
          [](double) { return 0.0; }, duration};
}

inline PadGpsFix GpsFix(const PadDrive& drive, double t, double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, sigma);
  PadGpsFix fix;
  fix.t = t;
  fix.sigma = sigma;
  const double east = normal(random);
  const double north = normal(random);
  fix.p_WP = drive.At(t).head<2>() + Eigen::Vector2d(east, north);
  return fix;
}

/// Vehicle above the pad, tilted and turned, so that the frames matter.
inline VehicleState Onlooker(const PadDrive& drive, double t, double height) {
  VehicleState vehicle;
  vehicle.t = t;
  vehicle.p_WB << drive.At(t).head<2>() + Eigen::Vector2d(0.3, -0.2), height;
  vehicle.q_WB = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitX());
  return vehicle;
}

/// The pad's deck is at height 0.
inline PadSighting Sighting(const PadDrive& drive, const VehicleState& vehicle, double sigma,
                            double sigma_yaw, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const PadVector pad = drive.At(vehicle.t);
  const Eigen::Vector3d p_WP(pad(0), pad(1), 0.0);
  const Eigen::Quaterniond q_BW = vehicle.q_WB.conjugate();
  const Eigen::Vector3d x_P_B = q_BW * Eigen::Vector3d(std::cos(pad(3)), std::sin(pad(3)), 0.0);
  PadSighting sighting;
  sighting.t = vehicle.t;
  sighting.p_BP_B = q_BW * (p_WP - vehicle.p_WB);
  for (int i = 0; i < 3; ++i) sighting.p_BP_B(i) += sigma * normal(random);
  sighting.yaw_BP = std::atan2(x_P_B.y(), x_P_B.x()) + sigma_yaw * normal(random);
  sighting.sigma_p.setConstant(sigma);
  sighting.sigma_yaw = sigma_yaw;
  sighting.tags_seen = 5;
  return sighting;
}

/// GPS at 10 Hz over [from, to].
inline void FeedGps(PadFilter& filter, const PadDrive& drive, double from, double to, double sigma,
                    std::mt19937_64& random) {
  for (double t = from; t < to + 1e-9; t += 0.1) filter.AddGps(GpsFix(drive, t, sigma, random));
}

/// Sightings at 30 Hz from a vehicle 1.5 m up over [from, to], and GPS at 10 Hz.
inline void FeedGpsAndTags(PadFilter& filter, const PadDrive& drive, double from, double to,
                           double sigma_gps, std::mt19937_64& random) {
  const int steps = static_cast<int>(std::floor((to - from) * 30.0 + 1e-9));
  for (int k = 0; k <= steps; ++k) {
    const double t = from + k / 30.0;
    if (k % 3 == 0) filter.AddGps(GpsFix(drive, t, sigma_gps, random));
    const VehicleState vehicle = Onlooker(drive, t, 1.5);
    filter.AddSighting(Sighting(drive, vehicle, 0.01, 0.02, random), vehicle);
  }
}

inline double PositionError(const PadState& pad, const PadVector& truth) {
  return (pad.p_WP.head<2>() - truth.head<2>()).norm();
}

/// Velocity of a true state in W.
inline Eigen::Vector2d VelocityOf(const PadVector& truth) {
  return truth(2) * Eigen::Vector2d(std::cos(truth(3)), std::sin(truth(3)));
}

inline double VelocityError(const PadState& pad, const PadVector& truth) {
  return (pad.v_WP.head<2>() - VelocityOf(truth)).norm();
}

}  // namespace touchdown::estimation
