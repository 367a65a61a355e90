// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/landing_time.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "evaluation/judge/landing_judge.h"

namespace touchdown::evaluation {
namespace {

using Kind = sim::PadMotionConfig::Kind;

double Uniform(std::mt19937_64* random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(*random);
}

Eigen::Vector3d OnSphere(std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d{normal(*random), normal(*random), normal(*random)}.normalized();
}

/// A pad on a line along x through the origin's height.
sim::PadMotion Line(double x, double speed) {
  sim::PadMotionConfig config;
  config.kind = speed == 0.0 ? Kind::kStatic : Kind::kLine;
  config.p_start = {x, 0.0, 0.0};
  config.heading = speed < 0.0 ? 3.14159265358979323846 : 0.0;
  config.speed = std::abs(speed);
  return sim::PadMotion(config);
}

LandingTimeTask TaskOn(const sim::PadMotion& motion) {
  LandingTimeTask task;
  task.pad_rates = motion.bounds();
  return task;
}

/// Start, limits and pad drawn so that most pads can be caught.
struct RandomTask {
  explicit RandomTask(std::mt19937_64* random) {
    sim::PadMotionConfig config;
    const Kind kinds[] = {Kind::kStatic, Kind::kLine, Kind::kCircle, Kind::kStraightTurn};
    config.kind = kinds[(*random)() % 4];
    config.p_start = {Uniform(random, -15, 15), Uniform(random, -15, 15),
                      Uniform(random, 0.2, 1.0)};
    config.heading = Uniform(random, -3, 3);
    config.turn_rate = Uniform(random, 0.1, 0.8);
    config.turn_start = Uniform(random, 0, 8);
    const double speed = Uniform(random, 1.0, 8.0);
    config.speed = config.kind == Kind::kStatic ? 0.0 : Uniform(random, 0.1, 0.8) * speed;
    motion = sim::PadMotion(config);
    task = TaskOn(motion);
    task.p_WB = {Uniform(random, -3, 3), Uniform(random, -3, 3), Uniform(random, 1.5, 6.0)};
    task.speed = speed;
    task.acceleration = Uniform(random, 1.0, 10.0);
    task.horizon = 120.0;
  }
  sim::PadMotion motion{sim::PadMotionConfig{}};
  LandingTimeTask task;
};

/// Some point of the feet at some attitude may touch the deck, and contact would be soft enough.
bool InContact(const LandingTimeTask& task, const estimation::PadState& pad,
               const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
  const Eigen::Vector3d offset = p - pad.p_WP;
  const Eigen::Vector2d on_deck = Eigen::Rotation2Dd(-pad.yaw) * offset.head<2>();
  const double beyond = (on_deck.cwiseAbs().array() - task.deck_half_size).max(0.0).matrix().norm();
  const Eigen::Vector3d relative = v - DeckPointVelocity(pad, p);
  return std::hypot(beyond, offset.z()) <= task.foot_reach &&
         relative.head<2>().norm() <= task.horizontal_speed &&
         std::abs(relative.z()) <= task.vertical_speed;
}

/// From rest along a straight line, ending at u after some coasting.
double StraightFlight(const LandingTimeTask& task, double way, double u) {
  const double v = task.speed, a = task.acceleration;
  const double ramps = (v * v + v * v - u * u) / (2.0 * a);
  return v / a + (v - u) / a + (way - ramps) / v;
}

TEST(LandingTime, PadAtRestStraightAheadIsTheTextbookCase) {
  // To the near edge of a deck that is square on, or to the near corner of one at 45 degrees.
  for (const double heading : {0.0, 0.78539816339744831}) {
    sim::PadMotionConfig config;
    config.kind = Kind::kStatic;
    config.p_start = {20.0, 0.0, 0.0};
    config.heading = heading;
    config.speed = 0.0;
    const sim::PadMotion pad(config);
    LandingTimeTask task = TaskOn(pad);
    const sim::OraclePadPrediction oracle(pad);
    const double deck = heading == 0.0 ? task.deck_half_size : task.deck_radius();

    // With a foot stretched forwards, where the vehicle may still move at 0.6 m/s.
    const double u = task.horizontal_speed;
    const double reached = StraightFlight(task, 20.0 - deck - task.foot_reach, u);
    const double bound = LandingTimeLowerBound(task, oracle);
    EXPECT_LE(bound, reached) << heading;
    EXPECT_GT(bound, reached - 2e-4) << heading;

    // Level, the foot ahead slides onto it.
    task.p_WB.z() = task.foot_depth;
    const double level = StraightFlight(task, 20.0 - deck - task.foot_radius, u);
    const auto found = LandingTimeUpperBound(task, oracle, bound);
    ASSERT_TRUE(found.has_value());
    EXPECT_GE(found->time, level) << heading;
    EXPECT_LT(found->time, 1.005 * level) << heading;
  }
}

TEST(LandingTime, NoFlightIsFoundFromBelowTheDeck) {
  const sim::PadMotion pad = Line(5.0, 0.0);
  LandingTimeTask task = TaskOn(pad);
  const sim::OraclePadPrediction oracle(pad);
  task.p_WB.z() = task.foot_depth - 0.01;
  EXPECT_FALSE(LandingTimeUpperBound(task, oracle, 1.0).has_value());
}

TEST(LandingTime, ShortWayWithoutCoasting) {
  const sim::PadMotion pad = Line(3.0, 0.0);
  LandingTimeTask task = TaskOn(pad);
  task.acceleration = 1.0;
  const double way = 3.0 - task.deck_half_size - task.foot_reach;
  const double u = task.horizontal_speed;
  const double peak = std::sqrt(way * task.acceleration + 0.5 * u * u);
  const double bound = LandingTimeLowerBound(task, sim::OraclePadPrediction(pad));
  EXPECT_NEAR(bound, (2.0 * peak - u) / task.acceleration, 2e-4);
  EXPECT_LE(bound, (2.0 * peak - u) / task.acceleration);
}

TEST(LandingTime, PadThatDrivesAheadOrTowards) {
  for (const double speed : {1.5, -1.5}) {
    const sim::PadMotion pad = Line(10.0, speed);
    const LandingTimeTask task = TaskOn(pad);
    // Caught up with: contact at speed + 0.6. The pad comes head on. It catches the vehicle, which is at rest or moves
    // along, with at least speed - 0.6.
    const double u = std::min(task.speed, speed + task.horizontal_speed);
    const double v = task.speed, a = task.acceleration;
    const auto reach = [&](double T) {
      return (2.0 * v * v - u * u) / (2.0 * a) + v * (T - (2.0 * v - u) / a);
    };
    // reach(T) = 10 + speed T - radius - foot, linear in T.
    const double way = 10.0 - task.deck_half_size - task.foot_reach;
    const double exact = (way - reach(0.0)) / (v - speed);
    const double bound = LandingTimeLowerBound(task, sim::OraclePadPrediction(pad));
    EXPECT_LE(bound, exact) << speed;
    EXPECT_GT(bound, exact - 5e-4) << speed;
  }
}

TEST(LandingTime, StartInContactTakesNoTime) {
  const sim::PadMotion pad = Line(0.5, 0.0);
  const LandingTimeTask task = TaskOn(pad);
  EXPECT_LT(LandingTimeLowerBound(task, sim::OraclePadPrediction(pad)), 2e-4);
}

TEST(LandingTime, ExclusionEndsExactlyAtTheHorizon) {
  const sim::PadMotion pad = Line(20.0, 0.7);
  LandingTimeTask task = TaskOn(pad);
  const sim::OraclePadPrediction oracle(pad);
  const double bound = LandingTimeLowerBound(task, oracle);
  for (const double horizon : {0.3 * bound, bound - 1e-3}) {
    task.horizon = horizon;
    EXPECT_EQ(LandingTimeLowerBound(task, oracle), horizon);
    EXPECT_FALSE(LandingTimeUpperBound(task, oracle, horizon).has_value());
  }
  task.horizon = bound + 0.5;
  EXPECT_NEAR(LandingTimeLowerBound(task, oracle), bound, 1e-4);
}

TEST(LandingTime, PadThatIsTooFastIsNeverCaught) {
  const sim::PadMotion pad = Line(20.0, 3.7);
  const LandingTimeTask task = TaskOn(pad);
  const sim::OraclePadPrediction oracle(pad);
  EXPECT_EQ(LandingTimeLowerBound(task, oracle), task.horizon);
  EXPECT_FALSE(LandingTimeUpperBound(task, oracle, task.horizon).has_value());
}

TEST(LandingTime, LowerBoundIsBelowWhatIsFoundAndNear) {
  std::mt19937_64 random(5);
  std::vector<double> gaps;
  for (int i = 0; i < 200; ++i) {
    const RandomTask r(&random);
    const sim::OraclePadPrediction oracle(r.motion);
    const double lower = LandingTimeLowerBound(r.task, oracle);
    // The search starts far below the lower bound. So only the bound itself keeps the result above.
    const auto upper = LandingTimeUpperBound(r.task, oracle, 0.5 * lower);
    ASSERT_TRUE(upper.has_value()) << i << " " << lower;
    ASSERT_LE(lower, upper->time) << i;
    gaps.push_back(upper->time / lower - 1.0);
  }
  std::sort(gaps.begin(), gaps.end());
  RecordProperty("gap_median", std::to_string(gaps[100]));
  RecordProperty("gap_95", std::to_string(gaps[190]));
  EXPECT_LT(gaps[100], 0.01);
  EXPECT_LT(gaps[190], 0.05);
}

// The pads of straight_turn and circle, from starts as far away as there, with the lag of their drives.
TEST(LandingTime, GapIsSmallForTheShippedPads) {
  std::mt19937_64 random(9);
  for (const Kind kind : {Kind::kStraightTurn, Kind::kCircle}) {
    std::vector<double> gaps, lowers;
    for (int i = 0; i < 60; ++i) {
      sim::PadMotionConfig config;
      config.kind = kind;
      config.p_start = {7.0, 6.5, 0.5};
      config.speed = 0.8;
      config.turn_start = 5.0;
      config.turn_rate = kind == Kind::kCircle ? 0.15 : 0.25;
      config.phase = Uniform(&random, -2.0, 2.0);
      const sim::PadMotion motion(config);
      LandingTimeTask task = TaskOn(motion);
      task.p_WB = {Uniform(&random, -1, 1), Uniform(&random, -1, 1), Uniform(&random, 1.5, 3.5)};
      task.pad_position_error = 0.004;
      task.pad_velocity_error = 0.006;
      task.pad_yaw_error = 0.004;
      task.pad_yaw_rate_error = 0.007;
      const sim::OraclePadPrediction oracle(motion);
      lowers.push_back(LandingTimeLowerBound(task, oracle));
      const auto upper = LandingTimeUpperBound(task, oracle, 0.5 * lowers.back());
      ASSERT_TRUE(upper.has_value()) << i;
      EXPECT_LE(lowers.back(), upper->time) << i;
      gaps.push_back(upper->time / lowers.back() - 1.0);
    }
    std::sort(gaps.begin(), gaps.end());
    std::sort(lowers.begin(), lowers.end());
    const std::string name = kind == Kind::kCircle ? "circle" : "straight_turn";
    RecordProperty(name + "_gap_median", std::to_string(gaps[30]));
    RecordProperty(name + "_gap_largest", std::to_string(gaps.back()));
    RecordProperty(name + "_lower_median_s", std::to_string(lowers[30]));
    EXPECT_LT(gaps.back(), 0.02) << name;
  }
}

/// De Boor's algorithm is not needed: between knots a quadratic B-spline is a parabola.
Eigen::Vector3d PositionOf(const LandingFlight& flight, double t) {
  const int segments = static_cast<int>(flight.control_points.size()) - 2;
  const double x = std::clamp(t / flight.time, 0.0, 1.0) * segments;
  const int k = std::min(static_cast<int>(x), segments - 1);
  const double s = x - k;
  const std::vector<Eigen::Vector3d>& q = flight.control_points;
  return 0.5 *
         ((1.0 - s) * (1.0 - s) * q[k] + (1.0 + 2.0 * s * (1.0 - s)) * q[k + 1] + s * s * q[k + 2]);
}

/// The pads that the task allows in place of this one: displaced, turned and sped up by its errors.
std::vector<estimation::PadState> PadsWithin(const LandingTimeTask& task,
                                             const estimation::PadState& pad) {
  std::vector<estimation::PadState> pads{pad};
  for (int way = 0; way < 8; ++way) {
    const Eigen::Vector3d along =
        Eigen::AngleAxisd(0.785398163397448 * way, Eigen::Vector3d::UnitZ()) *
        Eigen::Vector3d::UnitX();
    for (const double sign : {-1.0, 1.0}) {
      estimation::PadState other = pad;
      other.p_WP += task.pad_position_error * along;
      other.v_WP += task.pad_velocity_error * along;
      other.yaw += sign * task.pad_yaw_error;
      other.yaw_rate += sign * task.pad_yaw_rate_error;
      pads.push_back(other);
    }
  }
  return pads;
}

// The found flight, sampled, with differences for velocity and acceleration and the real feet. It
// has the properties that the bound claims.
TEST(LandingTime, WhatIsFoundIsAFlightThatMakesContact) {
  std::mt19937_64 random(8);
  int over_a_corner = 0;
  for (int i = 0; i < 60; ++i) {
    RandomTask r(&random);
    r.task.pad_position_error = 0.02;
    r.task.pad_velocity_error = 0.03;
    r.task.pad_yaw_error = 0.02;
    r.task.pad_yaw_rate_error = 0.03;
    const sim::OraclePadPrediction oracle(r.motion);
    const double lower = LandingTimeLowerBound(r.task, oracle);
    const auto flight = LandingTimeUpperBound(r.task, oracle, lower);
    ASSERT_TRUE(flight.has_value()) << i;
    const double T = flight->time, dt = 1e-3;
    const estimation::PadState pad = r.motion.At(T);
    EXPECT_LT((PositionOf(*flight, 0.0) - r.task.p_WB).norm(), 1e-9);
    EXPECT_LT((PositionOf(*flight, 1e-4) - r.task.p_WB).norm(), 1e-6);  // from rest
    for (double t = dt; t < T - dt; t += 4.0 * dt) {
      const Eigen::Vector3d before = PositionOf(*flight, t - dt), now = PositionOf(*flight, t),
                            after = PositionOf(*flight, t + dt);
      EXPECT_LE((after - now).norm(), r.task.speed * dt * (1.0 + 1e-9)) << i;
      EXPECT_LE((after - 2.0 * now + before).norm(), r.task.acceleration * dt * dt * (1.0 + 1e-6))
          << i;
      EXPECT_GE(now.z() - r.task.foot_depth, pad.p_WP.z() - 1e-4) << i;
    }
    const Eigen::Vector3d end = PositionOf(*flight, T);
    const Eigen::Vector3d velocity = (end - PositionOf(*flight, T - 1e-6)) / 1e-6;
    EXPECT_NEAR(end.z() - r.task.foot_depth, pad.p_WP.z(), 1e-4) << i;
    for (const estimation::PadState& other : PadsWithin(r.task, pad)) {
      EXPECT_TRUE(InContact(r.task, other, end, velocity)) << "as the lower bound has it, " << i;
      const Eigen::Vector3d relative = velocity - DeckPointVelocity(other, end);
      EXPECT_LE(relative.head<2>().norm(), r.task.horizontal_speed) << i;
      EXPECT_GE(relative.z(), -r.task.vertical_speed - 1e-5) << i;
      EXPECT_LE(relative.z(), 1e-2) << i;
      // There is a heading at which a foot stands on the deck.
      int standing = 0;
      for (int heading = 0; heading < 3600; ++heading) {
        const double azimuth = heading * 0.00174532925199433;
        const Eigen::Vector2d foot =
            end.head<2>() +
            r.task.foot_radius * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
        const Eigen::Vector2d p_P = Eigen::Rotation2Dd(-other.yaw) * (foot - other.p_WP.head<2>());
        standing += p_P.cwiseAbs().maxCoeff() <= r.task.deck_half_size;
      }
      EXPECT_GE(standing, 1) << i;
    }
    const Eigen::Vector2d p_P = Eigen::Rotation2Dd(-pad.yaw) * (end - pad.p_WP).head<2>();
    over_a_corner += p_P.cwiseAbs().minCoeff() > r.task.deck_half_size - 0.05;
  }
  EXPECT_GT(over_a_corner, 3);  // where the end set is round
}

TEST(LandingTime, LargerLimitsAndALargerPadAreNeverLater) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 100; ++i) {
    const RandomTask r(&random);
    const sim::OraclePadPrediction oracle(r.motion);
    const double bound = LandingTimeLowerBound(r.task, oracle);
    const auto relaxed = [&](double LandingTimeTask::*figure) {
      LandingTimeTask task = r.task;
      task.*figure *= 1.3;
      return LandingTimeLowerBound(task, oracle);
    };
    const double slack = 2e-4;  // resolution of the search
    EXPECT_LE(relaxed(&LandingTimeTask::speed), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::acceleration), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::deck_half_size), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::horizontal_speed), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::foot_reach), bound + slack) << i;
  }
}

