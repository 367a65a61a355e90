// SPDX-License-Identifier: BSD-3-Clause
#include "sim/pad/pad_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using estimation::PadState;
using Kind = PadMotionConfig::Kind;
using ::testing::AllOf;
using ::testing::HasSubstr;

PadMotionConfig Config(Kind kind) {
  PadMotionConfig config;
  config.kind = kind;
  config.p_start = {1.0, -2.0, 0.35};
  config.heading = 0.4;
  return config;
}

std::vector<PadMotionConfig> Motions() {
  PadMotionConfig right = Config(Kind::kStraightTurn);
  right.turn_angle = -2.0;
  right.turn_rate = 0.6;
  right.turn_ramp_s = 1.5;
  right.phase = 3.0;
  PadMotionConfig sharp = Config(Kind::kStraightTurn);
  sharp.turn_angle = std::numbers::pi;
  sharp.turn_rate = 0.5;
  sharp.turn_ramp_s = 6.0;  // nearly all of the turn is ramp
  sharp.turn_start = 0.0;
  PadMotionConfig clockwise = Config(Kind::kCircle);
  clockwise.turn_rate = -0.3;
  PadMotionConfig eight = Config(Kind::kFigureEight);
  eight.turn_rate = -0.5;
  PadMotionConfig stop = Config(Kind::kStopAndGo);
  stop.phase = 1.3;
  PadMotionConfig random = Config(Kind::kRandom);
  random.seed = 11;
  PadMotionConfig waypoints = Config(Kind::kWaypoints);
  waypoints.waypoints = {{{0, 0}, 0, 2}, {{9, 1}, 9, 3}, {{9, 1}, 14, 4}, {{15, 12}, 30, 5}};
  return {Config(Kind::kStatic),
          Config(Kind::kLine),
          Config(Kind::kCircle),
          clockwise,
          Config(Kind::kStraightTurn),
          right,
          sharp,
          eight,
          stop,
          Config(Kind::kReversing),
          random,
          waypoints};
}

bool ChangesSpeed(const PadMotionConfig& config) {
  return config.kind == Kind::kStopAndGo || config.kind == Kind::kReversing ||
         config.kind == Kind::kRandom || config.kind == Kind::kWaypoints;
}

TEST(PadMotion, DerivativesAreThoseOfThePosition) {
  const double h = 1e-4;
  for (const PadMotionConfig& config : Motions()) {
    const PadMotion motion(config);
    for (double t = -5.0; t < 40.0; t += 0.0937) {
      const PadState before = motion.At(t - h);
      const PadState now = motion.At(t);
      const PadState after = motion.At(t + h);
      const auto difference = [&](auto member) {
        return Eigen::Vector3d((after.*member - before.*member) / (2.0 * h));
      };
      EXPECT_LT((difference(&PadState::p_WP) - now.v_WP).norm(), 1e-7);
      EXPECT_LT((difference(&PadState::v_WP) - now.a_WP).norm(), 1e-6);
      EXPECT_LT((difference(&PadState::a_WP) - now.j_WP).norm(), 1e-3);
      EXPECT_NEAR((after.yaw - before.yaw) / (2.0 * h), now.yaw_rate, 1e-6);
    }
  }
}

// A difference quotient does not check the ramp's quadrature. So v is integrated by Simpson's rule
// on a fine grid.
TEST(PadMotion, PositionIsTheIntegralOfTheVelocity) {
  for (const PadMotionConfig& config : Motions()) {
    const PadMotion motion(config);
    const double t_end = 30.0;
    const int n = 6000;
    const double h = t_end / n;
    Eigen::Vector3d sum = motion.At(0.0).v_WP + motion.At(t_end).v_WP;
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * motion.At(i * h).v_WP;
    const Eigen::Vector3d moved = motion.At(t_end).p_WP - motion.At(0.0).p_WP;
    EXPECT_LT((h / 3.0 * sum - moved).norm(), 1e-9);
  }
}

