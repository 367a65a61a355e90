// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/rotor_lead.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "control/test/flight_model.h"
#include "control/tracking/geometric_controller.h"

namespace touchdown::control {
namespace {

constexpr double kStep = 0.002;  // [s]

TEST(RotorLead, RotorsOfTheModelFollowAsIfTheirLagWereAThird) {
  const estimation::VehicleModel model = TestVehicle();
  RotorLead lead(model);
  const double hover = 0.25 * model.HoverThrust();
  const Eigen::Vector4d wanted =
      Eigen::Vector4d::Constant(hover) + 0.1 * hover * Eigen::Vector4d(1.0, -1.0, 0.5, -0.5);
  Eigen::Vector4d given = Eigen::Vector4d::Constant(hover);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector4d command = lead.Command(wanted, i * kStep);
    given += (1.0 - std::exp(-kStep / model.rotor_lag_s)) * (command - given);
    const double t = (i + 1) * kStep;
    const double left = std::exp(-3.0 * t / model.rotor_lag_s);
    EXPECT_LT(((given - wanted).array() / (hover - wanted.array()) - left).abs().maxCoeff(), 0.05)
        << "t = " << t;
  }
}

TEST(RotorLead, AfterAHoverWhatHeldItGoesOn) {
  const estimation::VehicleModel model = TestVehicle();
  RotorLead lead(model);
  const Eigen::Vector4d held = Eigen::Vector4d::Constant(0.17 * model.HoverThrust());
  lead.Hover(held);
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT((lead.Command(held, 3.0 + i * kStep) - held).norm(), 1e-12) << i;
  }
}

TEST(RotorLead, CommandsStayWithinTheLimitsAndDoNotWindUp) {
  const estimation::VehicleModel model = TestVehicle();
  RotorLead lead(model);
  const double hover = 0.25 * model.HoverThrust();
  const Eigen::Vector4d most = Eigen::Vector4d::Constant(model.actuators[0].max);
  double given = hover;
  const auto fly = [&](const Eigen::Vector4d& wanted, double t) {
    const Eigen::Vector4d command = lead.Command(wanted, t);
    EXPECT_LE(command.maxCoeff(), model.actuators[0].max);
    EXPECT_GE(command.minCoeff(), model.actuators[0].min);
    given += (1.0 - std::exp(-kStep / model.rotor_lag_s)) * (command(0) - given);
  };
  int i = 0;
  for (; i < 10; ++i) fly(most, i * kStep);
  EXPECT_GT(given, 1.3 * hover);
  // When the demand returns, the rotor does not fall below it. It would, if the lead assumed that
  // its clipped commands were flown.
  for (; i < 100; ++i) {
    fly(Eigen::Vector4d::Constant(hover), i * kStep);
    EXPECT_GT(given, 0.999 * hover);
  }
  EXPECT_NEAR(given, hover, 1e-3 * hover);
}

// With little thrust and quick turns, a rotor that is clipped alone lifts the vehicle.
TEST(RotorLead, WhatTheLimitsCutOffLiftsNobody) {
  const estimation::VehicleModel model = TestVehicle();
  const Mixer mixer(model);
  RotorLead lead(model);
  const double thrust = 0.6 * model.HoverThrust();
  Eigen::Vector4d given = Eigen::Vector4d::Constant(0.25 * model.HoverThrust());
  double mean = 0.0;
  constexpr int kSteps = 600, kBefore = 200;
  for (int i = 0; i < kBefore + kSteps; ++i) {
    const double most = (i / 10) % 2 == 0 ? 100.0 : -100.0;  // [N m]
    const Eigen::Vector4d wanted = mixer.Mix({thrust, {most, 0.0, 0.0}}).thrusts;
    const Eigen::Vector4d command = lead.Command(wanted, i * kStep);
    given += (1.0 - std::exp(-kStep / model.rotor_lag_s)) * (command - given);
    if (i >= kBefore) mean += given.sum() / kSteps;
  }
  EXPECT_NEAR(mean, thrust, 0.01 * thrust);
}

/// A vehicle that is struck turns with 3 rad/s: the fastest that it turns back and forth later than 0.2 s
/// after [rad/s].
double Ringing(double gain, double lag, bool with_lead) {
  const estimation::VehicleModel model = TestVehicle();
  estimation::VehicleModel plant = model;
  plant.inertia /= gain;
  plant.rotor_lag_s *= lag;
  const GeometricController law(model, {});
  RotorLead lead(model);
  FlightModel flight(plant, law);
  if (with_lead) flight.lead = &lead;
  flight.state.w_WB_B.x() = 3.0;
  double fastest = 0.0;
  // The attitude alone: position and velocity are those demanded.
  while (flight.state.t < 0.6) {
    planning::FlatState reference;
    reference.p_WB = flight.state.p_WB;
    reference.v_WB = flight.state.v_WB;
    flight.Step(reference);
    if (flight.state.t > 0.2) fastest = std::max(fastest, std::abs(flight.state.w_WB_B.x()));
  }
  return fastest;
}

TEST(RotorLead, KeepsTheAttitudeDampedWhereThePlantIsOff) {
  for (const double gain : {0.8 / 1.2, 1.0, 1.25, 1.5}) {
    for (const double lag : {0.8, 1.0, 1.2}) {
      SCOPED_TRACE(testing::Message() << "gain " << gain << ", lag " << lag);
      const double without = Ringing(gain, lag, false), with = Ringing(gain, lag, true);
      EXPECT_LT(with, 0.9);
      if (lag >= 1.0) {
        EXPECT_LT(with, 0.75 * without);
      }
    }
  }
}

}  // namespace
}  // namespace touchdown::control