/// Time of first contact of a flight that heads for `aim` (from the pad's centre) where the pad will be at `meeting`.
/// It is as fast as it can still brake from, with jolts of this share of its acceleration. Infinite if there is no
/// contact by `end`. Every step keeps both limits.
double SampledFlight(const RandomTask& r, const Eigen::Vector3d& aim, double meeting, double jolt,
                     double end, std::mt19937_64* random) {
  const double dt = 1e-3;
  const double most = r.task.acceleration * (1.0 - 1e-9);
  const double top = r.task.speed * (1.0 - 1e-9);
  Eigen::Vector3d p = r.task.p_WB, v = Eigen::Vector3d::Zero();
  for (double t = 0.0; t < end; t += dt) {
    const estimation::PadState pad = r.motion.At(t);
    if (InContact(r.task, pad, p, v)) return t;
    const estimation::PadState there = r.motion.At(std::max(t, meeting));
    const Eigen::Vector3d way = there.p_WP + aim - p;
    const double far = way.norm();
    const double touch = std::max(0.0, there.v_WP.dot(way) / far + 0.4);
    const Eigen::Vector3d wanted =
        way / far * std::min(top, std::sqrt(touch * touch + 2.0 * 0.9 * most * far));
    Eigen::Vector3d dv = wanted - v + jolt * most * dt * OnSphere(random);
    if (dv.norm() > most * dt) dv *= most * dt / dv.norm();
    Eigen::Vector3d next = v + dv;
    if (next.norm() > top) next = v;  // coasts
    p += 0.5 * dt * (v + next);
    v = next;
  }
  return INFINITY;
}