TEST(PadMotion, DrivesAlongItsHeadingAndJerkIsContinuous) {
  for (const PadMotionConfig& config : Motions()) {
    const PadMotion motion(config);
    PadState last = motion.At(-5.0);
    for (double t = -5.0; t < 40.0; t += 1e-3) {
      const PadState pad = motion.At(t);
      const double speed = config.kind == Kind::kStatic ? 0.0 : config.speed;
      if (!ChangesSpeed(config)) {
        ASSERT_NEAR(pad.v_WP.norm(), speed, 1e-12);
        ASSERT_NEAR(pad.v_WP.x(), speed * std::cos(pad.yaw), 1e-12);
      }
      ASSERT_NEAR(pad.v_WP.x() * std::sin(pad.yaw), pad.v_WP.y() * std::cos(pad.yaw), 1e-12);
      ASSERT_EQ(pad.p_WP.z(), config.p_start.z());
      ASSERT_LT((pad.a_WP - last.a_WP).norm(), 2e-3);
      ASSERT_LT((pad.j_WP - last.j_WP).norm(), 2e-2);
      last = pad;
    }
  }
}

TEST(PadMotion, StraightTurnTurnsByItsAngle) {
  PadMotionConfig config = Config(Kind::kStraightTurn);
  const PadMotion motion(config);
  EXPECT_DOUBLE_EQ(motion.At(config.turn_start / config.speed - 0.01).yaw, config.heading);
  const double turn_time = config.turn_angle / config.turn_rate + config.turn_ramp_s;
  const PadState after = motion.At(config.turn_start / config.speed + turn_time + 0.01);
  EXPECT_NEAR(after.yaw, config.heading + config.turn_angle, 1e-12);
  EXPECT_EQ(after.yaw_rate, 0.0);
  const double middle = config.turn_start / config.speed + 0.5 * turn_time;
  EXPECT_NEAR(motion.At(middle).yaw_rate, config.turn_rate, 1e-12);
  EXPECT_NEAR(motion.At(middle).yaw, config.heading + 0.5 * config.turn_angle, 1e-12);
}

TEST(PadMotion, CircleClosesAfterOneTurn) {
  const PadMotionConfig config = Config(Kind::kCircle);
  const PadMotion motion(config);
  const double period = 2.0 * std::numbers::pi / config.turn_rate;
  EXPECT_LT((motion.At(period).p_WP - motion.At(0.0).p_WP).norm(), 1e-9);
  const double diameter = (motion.At(0.5 * period).p_WP - motion.At(0.0).p_WP).norm();
  EXPECT_NEAR(diameter, 2.0 * config.speed / config.turn_rate, 1e-9);
}

TEST(PadMotion, PhaseIsAHeadStart) {
  for (PadMotionConfig config : Motions()) {
    if (config.kind == Kind::kStatic || config.kind == Kind::kWaypoints) continue;
    const PadMotion motion(config);
    config.phase += 2.5;
    const PadMotion ahead(config);
    for (const double t : {-3.0, 0.0, 7.3, 21.0}) {
      EXPECT_LT((ahead.At(t).p_WP - motion.At(t + 2.5 / config.speed).p_WP).norm(), 1e-9);
    }
  }
}

TEST(PadMotion, KeepsItsBounds) {
  for (const PadMotionConfig& config : Motions()) {
    const PadMotion motion(config);
    const PadMotionBounds bounds = motion.bounds();
    double speed = 0.0, acceleration = 0.0;
    for (double t = -5.0; t < 120.0; t += 0.01) {
      const PadState pad = motion.At(t);
      speed = std::max(speed, pad.v_WP.norm());
      acceleration = std::max(acceleration, pad.a_WP.norm());
      const double turning = (motion.At(t + 1e-4).yaw_rate - motion.At(t - 1e-4).yaw_rate) / 2e-4;
      ASSERT_LE(std::abs(turning), bounds.yaw_acceleration + 1e-6);
    }
    EXPECT_LE(speed, bounds.speed + 1e-12);
    EXPECT_LE(acceleration, bounds.acceleration + 1e-12);
    EXPECT_GE(speed, 0.9 * bounds.speed);
    EXPECT_GE(acceleration, 0.4 * bounds.acceleration);
  }
}

