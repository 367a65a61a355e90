// SPDX-License-Identifier: BSD-3-Clause
// The observer beside a rigid body that is pushed by known thrusts and known disturbances. No tracking
// law is in the loop here: what it makes of the estimate is tested where the whole vehicle flies.
#include "control/tracking/disturbance_observer.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/test/flight_model.h"

namespace touchdown::control {
namespace {

constexpr double kStep = 0.002;  // [s]

/// A body on which thrusts behind a lag and a disturbance act; Euler steps a tenth as long as the
/// control step.
class Body {
 public:
  explicit Body(const estimation::VehicleModel& model) : model_(model), mixer_(model) {
    thrusts_.setConstant(0.25 * model.HoverThrust());
  }

  estimation::VehicleState state;

  void Step(const Eigen::Vector4d& command, const Disturbance& disturbance) {
    constexpr int kParts = 10;
    const double dt = kStep / kParts;
    for (int i = 0; i < kParts; ++i) {
      const Eigen::Matrix3d R_WB = state.q_WB.toRotationMatrix();
      const Wrench wrench = mixer_.Apply(thrusts_);
      const Eigen::Vector3d drag_B = model_.rotor_drag.cwiseProduct(R_WB.transpose() * state.v_WB);
      const Eigen::Vector3d force_W =
          R_WB * (disturbance.thrust_gain * wrench.thrust * Eigen::Vector3d::UnitZ() - drag_B) +
          disturbance.force_W;
      const Eigen::Vector3d& w = state.w_WB_B;
      const Eigen::Vector3d moment_B =
          wrench.moment_B - w.cross(model_.inertia.cwiseProduct(w)) + disturbance.moment_B;
      state.v_WB +=
          dt * (force_W / model_.mass_kg - estimation::kGravity * Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d turn = dt * w;
      state.w_WB_B += dt * moment_B.cwiseQuotient(model_.inertia);
      state.q_WB = (state.q_WB * Eigen::Quaterniond(Eigen::AngleAxisd(
                                     turn.norm(), turn.norm() > 0.0 ? turn.normalized()
                                                                    : Eigen::Vector3d::UnitX())))
                       .normalized();
      thrusts_ += dt / model_.rotor_lag_s * (command - thrusts_);
    }
    state.t += kStep;
  }

 private:
  estimation::VehicleModel model_;
  Mixer mixer_;
  Eigen::Vector4d thrusts_;
};

estimation::VehicleModel Vehicle() {
  estimation::VehicleModel model = TestVehicle();
  model.rotor_drag << 0.2, 0.2, 0.0;
  return model;
}

/// Thrusts that shake the vehicle, but do not turn it over.
Eigen::Vector4d Shaking(const estimation::VehicleModel& model, double t) {
  const double hover = 0.25 * model.HoverThrust();
  const double a = 0.15 * std::sin(9.0 * t);
  const double b = 0.10 * std::cos(13.0 * t);
  return Eigen::Vector4d(hover + a, hover - a, hover + b, hover - b).array() +
         0.8 * std::sin(3.0 * t);
}

using Pushes = std::function<Disturbance(double)>;

/// Flies for `duration`; `watch` sees every estimate.
void Fly(DisturbanceObserver* observer, Body* body, double duration, const Pushes& pushes,
         const std::function<void(double, const Disturbance&)>& watch = {}) {
  const estimation::VehicleModel model = Vehicle();
  const double end = body->state.t + duration;
  while (body->state.t < end - 0.5 * kStep) {
    const double t = body->state.t;
    const Disturbance& estimate = observer->Update(body->state, false);
    if (watch) watch(t, estimate);
    const Eigen::Vector4d command = Shaking(model, t);
    observer->Command(command);
    body->Step(command, pushes(t));
  }
}

Disturbance Steady() { return {{3.0, -2.0, 0.0}, {0.02, -0.01, 0.005}}; }

TEST(DisturbanceObserver, FindsASteadyDisturbanceWhileTheVehicleIsShaken) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  Fly(&observer, &body, 4.0, [](double) { return Steady(); });
  // Thrust and attitude are held over a step: under 1 % is left of the shaking.
  EXPECT_LT((observer.disturbance().force_W - Steady().force_W).norm(), 0.05);
  EXPECT_LT((observer.disturbance().moment_B - Steady().moment_B).norm(), 4e-4);
}

/// Flies with the thrust with which a body of that gain hovers upright, shaken up and down by `share` of it.
void Heave(DisturbanceObserver* observer, Body* body, double duration, double share,
           const Disturbance& push) {
  const double hover = 0.25 * Vehicle().HoverThrust() / push.thrust_gain;
  const double end = body->state.t + duration;
  while (body->state.t < end) {
    observer->Update(body->state, false);
    const Eigen::Vector4d command =
        Eigen::Vector4d::Constant(hover * (1.0 + share * std::sin(3.0 * body->state.t)));
    observer->Command(command);
    body->Step(command, push);
  }
}

// A force that grows with the thrust is not wind, upright or leaning.
TEST(DisturbanceObserver, RotorsAndMassThatAreNotTheModelsAreAFactorOfTheThrust) {
  for (const double gain : {0.67, 1.0, 1.5}) {
    for (const double lean : {0.0, 0.35}) {
      SCOPED_TRACE(testing::Message() << "gain " << gain << ", lean " << lean);
      DisturbanceObserver observer(Vehicle());
      Body body(Vehicle());
      body.state.q_WB = Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitX());
      const Disturbance wind = {{3.0, -2.0, 0.0}, Eigen::Vector3d::Zero(), gain};
      // Meanwhile the sum of factor and force is already right: no part is counted twice.
      Heave(&observer, &body, 1.5, 0.0, wind);
      const Disturbance& found = observer.disturbance();
      const Eigen::Vector3d thrust_W =
          Vehicle().HoverThrust() / gain * (body.state.q_WB * Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d left_W = (gain - found.thrust_gain) * thrust_W;
      EXPECT_LT((found.force_W - wind.force_W - left_W).norm(), 0.12);
      Heave(&observer, &body, 4.5, 0.2, wind);
      EXPECT_NEAR(found.thrust_gain, gain, 0.02);
      EXPECT_LT((found.force_W - wind.force_W).norm(), 0.2);
    }
  }
}

TEST(DisturbanceObserver, TheFactorIsBoundedAndLearnedInFlightAlone) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  Heave(&observer, &body, 8.0, 0.2, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 3.0});
  EXPECT_EQ(observer.disturbance().thrust_gain, 2.0);
  // On the deck, and with hardly any thrust, it stays as it is.
  for (int i = 0; i < 500; ++i) {
    body.state.t += kStep;
    body.state.v_WB.setZero();
    observer.Update(body.state, true);
  }
  EXPECT_EQ(observer.disturbance().thrust_gain, 2.0);
  DisturbanceObserver falls(Vehicle());
  Body stone(Vehicle());
  for (int i = 0; i < 500; ++i) {
    falls.Update(stone.state, false);
    falls.Command(Eigen::Vector4d::Constant(0.02));
    stone.Step(Eigen::Vector4d::Constant(0.02), {{0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}});
    if (i == 150) {
      EXPECT_GT(falls.disturbance().force_W.z(), 0.5);
    }
  }
  EXPECT_LT(falls.disturbance().thrust_gain, 1.1);
}

