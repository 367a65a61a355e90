// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/landing_time.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "touchdown/evaluation/landing_judge.h"

namespace touchdown::evaluation {
namespace {

using Kind = sim::PadMotionConfig::Kind;

double Uniform(std::mt19937_64* random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(*random);
}

Eigen::Vector3d OnSphere(std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(*random), normal(*random), normal(*random)).normalized();
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

/// Some foot may touch the deck and contact would be soft enough.
bool InContact(const LandingTimeTask& task, const estimation::PadState& pad,
               const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
  const Eigen::Vector3d offset = p - pad.p_WP;
  const double beyond = std::max(0.0, offset.head<2>().norm() - task.deck_radius);
  const Eigen::Vector3d relative = v - DeckPointVelocity(pad, p);
  return std::hypot(beyond, offset.z()) <= task.foot_reach &&
         relative.head<2>().norm() <= task.horizontal_speed &&
         std::abs(relative.z()) <= task.vertical_speed;
}

TEST(LandingTime, PadAtRestStraightAheadIsTheTextbookCase) {
  // From rest along x to the near edge, where the vehicle may still move at 0.6 m/s.
  const sim::PadMotion pad = Line(20.0, 0.0);
  const LandingTimeTask task = TaskOn(pad);
  const double way = 20.0 - task.deck_radius - task.foot_reach;
  const double v = task.speed, a = task.acceleration, u = task.horizontal_speed;
  const double ramps = (v * v + v * v - u * u) / (2.0 * a);
  const double exact = v / a + (v - u) / a + (way - ramps) / v;
  const sim::OraclePadPrediction oracle(pad);
  const double bound = LandingTimeLowerBound(task, oracle);
  EXPECT_LE(bound, exact);
  EXPECT_GT(bound, exact - 2e-4);
  const auto found = LandingTimeUpperBound(task, oracle, bound);
  ASSERT_TRUE(found.has_value());
  EXPECT_GE(*found, exact);
  EXPECT_LT(*found, 1.005 * exact);
}

TEST(LandingTime, ShortWayWithoutCoasting) {
  const sim::PadMotion pad = Line(3.0, 0.0);
  LandingTimeTask task = TaskOn(pad);
  task.acceleration = 1.0;
  const double way = 3.0 - task.deck_radius - task.foot_reach;
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
    // Caught up with: contact at speed + 0.6. Met head on: the vehicle lets itself be caught, at rest
    // or driven along, with at least speed - 0.6.
    const double u = std::min(task.speed, speed + task.horizontal_speed);
    const double v = task.speed, a = task.acceleration;
    const auto reach = [&](double T) {
      return (2.0 * v * v - u * u) / (2.0 * a) + v * (T - (2.0 * v - u) / a);
    };
    // reach(T) = 10 + speed T - radius - foot, linear in T.
    const double way = 10.0 - task.deck_radius - task.foot_reach;
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
    const auto upper = LandingTimeUpperBound(r.task, oracle, lower);
    ASSERT_TRUE(upper.has_value()) << i << " " << lower;
    ASSERT_LE(lower, *upper) << i;
    gaps.push_back(*upper / lower - 1.0);
  }
  std::sort(gaps.begin(), gaps.end());
  EXPECT_LT(gaps[100], 0.01);
  EXPECT_LT(gaps[190], 0.05);
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
    EXPECT_LE(relaxed(&LandingTimeTask::deck_radius), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::horizontal_speed), bound + slack) << i;
    EXPECT_LE(relaxed(&LandingTimeTask::foot_reach), bound + slack) << i;
  }
}

/// Time of first contact of a flight that heads for `aim` (from the pad's centre) where the pad will be
/// at `meeting`, as fast as it can still brake from, with jolts of this share of its acceleration.
/// Infinite if there is none by `end`. Every step keeps both limits.
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
      aim *= r.task.deck_radius / aim.norm();
      aim.z() = Uniform(&random, 0.0, r.task.foot_reach);
      const double jolt = flight < 2 ? 0.0 : Uniform(&random, 0.0, 0.5);
      const double t = SampledFlight(r, aim, meeting, jolt, 1.5 * bound + 1.0, &random);
      EXPECT_GE(t, bound - 1e-3) << i;
      if (std::isfinite(t)) ++arrived;
      if (t < 1.1 * bound) ++early;
    }
  }
  EXPECT_GT(arrived, 200);
  EXPECT_GT(early, 50);  // so many are near: a bound that is too late by 10 % would be caught
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