TEST(PadMotion, FigureEightClosesAndCrossesItself) {
  PadMotionConfig config = Config(Kind::kFigureEight);
  config.turn_rate = 0.4;
  const PadMotion motion(config);
  const FigureEight path(config.p_start.head<2>(), config.heading, config.turn_rate / config.speed);
  const double period = path.length() / config.speed;
  EXPECT_LT((motion.At(period).p_WP - motion.At(0.0).p_WP).norm(), 1e-9);
  EXPECT_NEAR(motion.At(0.0).yaw_rate, 0.4, 1e-12);
  EXPECT_NEAR(motion.At(0.5 * period).yaw_rate, -0.4, 1e-12);
  // The crossing is passed a quarter and three quarters of the way, from two directions.
  const PadState there = motion.At(0.25 * period), again = motion.At(0.75 * period);
  EXPECT_LT((there.p_WP - again.p_WP).norm(), 1e-9);
  EXPECT_NEAR(there.yaw - again.yaw, 2.0 * 2.404825557695773, 1e-9);
  EXPECT_GT((motion.At(0.5 * period).p_WP - motion.At(0.0).p_WP).norm(), 3.0);
}

TEST(PadMotion, ReversingKeepsItsHeadingAndStopsStand) {
  const PadMotion back(Config(Kind::kReversing));
  EXPECT_EQ(back.At(0.5).yaw, back.At(8.5).yaw);
  EXPECT_NEAR(back.At(8.5).v_WP.dot(back.At(0.5).v_WP), -0.64, 1e-9);
  PadMotionConfig config = Config(Kind::kStopAndGo);
  const PadMotion stop(config);
  EXPECT_LT(stop.At(8.1).v_WP.norm(), 1e-12);
  EXPECT_LT((stop.At(8.1).p_WP - stop.At(9.3).p_WP).norm(), 1e-12);
}

TEST(PadMotion, RandomDrivesKeepTheirLimitsAndDiffer) {
  PadMotionConfig config = Config(Kind::kRandom);
  config.turn_rate = 0.8;
  for (const double speed : {0.8, 5.0}) {
    config.speed = speed;
    double sharpest = 0.0, steepest = 0.0;
    std::vector<Eigen::Vector3d> ends;
    for (config.seed = 1; config.seed <= 4; ++config.seed) {
      const PadMotion motion(config);
      for (double t = 0.0; t < 300.0; t += 0.01) {
        const PadState pad = motion.At(t);
        ASSERT_LE(pad.j_WP.norm(), config.jerk * (1.0 + 1e-9));
        ASSERT_LE(std::abs(pad.yaw_rate), config.turn_rate * (1.0 + 1e-9));
        const Eigen::Vector3d ahead(std::cos(pad.yaw), std::sin(pad.yaw), 0.0);
        const double along = ahead.dot(pad.a_WP), across = ahead.cross(pad.a_WP).z();
        ASSERT_LE(std::abs(along), config.acceleration * (1.0 + 1e-9));
        ASSERT_LE(std::abs(across), config.acceleration * (1.0 + 1e-9));
        steepest = std::max({steepest, std::abs(along), std::abs(across)});
        sharpest = std::max(sharpest, pad.j_WP.norm());
      }
      ends.push_back(motion.At(60.0).p_WP);
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        EXPECT_GT((ends[i] - ends.back()).norm(), 1.0);
      EXPECT_EQ(PadMotion(config).At(60.0).p_WP, ends.back());
    }
    EXPECT_GT(sharpest, 0.1 * config.jerk);
    EXPECT_GT(steepest, 0.4 * config.acceleration);
  }
}

// Phases and times up to the limits of a scenario's keys: no motion runs out of its drive.
TEST(PadMotion, ChangesItsSpeedAtAnyPhaseAndTime) {
  for (const Kind kind : {Kind::kStopAndGo, Kind::kReversing, Kind::kRandom}) {
    PadMotionConfig config = Config(kind);
    config.speed = 0.01;
    for (config.phase = kind == Kind::kRandom ? 0.0 : -100.0; config.phase <= 100.0;
         config.phase += 50.0) {
      const PadMotion motion(config);
      for (const double from : {0.0, 540.0}) {
        double slowest = config.speed, fastest = 0.0;
        for (double t = from; t < from + 60.0; t += 0.1) {
          const PadState pad = motion.At(t);
          const double speed = pad.v_WP.x() * std::cos(pad.yaw) + pad.v_WP.y() * std::sin(pad.yaw);
          slowest = std::min(slowest, speed);
          fastest = std::max(fastest, speed);
        }
        EXPECT_LT(slowest, 0.9 * fastest) << config.phase << " m, " << from << " s";
      }
    }
  }
}