TEST(DisturbanceObserver, NothingIsFoundWhereNothingActs) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  double worst = 0.0;
  Fly(
      &observer, &body, 4.0, [](double) { return Disturbance{}; },
      [&](double, const Disturbance& d) { worst = std::max(worst, d.force_W.norm()); });
  EXPECT_LT(worst, 0.03);  // thrust turns while a step lasts: the model holds it
}

TEST(DisturbanceObserver, StepResponseIsThatOfTwoEqualPoles) {
  const DisturbanceObserverOptions options;
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  Fly(&observer, &body, 1.0, [](double) { return Disturbance{}; });
  const double t0 = body.state.t;
  Fly(
      &observer, &body, 2.0,
      [](double) {
        return Disturbance{{2.0, 0.0, 0.0}, {0.0, 0.02, 0.0}};
      },
      [&](double t, const Disturbance& d) {
        const auto response = [&](double w) {
          return 1.0 - (1.0 + w * (t - t0)) * std::exp(-w * (t - t0));
        };
        EXPECT_NEAR(d.force_W.x(), 2.0 * response(options.force_bandwidth), 0.05) << t;
        EXPECT_NEAR(d.moment_B.y(), 0.02 * response(options.moment_bandwidth), 1e-3) << t;
      });
}

TEST(DisturbanceObserver, SteadyForceIsTheSlowPart) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  // A gust to and fro about a steady push, once a second.
  Fly(&observer, &body, 12.0, [](double t) {
    return Disturbance{{2.0 + 1.5 * std::sin(2.0 * std::numbers::pi * t), 0.0, 0.0}, {0, 0, 0}};
  });
  EXPECT_NEAR(observer.steady_force_W().x(), 2.0, 0.15);
}

