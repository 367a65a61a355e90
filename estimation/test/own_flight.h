// SPDX-License-Identifier: BSD-3-Clause
// True flights for the tests of OwnStateFilter, and the sensors that ride along, drawn from the
// filter's own noise model.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "estimation/base/rotation_vector.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/own_state/own_state_filter.h"

namespace touchdown::estimation {

/// A smooth flight: sums of two sines per axis, the thrust axis along the needed force, the heading
/// a sine. `vigour` 0 hovers, 1 flies to about 4 m/s^2 and turns.
class OwnFlight {
 public:
  OwnFlight(std::mt19937_64& random, double vigour) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (Wave& wave : waves_) {
      wave.frequency = 0.6 + 1.2 * unit(random);
      wave.amplitude = vigour * (0.4 + unit(random)) / (wave.frequency * wave.frequency);
      wave.phase = 6.28 * unit(random);
    }
    yaw_ = {vigour * (0.5 + unit(random)), 0.4 + 0.4 * unit(random), 6.28 * unit(random)};
  }

  VehicleState At(double t) const {
    VehicleState state;
    state.t = t;
    state.p_WB = {0.0, 0.0, 5.0};
    Eigen::Vector3d force(0.0, 0.0, kGravity);
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const Wave& wave = waves_[i];
      const auto axis = static_cast<Eigen::Index>(i % 3);
      const double angle = wave.frequency * t + wave.phase;
      state.p_WB(axis) += wave.amplitude * std::sin(angle);
      state.v_WB(axis) += wave.amplitude * wave.frequency * std::cos(angle);
      force(axis) -= wave.amplitude * wave.frequency * wave.frequency * std::sin(angle);
    }
    const double yaw = yaw_.amplitude * std::sin(yaw_.frequency * t + yaw_.phase);
    const Eigen::Vector3d z_B = force.normalized();
    const Eigen::Vector3d y_B =
        z_B.cross(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0)).normalized();
    Eigen::Matrix3d R_WB;
    R_WB << y_B.cross(z_B), y_B, z_B;
    state.q_WB = Eigen::Quaterniond(R_WB).normalized();
    return state;
  }

 private:
  struct Wave {
    double amplitude = 0.0;
    double frequency = 0.0;
    double phase = 0.0;
  };
  std::array<Wave, 6> waves_;
  Wave yaw_;
};

/// Rates, qualities and faults of the sensors.
struct OwnRig {
  double imu_dt = 0.004;    ///< [s]
  int position_every = 25;  ///< IMU samples; 0: never
  int velocity_every = 0;
  int height_every = 10;
  int heading_every = 10;
  double position_sigma = 0.05;
  double vertical_sigma = 0.1;
  double velocity_sigma = 0.05;
  double height_sigma = 0.1;
  double heading_sigma = 0.05;
  double outage_begin = 1e9;   ///< no positions from here ...
  double outage_end = 1e9;     ///< ... to here [s]
  double outlier_share = 0.0;  ///< of the positions, off by outlier_size in a random direction
  double outlier_size = 5.0;   ///< [m]
  int delay = 0;               ///< of positions, in IMU samples
};

/// Flies and feeds a filter.
class OwnRun {
 public:
  OwnRun(unsigned seed, double vigour, const OwnRig& rig, const OwnStateOptions& options = {})
      : rig_(rig), options_(options), random_(seed), flight_(random_, vigour), filter(options) {
    accelerometer_bias = options.prior.accelerometer * Normal3();
    gyro_bias = options.prior.gyro * Normal3();
    last_ = flight_.At(0.0);
  }

  /// Starts the filter with an error drawn from its own sigmas.
  void StartFromPrior() {
    const OwnStartSigma& prior = options_.prior;
    OwnState truth = True();
    const Eigen::Vector3d turn_W =
        Eigen::Vector3d(prior.tilt, prior.tilt, prior.yaw).cwiseProduct(Normal3());
    VehicleState start = last_;
    start.p_WB += prior.position * Normal3();
    start.v_WB += prior.velocity * Normal3();
    start.q_WB = (ExpRotation(turn_W) * truth.q_WB).normalized();
    filter.Start(start, prior);
  }

