// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/control/tracking/controller.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/test/flight_model.h"
#include "control/tracking/tracking_law.h"

namespace touchdown::control {
namespace {

planning::FlatState Hover(double x = 0.0, double y = 0.0, double z = 0.0, double yaw = 0.0) {
  planning::FlatState flat;
  flat.p_WB << x, y, z;
  flat.yaw = yaw;
  return flat;
}

/// Horizontal circle with the given speed and acceleration, nose along the motion.
planning::FlatState Circle(double t, double speed, double acceleration) {
  const double radius = speed * speed / acceleration;
  const double rate = speed / radius;
  const double c = std::cos(rate * t);
  const double s = std::sin(rate * t);
  planning::FlatState flat;
  flat.p_WB << radius * c, radius * s, 1.0;
  flat.v_WB << -speed * s, speed * c, 0.0;
  flat.a_WB << -acceleration * c, -acceleration * s, 0.0;
  flat.j_WB << acceleration * rate * s, -acceleration * rate * c, 0.0;
  return flat;
}

/// Straight sweep between rest points, p = A sin^2, peak speed and acceleration as given.
planning::FlatState Sweep(double t, double speed, double acceleration) {
  // p = A (1 - cos(w t)) / 2, v max = A w / 2, a max = A w^2 / 2
  const double w = acceleration / speed;
  const double amplitude = 2.0 * speed / w;
  planning::FlatState flat;
  const Eigen::Vector3d along = Eigen::Vector3d(0.6, 0.7, 0.25).normalized();
  flat.p_WB = along * amplitude * (1.0 - std::cos(w * t)) / 2.0;
  flat.v_WB = along * amplitude * w * std::sin(w * t) / 2.0;
  flat.a_WB = along * amplitude * w * w * std::cos(w * t) / 2.0;
  flat.j_WB = -along * amplitude * w * w * w * std::sin(w * t) / 2.0;
  return flat;
}

double WorstErrorOn(const Controller& controller, const estimation::VehicleModel& model,
                    const FlightModel::Reference& reference, double settle, double duration) {
  FlightModel flight(model, controller);
  const planning::FlatState start = reference(0.0);
  flight.state.p_WB = start.p_WB;
  flight.state.v_WB = start.v_WB;
  flight.state.q_WB = Eigen::Quaterniond(planning::InvertFlatness(start).R_WB);
  double worst = 0.0;
  flight.Fly(duration, reference, [&](const planning::FlatState& flat) {
    if (flight.state.t > settle) {
      worst = std::max(worst, (flight.state.p_WB - flat.p_WB).norm());
    }
  });
  return worst;
}

class BothLaws : public testing::TestWithParam<const char*> {
 protected:
  const estimation::VehicleModel model_ = TestVehicle();
  const std::unique_ptr<Controller> controller_ = MakeController(GetParam(), model_);
};
INSTANTIATE_TEST_SUITE_P(Controller, BothLaws, testing::Values("geometric", "paper"));

TEST_P(BothLaws, HoverNeedsExactlyTheWeight) {
  const ControlOutput output = controller_->Update({}, Hover());
  EXPECT_NEAR(output.wrench.thrust, model_.HoverThrust(), 1e-12);
  EXPECT_LT(output.wrench.moment_B.norm(), 1e-12);
  EXPECT_FALSE(output.tilt_limited || output.thrust_limited);
}

TEST_P(BothLaws, StepSettlesWithoutMuchOvershoot) {
  FlightModel flight(model_, *controller_);
  double overshoot = 0.0;
  flight.Fly(
      4.0, [](double) { return Hover(1.0, -0.5, 0.5, 1.0); },
      [&](const planning::FlatState&) {
        overshoot = std::max(overshoot, flight.state.p_WB.x() - 1.0);
      });
  RecordProperty("overshoot_m", std::to_string(overshoot));
  EXPECT_LT(overshoot, 0.12);
  EXPECT_LT((flight.state.p_WB - Eigen::Vector3d(1.0, -0.5, 0.5)).norm(), 0.01);
  EXPECT_LT(flight.state.v_WB.norm(), 0.02);
  EXPECT_NEAR(estimation::Yaw(flight.state.q_WB), 1.0, 0.01);
}

TEST_P(BothLaws, RecoversFromLargeTilt) {
  for (double tilt_deg : {60.0, 90.0, 120.0, 150.0}) {
    for (double axis : {0.0, 0.8, 2.0}) {
      FlightModel flight(model_, *controller_);
      flight.state.q_WB = Eigen::AngleAxisd(tilt_deg * std::numbers::pi / 180.0,
                                            Eigen::Vector3d(std::cos(axis), std::sin(axis), 0.0));
      flight.state.w_WB_B << 1.0, -1.0, 0.5;
      flight.Fly(6.0, [](double) { return Hover(); });
      EXPECT_LT(flight.state.p_WB.norm(), 0.03) << tilt_deg;
      EXPECT_LT(estimation::Tilt(flight.state.q_WB), 0.01) << tilt_deg;
    }
  }
}

TEST_P(BothLaws, ToleratesSlowerRotorsAndWrongInertia) {
  // Twice the lag the gains were chosen for, and a fifth less inertia than the controller thinks.
  estimation::VehicleModel slow = model_;
  slow.rotor_lag_s = 2.0 * model_.rotor_lag_s;
  slow.inertia *= 0.8;
  FlightModel flight(slow, *controller_);
  flight.Fly(8.0, [](double) { return Hover(0.5, 0.5, 0.0); });
  EXPECT_LT((flight.state.p_WB - Eigen::Vector3d(0.5, 0.5, 0.0)).norm(), 0.02);
  EXPECT_LT(flight.state.w_WB_B.norm(), 0.05);
}

TEST_P(BothLaws, FarReferenceStaysWithinTheLimits) {
  const ControllerOptions options;
  const ControlOutput output = controller_->Update({}, Hover(50.0, 20.0, 0.0));
  EXPECT_TRUE(output.tilt_limited);
  const Eigen::Vector3d z_B = output.R_WB_desired.col(2);
  EXPECT_LE(std::acos(z_B.z()), options.tilt_max + 1e-9);
  EXPECT_NEAR(z_B.y() / z_B.x(), 20.0 / 50.0, 1e-9);  // direction kept
  const ControlOutput up = controller_->Update({}, Hover(0.0, 0.0, 100.0));
  EXPECT_TRUE(up.thrust_limited);
  EXPECT_LE(up.wrench.thrust, options.thrust_fraction_max * 28.0 + 1e-9);
  const ControlOutput down = controller_->Update({}, Hover(1.0, 0.0, -100.0));
  EXPECT_TRUE(down.thrust_limited);
  EXPECT_GT(down.R_WB_desired(2, 2), 0.5);  // never upside down
}

TEST_P(BothLaws, SameInputsSameOutput) {
  estimation::VehicleState state;
  state.p_WB << 0.3, 0.1, -0.2;
  state.w_WB_B << 0.1, 0.2, 0.3;
  const planning::FlatState flat = Circle(0.4, 2.0, 3.0);
  EXPECT_EQ(controller_->Update(state, flat).wrench.moment_B,
            controller_->Update(state, flat).wrench.moment_B);
}

TEST(PositionLoop, SoftenedItIsThatOfALowerFrequency) {
  const estimation::VehicleModel model = TestVehicle();
  estimation::VehicleState state;
  state.p_WB << 0.3, -0.2, 1.4;
  state.v_WB << 1.0, 0.4, -0.3;
  planning::FlatState reference;
  reference.p_WB << 0.1, 0.25, 1.2;
  reference.v_WB << 1.3, 0.1, -0.2;
  reference.a_WB << 0.5, -0.4, 0.1;
  for (const double share : {0.0, 0.5, 0.8, 1.0}) {
    planning::FlatState softened = reference;
    SoftenHorizontally(share, state, &softened);
    ControllerOptions usual, lower;
    lower.position_frequency = share * usual.position_frequency;
    const Eigen::Vector3d is = PositionLoop(state, softened, model, usual);
    const Eigen::Vector3d wanted = PositionLoop(state, reference, model, lower);
    EXPECT_LT((is - wanted).norm(), 1e-12) << share;
  }
}

TEST(GeometricController, TracksFastReferencesWithinCentimetres) {
  const estimation::VehicleModel model = TestVehicle();
  const auto geometric = MakeController("geometric", model);
  const auto paper = MakeController("paper", model);
  const auto circle = [](double t) { return Circle(t, 3.0, 6.0); };
  const auto sweep = [](double t) { return Sweep(t, 3.0, 6.0); };
  const double circle_m = WorstErrorOn(*geometric, model, circle, 1.5, 6.0);
  const double sweep_m = WorstErrorOn(*geometric, model, sweep, 0.0, 6.0);
  const double paper_circle_m = WorstErrorOn(*paper, model, circle, 1.5, 6.0);
  RecordProperty("circle_m", std::to_string(circle_m));
  RecordProperty("sweep_m", std::to_string(sweep_m));
  RecordProperty("paper_circle_m", std::to_string(paper_circle_m));
  EXPECT_LT(circle_m, 0.06);
  EXPECT_LT(sweep_m, 0.06);
  EXPECT_LT(circle_m, paper_circle_m);
}

TEST(GeometricController, FeedsKnownRotorDragForward) {
  estimation::VehicleModel model = TestVehicle();
  model.rotor_drag << 0.3, 0.3, 0.0;
  const auto knows = MakeController("geometric", model);
  const auto ignorant = MakeController("geometric", TestVehicle());
  const auto straight = [](double t) {
    planning::FlatState flat;
    flat.v_WB << 2.5, 0.0, 0.0;
    flat.p_WB = t * flat.v_WB;
    return flat;
  };
  EXPECT_LT(WorstErrorOn(*knows, model, straight, 4.0, 6.0), 0.01);
  EXPECT_GT(WorstErrorOn(*ignorant, model, straight, 4.0, 6.0), 0.05);
}

TEST(GeometricController, BodyRateFollowsTheReference) {
  const estimation::VehicleModel model = TestVehicle();
  const auto controller = MakeController("geometric", model);
  const planning::FlatState flat = Circle(0.0, 3.0, 6.0);
  const planning::FlatInputs inputs = planning::InvertFlatness(flat);
  estimation::VehicleState state;
  state.p_WB = flat.p_WB;
  state.v_WB = flat.v_WB;
  state.q_WB = Eigen::Quaterniond(inputs.R_WB);
  state.w_WB_B = inputs.w_WB_B;
  const ControlOutput output = controller->Update(state, flat);
  EXPECT_LT((output.w_WB_B_desired - inputs.w_WB_B).norm(), 1e-12);
  EXPECT_NEAR(output.wrench.thrust, model.mass_kg * inputs.specific_thrust, 1e-9);
  // On the reference only the gyroscopic moment is left.
  const Eigen::Vector3d gyroscopic = state.w_WB_B.cross(model.inertia.cwiseProduct(state.w_WB_B));
  EXPECT_LT((output.wrench.moment_B - gyroscopic).norm(), 1e-9);
}

// Rotors that give more than the model get smaller commands, and a smaller limit.
TEST(GeometricController, AnswersWithTheThrustThatTheRotorsHave) {
  const estimation::VehicleModel model = TestVehicle();
  const auto controller = MakeController("geometric", model);
  estimation::VehicleState state;
  const auto with = [&](double gain, double height) {
    return controller->Update(state, Hover(0.4, 0.0, height),
                              {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), gain});
  };
  const ControlOutput nominal = with(1.0, 0.1), strong = with(1.5, 0.1);
  EXPECT_NEAR(strong.wrench.thrust, nominal.wrench.thrust / 1.5, 1e-9);
  EXPECT_EQ(strong.R_WB_desired, nominal.R_WB_desired);
  for (const double gain : {0.67, 1.0, 1.5}) {
    const ControlOutput most = with(gain, 50.0);
    EXPECT_TRUE(most.thrust_limited);
    EXPECT_LE(most.wrench.thrust, 28.0);
  }
}

// Rotors at their limit cannot follow the heading; the thrust axis must not turn because of that.
TEST(GeometricController, AHeadingFarOffDoesNotTurnTheThrustAxisAside) {
  const auto model = TestVehicle();
  const auto controller = MakeController("geometric", model);
  estimation::VehicleState state;
  for (const double roll : {0.3, 1.0, 1.4}) {
    state.q_WB = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    for (double yaw = -3.1; yaw < 3.14; yaw += 0.25) {
      const ControlOutput output = controller->Update(state, Hover(0.0, 0.0, 0.0, yaw));
      const Eigen::Vector3d turn = output.wrench.moment_B.cwiseQuotient(model.inertia);
      // Upright again about -x, with hardly anything about y.
      EXPECT_LT(turn.x(), 0.0) << roll << " " << yaw;
      EXPECT_GT(-turn.x(), 0.6 * turn.head<2>().norm()) << roll << " " << yaw;
      EXPECT_EQ(turn.z() > 0.0, yaw > 0.0) << roll << " " << yaw;
    }
  }
}

TEST(GeometricController, WhoIsUpsideDownTurnsUprightTheShortWay) {
  const auto model = TestVehicle();
  const auto controller = MakeController("geometric", model);
  for (double roll = 1.0; roll < 3.1; roll += 0.1) {
    estimation::VehicleState state;
    state.q_WB = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    const ControlOutput output = controller->Update(state, Hover());
    EXPECT_LT(output.wrench.moment_B.x(), 0.0) << roll;
    EXPECT_NEAR(output.wrench.moment_B.tail<2>().norm(), 0.0, 1e-9) << roll;
  }
}

TEST_P(BothLaws, TheTiltAskedForIsTheLeastOfBothLimits) {
  const auto tilt = [&](double most) {
    return estimation::Tilt(
        Eigen::Quaterniond(controller_->Update({}, Hover(50.0, 20.0, 0.0), {}, most).R_WB_desired));
  };
  EXPECT_NEAR(tilt(0.3), 0.3, 1e-9);
  EXPECT_NEAR(tilt(1.2), ControllerOptions{}.tilt_max, 1e-9);
}

TEST(Controller, BadArgumentsAreNamed) {
  const estimation::VehicleModel model = TestVehicle();
  EXPECT_THROW(MakeController("lqr", model), std::invalid_argument);
  ControllerOptions options;
  options.tilt_max = 2.0;
  try {
    MakeController("paper", model, options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("tilt_max = 2"));
  }
  estimation::VehicleModel heavy = model;
  heavy.mass_kg = 5.0;
  EXPECT_THROW(MakeController("geometric", heavy), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::control