TEST(PadMotion, ARandomDriveIsTheSameWhateverItsPhase) {
  PadMotionConfig config = Config(Kind::kRandom);
  config.seed = 3;
  const PadMotion motion(config);
  config.phase = 100.0;  // drawn for longer
  const PadMotion ahead(config);
  for (const double t : {0.0, 30.0, 500.0}) {
    EXPECT_LT((ahead.At(t).p_WP - motion.At(t + 125.0).p_WP).norm(), 1e-9);
  }
}

TEST(PadMotion, OracleKnowsTheFuture) {
  const PadMotion motion(Config(Kind::kStraightTurn));
  const OraclePadPrediction oracle(motion);
  const estimation::PadPrediction& prediction = oracle;
  for (const double t : {-1.0, 0.0, 12.34, 100.0}) {
    EXPECT_EQ(prediction.At(t).p_WP, motion.At(t).p_WP);
    EXPECT_EQ(prediction.At(t).j_WP, motion.At(t).j_WP);
    EXPECT_EQ(prediction.At(t).cov_p, Eigen::Matrix2d::Zero());
  }
}

TEST(PadMotion, RefusesByNameValueAndRange) {
  const auto message = [](auto change) {
    PadMotionConfig config = Config(Kind::kStraightTurn);
    change(&config);
    return test::MessageOf<std::invalid_argument>([&] { PadMotion{config}; });
  };
  EXPECT_EQ(message([](PadMotionConfig*) {}), "");
  EXPECT_THAT(message([](PadMotionConfig* c) { c->speed = 30.0; }),
              AllOf(HasSubstr("pad.speed is 30"), HasSubstr("[0, 20]")));
  EXPECT_THAT(message([](PadMotionConfig* c) { c->turn_angle = 0.01; }),
              AllOf(HasSubstr("turn_angle is 0.01"), HasSubstr("[0.075,")));
  EXPECT_THAT(message([](PadMotionConfig* c) { c->turn_rate = std::nan(""); }),
              HasSubstr("pad.turn_rate is nan"));
  EXPECT_THAT(message([](PadMotionConfig* c) { c->phase = INFINITY; }), HasSubstr("pad.phase"));
  const auto changing = [&](Kind kind, auto change) {
    return message([&](PadMotionConfig* c) {
      c->kind = kind;
      change(c);
    });
  };
  EXPECT_THAT(changing(Kind::kStopAndGo, [](PadMotionConfig* c) { c->stop_time = 0.0; }),
              AllOf(HasSubstr("pad.stop_time is 0"), HasSubstr("[3.6, 600]")));
  EXPECT_THAT(changing(Kind::kReversing, [](PadMotionConfig* c) { c->acceleration = 0.0; }),
              HasSubstr("pad.acceleration is 0"));
  EXPECT_THAT(changing(Kind::kReversing,
                       [](PadMotionConfig* c) {
                         c->acceleration = 0.05;
                         c->speed = 10.0;
                       }),
              AllOf(HasSubstr("pad.acceleration is 0.05"), HasSubstr("[0.075, 20]")));
  EXPECT_THAT(changing(Kind::kRandom, [](PadMotionConfig* c) { c->phase = 9000.0; }),
              AllOf(HasSubstr("pad.phase is 9000"), HasSubstr("8000]")));
  EXPECT_THAT(changing(Kind::kRandom, [](PadMotionConfig* c) { c->jerk = -1.0; }),
              HasSubstr("pad.jerk is -1"));
  EXPECT_THAT(changing(Kind::kFigureEight, [](PadMotionConfig* c) { c->turn_rate = 0.0; }),
              HasSubstr("pad.turn_rate is 0"));
  EXPECT_THAT(changing(Kind::kWaypoints, [](PadMotionConfig*) {}), HasSubstr("two places"));
}

}  // namespace
}  // namespace touchdown::sim