  void FlyTo(double t_end) {
    while (last_.t < t_end - 1e-9) Step();
  }

  void Step() {
    ++step_;
    const VehicleState now = flight_.At(step_ * rig_.imu_dt);
    const double dt = rig_.imu_dt;
    const double root = std::sqrt(dt);
    const Eigen::Vector3d phi = LogRotation(last_.q_WB.conjugate() * now.q_WB);
    const Eigen::Quaterniond middle = last_.q_WB * ExpRotation(0.5 * phi);
    const Eigen::Vector3d a_W = (now.v_WB - last_.v_WB) / dt;
    ImuSample imu;
    imu.t = now.t;
    imu.f_B = middle.conjugate() * (a_W + Eigen::Vector3d(0.0, 0.0, kGravity)) +
              accelerometer_bias + options_.imu.accelerometer / root * Normal3();
    imu.w_WB_B = phi / dt + gyro_bias + options_.imu.gyro / root * Normal3();
    filter.AddImu(imu);
    accelerometer_bias += options_.imu.accelerometer_walk * root * Normal3();
    gyro_bias += options_.imu.gyro_walk * root * Normal3();
    last_ = now;

    if (rig_.position_every > 0 && step_ % rig_.position_every == 0) {
      OwnPositionFix& fix = held_;
      fix.t = now.t;
      fix.sigma_horizontal = rig_.position_sigma;
      fix.sigma_vertical = rig_.vertical_sigma;
      fix.p_WB =
          now.p_WB + Eigen::Vector3d(rig_.position_sigma, rig_.position_sigma, rig_.vertical_sigma)
                         .cwiseProduct(Normal3());
      const bool outlier = unit_(random_) < rig_.outlier_share;
      const Eigen::Vector3d direction = Normal3().normalized();
      if (outlier) fix.p_WB += rig_.outlier_size * direction;
      outliers += outlier ? 1 : 0;
      due_ = step_ + rig_.delay;
    }
    if (step_ == due_ && (held_.t < rig_.outage_begin || held_.t >= rig_.outage_end)) {
      filter.AddPosition(held_);
    }
    if (rig_.velocity_every > 0 && step_ % rig_.velocity_every == 0) {
      filter.AddVelocity({now.t, now.q_WB.conjugate() * now.v_WB + rig_.velocity_sigma * Normal3(),
                          rig_.velocity_sigma});
    }
    if (rig_.height_every > 0 && step_ % rig_.height_every == 0) {
      filter.AddHeight(
          {now.t, now.p_WB.z() + rig_.height_sigma * normal_(random_), rig_.height_sigma});
    }
    if (rig_.heading_every > 0 && step_ % rig_.heading_every == 0) {
      filter.AddHeading(
          {now.t, Yaw(now.q_WB) + rig_.heading_sigma * normal_(random_), rig_.heading_sigma});
    }
  }

  OwnState True() const {
    return {last_.t, last_.p_WB, last_.v_WB, last_.q_WB, accelerometer_bias, gyro_bias};
  }

  OwnVector Error() const { return OwnErrorBetween(filter.belief().state, True()); }

  /// Normalised error squared of n states from `part` on.
  double Nees(int part, int n) const {
    const Eigen::VectorXd error = Error().segment(part, n);
    const Eigen::MatrixXd cov = filter.belief().cov.block(part, part, n, n);
    return error.dot(cov.ldlt().solve(error));
  }

 private:
  Eigen::Vector3d Normal3() {
    const double x = normal_(random_);
    const double y = normal_(random_);
    const double z = normal_(random_);
    return {x, y, z};
  }

  OwnRig rig_;
  OwnStateOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  OwnFlight flight_;
  VehicleState last_;
  OwnPositionFix held_;
  int step_ = 0;
  int due_ = -1;

 public:
  OwnStateFilter filter;
  Eigen::Vector3d accelerometer_bias;
  Eigen::Vector3d gyro_bias;
  int outliers = 0;
};

}  // namespace touchdown::estimation