TEST(LandingTime, NoSampledFlightArrivesBeforeIt) {
  std::mt19937_64 random(7);
  int arrived = 0, early = 0;
  for (int i = 0; i < 150; ++i) {
    const RandomTask r(&random);
    const double bound = LandingTimeLowerBound(r.task, sim::OraclePadPrediction(r.motion));
    for (int flight = 0; flight < 4; ++flight) {
      const double meeting = bound * Uniform(&random, 0.98, 1.1);
      // To the edge of the deck that the vehicle comes from, or anywhere on it.
      Eigen::Vector3d aim = r.task.p_WB - r.motion.At(meeting).p_WP;
      if (flight % 2 == 1) aim = OnSphere(&random);
      aim.z() = 0.0;
      aim *= r.task.deck_half_size / aim.norm();
      aim.z() = Uniform(&random, 0.0, r.task.foot_reach);
      const double jolt = flight < 2 ? 0.0 : Uniform(&random, 0.0, 0.5);
      const double t = SampledFlight(r, aim, meeting, jolt, 1.5 * bound + 1.0, &random);
      EXPECT_GE(t, bound - 1e-3) << i;
      if (std::isfinite(t)) ++arrived;
      if (t < 1.1 * bound) ++early;
    }
  }
  EXPECT_GT(arrived, 200);
  EXPECT_GT(early, 50);  // so many are near that a bound 10 % too late would be noticed
}

TEST(LandingTime, RefusesWhatIsNoLimit) {
  const sim::PadMotion pad = Line(5.0, 0.0);
  const sim::OraclePadPrediction oracle(pad);
  for (double LandingTimeTask::*figure :
       {&LandingTimeTask::speed, &LandingTimeTask::acceleration, &LandingTimeTask::horizon}) {
    for (const double value : {0.0, -1.0, std::nan("")}) {
      LandingTimeTask task = TaskOn(pad);
      task.*figure = value;
      EXPECT_THROW(LandingTimeLowerBound(task, oracle), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