TEST(DisturbanceObserver, KnowsHowAGustGrows) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  constexpr double kGrows = 5.0;  // [N/s]
  Fly(&observer, &body, 1.0, [](double) { return Steady(); });
  EXPECT_LT(observer.force_rate_W().norm(), 0.1 * kGrows);
  const double t0 = body.state.t;
  Fly(&observer, &body, 0.7, [&](double t) {
    return Disturbance{{3.0 + kGrows * (t - t0), -2.0, 0.0}, {0, 0, 0}};
  });
  EXPECT_NEAR(observer.force_rate_W().x(), kGrows, 0.1 * kGrows);
  observer.Update(body.state, true);
  body.state.t += kStep;
  observer.Update(body.state, true);  // on its feet it learns nothing
  EXPECT_EQ(observer.force_rate_W().norm(), 0.0);
}

TEST(DisturbanceObserver, AGustIsRememberedThroughALullAndSteadyWindIsNone) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  const auto push = [](double x) {
    return [x](double) { return Disturbance{{x, 0.0, 0.0}, Eigen::Vector3d::Zero()}; };
  };
  Fly(&observer, &body, 20.0, push(2.0));
  const double steady = observer.gust_force();
  EXPECT_LT(steady, 0.5);  // what is left of its onset
  Fly(&observer, &body, 1.0, push(8.0));
  Fly(&observer, &body, 1.0, push(2.0));
  const double after = observer.gust_force();
  EXPECT_GT(after, 2.0 * steady);
  Fly(&observer, &body, 10.0, push(2.0));
  EXPECT_GT(observer.gust_force(), 0.7 * after);
}

TEST(DisturbanceObserver, FeetInContactTeachNothing) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  Fly(&observer, &body, 3.0, [](double) { return Steady(); });
  const Eigen::Vector3d before = observer.disturbance().force_W;
  // It stands: the deck carries what the rotors do not.
  for (int i = 0; i < 2000; ++i) {
    body.state.t += kStep;
    body.state.v_WB.setZero();
    body.state.w_WB_B.setZero();
    observer.Update(body.state, true);
    observer.Command(Eigen::Vector4d::Zero());
  }
  EXPECT_EQ(observer.disturbance().force_W, before);
  // Off again: no kick.
  double worst = 0.0;
  Body again(Vehicle());
  again.state = body.state;
  observer.Command(Eigen::Vector4d::Constant(0.25 * Vehicle().HoverThrust()));
  for (int i = 0; i < 300; ++i) {  // the rotors spin up on the deck
    again.state.t += kStep;
    observer.Update(again.state, true);
  }
  Fly(
      &observer, &again, 1.0, [](double) { return Steady(); },
      [&](double, const Disturbance& d) { worst = std::max(worst, (d.force_W - before).norm()); });
  EXPECT_LT(worst, 0.1);
}

TEST(DisturbanceObserver, SaturationDoesNotWindItUp) {
  // Beyond their limit the rotors give less than commanded: that is no disturbance.
  const estimation::VehicleModel model = Vehicle();
  const Mixer mixer(model);
  DisturbanceObserver observer(model);
  Body body(model);
  for (int i = 0; i < 1500; ++i) {
    observer.Update(body.state, false);
    const MixerOutput mix = mixer.Mix({56.0, Eigen::Vector3d::Zero()});
    ASSERT_TRUE(mix.saturated);
    observer.Command(mix.thrusts);
    body.Step(mix.thrusts, {});
  }
  EXPECT_LT(observer.disturbance().force_W.norm(), 0.02);
}

TEST(DisturbanceObserver, NoisyVelocityHardlyShakesTheEstimate) {
  // Remaining error of the own-state filter: 3 cm/s that change ten times a second.
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 0.03);
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < 10000; ++i) {
    if (i % 50 == 0) error = Eigen::Vector3d{normal(random), normal(random), normal(random)};
    estimation::VehicleState noisy = body.state;
    noisy.v_WB += error;
    const Disturbance& d = observer.Update(noisy, false);
    if (i > 1000) {
      squares += (d.force_W - Steady().force_W).squaredNorm();
      ++count;
    }
    const Eigen::Vector4d command = Shaking(Vehicle(), body.state.t);
    observer.Command(command);
    body.Step(command, Steady());
  }
  // Per axis, over the weight: two thirds of a degree of tilt.
  EXPECT_LT(std::sqrt(squares / count / 3.0) / Vehicle().HoverThrust(), 0.0116);
}

TEST(DisturbanceObserver, AJumpOfTheStateIsNoForce) {
  DisturbanceObserver observer(Vehicle());
  Body body(Vehicle());
  Fly(&observer, &body, 3.0, [](double) { return Steady(); });
  const Eigen::Vector3d before = observer.disturbance().force_W;
  body.state.v_WB.x() += 1.0;
  observer.Update(body.state, false);
  EXPECT_EQ(observer.disturbance().force_W, before);
  estimation::VehicleState broken = body.state;
  broken.t += kStep;
  broken.v_WB.x() = std::numeric_limits<double>::quiet_NaN();
  observer.Update(broken, false);
  EXPECT_EQ(observer.disturbance().force_W, before);
}

TEST(DisturbanceObserver, AfterAGapTheRotorsHaveFollowed) {
  const estimation::VehicleModel model = Vehicle();
  const Eigen::Vector4d hover = Eigen::Vector4d::Constant(0.25 * model.HoverThrust());
  DisturbanceObserver observer(model);
  estimation::VehicleState state;
  observer.Command(1.5 * hover);
  for (; state.t < 0.5; state.t += kStep) {
    observer.Update(state, true);  // held: nothing is learned, but the rotors turn up
    observer.Command(1.5 * hover);
  }
  observer.Command(hover);
  state.t += 1.0;
  for (int k = 0; k < 100; ++k, state.t += kStep) {
    EXPECT_NEAR(observer.Update(state, false).force_W.norm(), 0.0, 1e-9);
    observer.Command(hover);
  }
}

TEST(DisturbanceObserver, EstimateIsBounded) {
  DisturbanceObserverOptions options;
  options.force_max = 0.2;
  DisturbanceObserver observer(Vehicle(), options);
  Body body(Vehicle());
  Fly(
      &observer, &body, 3.0,
      [](double) {
        return Disturbance{{20.0, 0.0, 0.0}, {0, 0, 0}};
      },
      [&](double, const Disturbance& d) {
        EXPECT_LE(d.force_W.norm(), 0.2 * Vehicle().HoverThrust() + 1e-9);
      });
  // And comes back at once when the push is over.
  Fly(&observer, &body, 1.5, [](double) { return Disturbance{}; });
  EXPECT_LT(observer.disturbance().force_W.norm(), 0.1);
}

TEST(DisturbanceObserver, OptionsOutOfRangeAreNamed) {
  DisturbanceObserverOptions options;
  options.force_bandwidth = 0.0;
  try {
    DisturbanceObserver(Vehicle(), options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("force_bandwidth = 0"));
  }
}

TEST(DisturbanceObserver, KnowsAfterAHoverWhatHeldTheVehicle) {
  const estimation::VehicleModel model = Vehicle();
  DisturbanceObserver observer(model);
  // 20 % lighter than the model, leaning by 0.3 rad against wind along x.
  constexpr double kTilt = 0.3, kMass = 0.8;
  estimation::VehicleState state;
  state.t = 3.0;
  state.q_WB = Eigen::AngleAxisd(-kTilt, Eigen::Vector3d::UnitY());
  const double thrust = kMass * model.HoverThrust() / std::cos(kTilt);
  observer.Hover(state, Eigen::Vector4d::Constant(0.25 * thrust));

  const Disturbance& learnt = observer.disturbance();
  EXPECT_NEAR(learnt.thrust_gain, 1.0 / kMass, 1e-3);
  const double wind = model.HoverThrust() * std::tan(kTilt);
  EXPECT_NEAR(learnt.force_W.x(), wind, 1e-3 * wind);
  EXPECT_NEAR(learnt.force_W.z(), 0.0, 1e-3 * wind);
  EXPECT_NEAR(observer.steady_force_W().x(), wind, 1e-3 * wind);
  EXPECT_NEAR(observer.gust_force(), 0.3 * wind, 1e-3 * wind);
  EXPECT_LT(learnt.moment_B.norm(), 1e-9);
  // The flight goes on from there: no step is lost and nothing jumps.
  const Disturbance before = learnt;
  state.t += kStep;
  EXPECT_NEAR(observer.Update(state, false).force_W.x(), before.force_W.x(), 1e-3 * wind);
}

}  // namespace
}  // namespace touchdown::control
