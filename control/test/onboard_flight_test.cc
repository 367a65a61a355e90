// SPDX-License-Identifier: BSD-3-Clause
// Landings in the toy world whose measurements come late, twice, in another order, or not at all, and by clocks that
// do not go on as they should.
#include <functional>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "control/test/toy_world.h"
#include "control/tracking/mixer.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/control/onboard/onboard.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::control {
namespace {

/// The effects of the transmission from a sensor to the vehicle.
struct Mess {
  double delay = 0.0;        ///< each measurement comes later by up to this [s] ...
  double own_delay = 0.0;    ///< ... and a given state by this [s]
  double doubled = 0.0;      ///< share that comes twice, the second time by a delay of its own
  double lost = 0.0;         ///< share that never comes
  double blind = 0.0;        ///< no given state comes for so long [s] ...
  double blind_every = 3.0;  ///< ... so often [s]
  bool estimated =
      false;  ///< the own state, from an IMU whose samples come in time and sensors that are late
  bool autopilot = false;  ///< holds the attitude, which it knows
  double leap = 0.0;       ///< the clock shows so much more ... [s]
  double leap_at = 4.0;    ///< ... from then on [s]
  double stall = 0.0;      ///< from then on nothing is taken and no step is made for so long [s]
  double bad_steps = 0.0;  ///< share of the steps before which one more is made, at a wrong time

  double Clock(double t) const { return t < leap_at ? t : t + leap; }
};
constexpr Mess kMess = {0.15, 0.01, 0.2, 0.1};

/// Holds measurements until they come.
class Post {
 public:
  Post(const Mess& mess, std::uint64_t seed) : mess_(mess), random_(seed) {}

  template <typename Measurement>
  void Send(double t, const Measurement& measurement, double longest) {
    if (Draw() < mess_.lost) return;
    const int copies = Draw() < mess_.doubled ? 2 : 1;
    Measurement stamped = measurement;
    stamped.t = mess_.Clock(measurement.t);
    for (int i = 0; i < copies; ++i) {
      held_.emplace(t + longest * Draw(), [stamped](Onboard* to) { to->Take(stamped); });
    }
  }

  void Deliver(double t, Onboard* to) {
    while (!held_.empty() && held_.begin()->first <= t) {
      held_.begin()->second(to);
      held_.erase(held_.begin());
    }
  }

  double Draw() { return static_cast<double>(random_() >> 11) * 0x1.0p-53; }
  double Draw(double lo, double hi) { return lo + (hi - lo) * Draw(); }

 private:
  Mess mess_;
  std::mt19937_64 random_;
  std::multimap<double, std::function<void(Onboard*)>> held_;
};

struct Landing {
  bool landed = false;
  double off = 0.0;           ///< from the middle of the pad, at the end [m]
  double nearest_wall = 1e9;  ///< of the vehicle's axis [m]
  double lowest = 1e9;        ///< of the feet of an upright vehicle, above the deck's height [m]
  double meets = 0.0;         ///< vertical speed at first contact [m/s]
  double meets_at = 0.0;      ///< ... and when that was [s]
  bool proven = true;         ///< all that was committed
  std::array<int, kTakenKinds> taken{};
  std::array<int, kStepTimes> steps{};
  std::string mode;
};

double DistanceTo(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& p) {
  return box.exteriorDistance(p);
}

/// An autopilot with its own attitude that follows thrust and attitude: 20 rad/s, well damped.
estimation::Commands Followed(const Setpoint& setpoint, const ToyWorld& world) {
  const estimation::VehicleState& is = world.vehicle;
  const Eigen::Quaterniond off(is.q_WB.toRotationMatrix().transpose() * setpoint.R_WB);
  const Eigen::Vector3d spin_up =
      400.0 * 2.0 * off.vec() * (off.w() < 0 ? -1.0 : 1.0) - 30.0 * is.w_WB_B;
  return Mixer(world.model)
      .Mix({setpoint.wrench.thrust, world.model.inertia.cwiseProduct(spin_up)})
      .thrusts;
}

/// ... and that brakes by its own means where the set-point does not count any more.
estimation::Commands Autopilot(const Setpoint& setpoint, const ToyWorld& world, double now) {
  if (setpoint.CountsAt(now)) return Followed(setpoint, world);
  const Eigen::Vector3d& v = world.vehicle.v_WB;
  const Eigen::Vector3d up(-0.1 * v.x(), -0.1 * v.y(), 1.0);
  Setpoint rest;
  rest.R_WB = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  rest.wrench.thrust = world.model.HoverThrust() * (1.0 - 0.3 * std::clamp(v.z(), -1.0, 1.0));
  return Followed(rest, world);
}

/// A hover for two seconds before the flight begins.
void Align(const ToyWorld& world, Onboard* onboard) {
  ToyWorld hover = world;
  for (int k = 1000; k >= 0; --k) {
    hover.vehicle.t = world.vehicle.t - ToyWorld::kStep * k;
    onboard->Take(hover.Imu());
    if (k % 50 == 0) onboard->Take(hover.Gps());
    if (k % 20 == 0) onboard->Take(hover.Height());
    if (k % 10 == 0) onboard->Take(hover.Compass());
  }
}

/// A pad that drives up to 1 m/s in any direction, a wall of 2.5 m on the way.
Landing Fly(std::uint64_t seed, const Mess& mess) {
  Post draws({}, seed);
  ToyWorld world;
  world.vehicle.p_WB = {0.0, 0.0, draws.Draw(1.5, 3.0)};
  const double heading = draws.Draw(-3.14, 3.14), speed = draws.Draw(0.0, 1.0);
  world.pad_start = {draws.Draw(6.0, 9.0), draws.Draw(-3.0, 3.0), ToyWorld::kDeck};
  world.pad_velocity = speed * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  const double wall = draws.Draw(-1.5, 1.5);
  world.wall = {Eigen::Vector3d(3.0, wall - 1.25, 0.0), Eigen::Vector3d(3.3, wall + 1.25, 3.5)};
  // No vehicle can land on a pad that drives through the wall.
  if (world.pad_velocity.x() < 0.0) world.pad_velocity.x() *= -1.0;

  Post post(mess, seed + 1000000);
  OnboardOptions options = LandingOptions(world.model, ToyWorld::kDeck);
  if (mess.estimated) options.own_state.emplace();
  Onboard onboard(options, LandingParts(options));
  if (mess.estimated) {
    Align(world, &onboard);
  } else {
    onboard.Take(world.vehicle);
  }
  onboard.Begin(world.vehicle.t, world.thrusts);
  Landing landing;
  bool met = false;
  Setpoint setpoint;
  for (int k = 0; world.vehicle.t < 60.0 + mess.stall; ++k) {
    const double t = world.vehicle.t, now = mess.Clock(t);
    if (t >= mess.leap_at && t < mess.leap_at + mess.stall) {
      world.Step(Autopilot(setpoint, world, now));
      continue;
    }
    const bool blind = t > 2.0 && std::fmod(t - 2.0, mess.blind_every) < mess.blind;
    if (mess.estimated) {
      estimation::ImuSample sample = world.Imu();
      sample.t = mess.Clock(sample.t);
      onboard.Take(sample);
      if (k % 50 == 0) post.Send(t, world.Gps(), mess.delay);
      if (k % 20 == 0) post.Send(t, world.Height(), mess.delay);
      if (k % 10 == 0) post.Send(t, world.Compass(), mess.delay);
    } else if (!blind) {
      post.Send(t, world.vehicle, mess.own_delay);
    }
    if (k % 5 == 0) post.Send(t, estimation::FootForce{t, world.foot_force}, mess.own_delay);
    if (k % 50 == 0) post.Send(t, world.PadGps(), mess.delay);
    if (k % 50 == 0) post.Send(t, world.Depth(), mess.delay);
    if (k % 25 == 0 && world.SeesTags()) post.Send(t, world.Sighting(), mess.delay);
    post.Deliver(t, &onboard);
    if (mess.bad_steps > 0.0 && draws.Draw() < mess.bad_steps) {
      const double wrong[] = {std::nan(""), -1.0, 0.5 * t, t + draws.Draw(1.0, 4e9), t + 5.0};
      onboard.Step(wrong[k % 5]);
    }
    setpoint = onboard.Step(now);
    const planning::ReplanResult* answer = onboard.plan().answer;
    landing.proven &= answer == nullptr || !answer->committed || answer->proven;
    landing.nearest_wall =
        std::min(landing.nearest_wall, DistanceTo(world.wall, world.vehicle.p_WB));
    landing.lowest =
        std::min(landing.lowest, world.vehicle.p_WB.z() - world.model.foot_depth - ToyWorld::kDeck);
    if (!met && world.foot_force > 0.0) {
      landing.meets = world.vehicle.v_WB.z();
      landing.meets_at = t;
      met = true;
    }
    if (!setpoint.armed) {
      landing.landed = true;
      break;
    }
    world.Step(mess.autopilot ? Autopilot(setpoint, world, now) : setpoint.thrusts);
  }
  landing.off = (world.vehicle.p_WB - world.Pad()).head<2>().norm();
  landing.taken = onboard.taken();
  landing.steps = onboard.steps();
  landing.mode = ToString(onboard.status().mission.mode);
  return landing;
}

void ExpectLanded(const Landing& landing, const std::string& what, double off = 0.3) {
  EXPECT_TRUE(landing.landed) << what << ": " << landing.mode;
  EXPECT_LT(landing.off, off) << what;
  EXPECT_GT(landing.nearest_wall, HullAtEveryTilt(ToyQuadrotor())) << what;
}

void ExpectGood(const Landing& landing, const std::string& what) {
  ExpectLanded(landing, what);
  EXPECT_GT(landing.meets, -0.5) << what;
}

TEST(OnboardFlights, LandWhereAllComesInTime) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ExpectGood(Fly(seed, {}), "seed " + std::to_string(seed));
  }
}

TEST(OnboardFlights, LandThoughMeasurementsComeLateTwiceAndInAnyOrder) {
  std::array<int, kTakenKinds> taken{};
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Landing landing = Fly(seed, kMess);
    ExpectGood(landing, "seed " + std::to_string(seed));
    for (int i = 0; i < kTakenKinds; ++i) taken[i] += landing.taken[i];
  }
  EXPECT_GT(taken[static_cast<int>(Taken::kDoubled)], 1000);
  EXPECT_EQ(taken[static_cast<int>(Taken::kInvalid)], 0);
}

TEST(OnboardFlights, LandByAnEstimatedState) {
  Mess mess = kMess;
  mess.estimated = true;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ExpectGood(Fly(seed, mess), "seed " + std::to_string(seed));
  }
}

// Meanwhile no moment is right, and the disturbance is not what it seems. A second of it needs an autopilot. Who sinks
// when it begins goes on sinking, so that the deck may be met harder.
TEST(OnboardFlights, LandThoughTheOwnStateIsAwayForAWhile) {
  for (const bool autopilot : {false, true}) {
    Mess mess;
    mess.blind = autopilot ? 1.0 : 0.3;
    mess.blind_every = autopilot ? 10.0 : 3.0;
    mess.autopilot = autopilot;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      ExpectLanded(Fly(seed, mess), std::to_string(mess.blind) + " s, seed " + std::to_string(seed),
                   autopilot ? 0.3 : 0.5);  // of 150 seeds 12 beyond 0.3, and 3 tumble
    }
  }
}

// A clock that is set, forth by years or back, is another one. So it is with an estimated state.
TEST(OnboardFlights, LandThoughTheClockIsSet) {
  for (const double leap : {1.7e9, 20.0, -0.3, -3.99}) {
    for (const bool estimated : {false, true}) {
      Mess mess;
      mess.leap = leap;
      mess.estimated = estimated;
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Landing landing = Fly(seed, mess);
        const std::string what = std::to_string(leap) + " s, seed " + std::to_string(seed);
        ExpectGood(landing, what + (estimated ? ", estimated" : ""));
        EXPECT_TRUE(landing.proven) << what;
        EXPECT_EQ(landing.steps[static_cast<int>(StepTime::kResumed)], 1) << what;
      }
    }
  }
}

// The time passes, whether the process stalls or the clock only says so. An autopilot flies meanwhile.
TEST(OnboardFlights, LandThoughTheProcessStalls) {
  for (const double seconds : {0.2, 1.0, 5.0}) {
    for (const bool truly : {true, false}) {
      Mess mess;
      mess.autopilot = true;
      (truly ? mess.stall : mess.leap) = seconds;
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        mess.estimated = seed > 5;
        mess.leap_at = mess.estimated ? 2.5 : 4.0;  // on the way
        const Landing landing = Fly(seed, mess);
        const std::string what = std::to_string(seconds) + " s, seed " + std::to_string(seed);
        ExpectLanded(landing, what + (truly ? "" : ", by the clock only"));
        // A climb from a deck that was missed may be unproven (docs/safety.md), as after a landing in the wrong time.
        EXPECT_TRUE(landing.proven || !truly) << what;
        EXPECT_EQ(landing.steps[static_cast<int>(StepTime::kResumed)], 1) << what;
      }
    }
  }
}

TEST(OnboardFlights, StepsOfWrongTimesChangeNoBit) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Mess mess;
    mess.bad_steps = 0.1;
    const Landing with = Fly(seed, mess), without = Fly(seed, {});
    EXPECT_EQ(with.off, without.off) << seed;
    EXPECT_EQ(with.nearest_wall, without.nearest_wall) << seed;
    EXPECT_GT(with.steps[static_cast<int>(StepTime::kLeap)], 50);
    EXPECT_EQ(with.steps[static_cast<int>(StepTime::kGood)],
              without.steps[static_cast<int>(StepTime::kGood)]);
  }
}

// Nobody knows for how long a process stalled whose clock is another one. The autopilot brakes while the pad drives on.
TEST(OnboardFlights, LandThoughTheProcessStallsForLongAboveTheDeck) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const double contact = Fly(seed, {}).meets_at;
    for (const double seconds : {11.0, 30.0}) {
      for (const double before : {2.0, 1.0, 0.5, 0.2}) {
        Mess mess;
        mess.autopilot = true;
        mess.stall = seconds;
        mess.leap_at = contact - before;
        const Landing landing = Fly(seed, mess);
        const std::string what = std::to_string(seconds) + " s, " + std::to_string(before) +
                                 " s before contact, seed " + std::to_string(seed);
        ExpectLanded(landing, what);
        EXPECT_GT(landing.lowest, -0.1) << what;  // not where the deck was
      }
    }
  }
}

// A reference that leaps leads to the deck at once. Where the clock is wrong, so is the pad's prediction.
TEST(OnboardFlights, LandSoftlyThoughTheClockLeapsAboveTheDeck) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const double contact = Fly(seed, {}).meets_at;
    for (const double leap : {0.15, 0.5, 2.0, -0.3}) {
      for (double before = 1.5; before > -0.5; before -= 0.5) {
        Mess mess;
        mess.leap = leap;
        mess.leap_at = contact - before;
        const Landing landing = Fly(seed, mess);
        const std::string what = std::to_string(leap) + " s, " + std::to_string(before) +
                                 " s before contact, seed " + std::to_string(seed);
        EXPECT_TRUE(landing.landed) << what << ": " << landing.mode;
        EXPECT_LT(landing.off, 0.5) << what;
        EXPECT_GT(landing.meets, -0.5) << what;
      }
    }
  }
}

/// A clock that stands, leaps, starts anew, or shows anything, from 1970 to 2100.
class WildClock {
 public:
  explicit WildClock(std::uint64_t seed) : draws_({}, seed) {}

  double At(double t) {
    if (draws_.Draw() < 0.001)
      offset_ = draws_.Draw() < 0.5 ? draws_.Draw(-20.0, 20.0) : draws_.Draw(0.0, 4.1e9);
    if (draws_.Draw() < 0.001) disorder_ = draws_.Draw() < 0.5 ? 0.0 : draws_.Draw();
    if (draws_.Draw() > disorder_) return last_ = t + offset_;
    const double wrong[] = {last_, std::nan(""), t, draws_.Draw(-1.0, 4.1e9),
                            last_ + draws_.Draw(-0.3, 0.3)};
    return wrong[static_cast<int>(5.0 * draws_.Draw())];
  }
  double Draw() { return draws_.Draw(); }

 private:
  Post draws_;
  double offset_ = 0.0, disorder_ = 0.0, last_ = 0.0;
};

// An autopilot flies, whatever the set-points are worth. Those may be copies for 0.1 s, then they are level.
TEST(OnboardFlights, NoClockFreezesThemOrLeadsThemAstray) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    ToyWorld world;
    world.vehicle.p_WB = {0.0, 0.0, 2.0};
    const OnboardOptions options = LandingOptions(world.model, ToyWorld::kDeck);
    Onboard onboard(options, LandingParts(options));
    onboard.Take(world.vehicle);
    onboard.Begin(world.vehicle.t, world.thrusts);
    WildClock clock(seed);
    Setpoint last;
    long allocated = 0;
    int same = 0, longest = 0, committed = 0;
    double nearest_wall = 1e9;
    for (int k = 0; k < 20000 && onboard.status().mission.motors_armed; ++k) {
      const auto stamped = [&](auto measured) {
        measured.t = clock.At(measured.t);
        return measured;
      };
      const auto state = stamped(world.vehicle);
      const auto force = stamped(estimation::FootForce{world.vehicle.t, world.foot_force});
      const auto fix = stamped(world.PadGps());
      const auto sighting = stamped(world.Sighting());
      const auto image = stamped(k % 50 == 0 ? world.Depth() : estimation::DepthImage{});
      const double now = clock.At(world.vehicle.t);
      const long before = solvers::AllocationCount();
      onboard.Take(state);
      onboard.Take(force);
      if (k % 50 == 0) onboard.Take(fix);
      if (k % 50 == 0) onboard.Take(image);
      if (k % 25 == 0 && world.SeesTags()) onboard.Take(sighting);
      const Setpoint& setpoint = onboard.Step(now);
      const bool plans = onboard.plan().answer != nullptr;  // a longer one makes its room
      if (k > 1000 && !plans) allocated += solvers::AllocationCount() - before;
      ASSERT_TRUE(setpoint.thrusts.allFinite() && setpoint.R_WB.allFinite() &&
                  std::isfinite(setpoint.wrench.thrust) && setpoint.wrench.moment_B.allFinite() &&
                  setpoint.reference.p_WB.allFinite() && setpoint.reference.v_WB.allFinite() &&
                  std::isfinite(setpoint.reference.yaw) && std::isfinite(setpoint.valid_until));
      const planning::ReplanResult* answer = onboard.plan().answer;
      if (answer != nullptr && answer->committed) {
        ++committed;
        const MissionMode mode = onboard.status().mission.mode;
        const bool at_deck = mode == MissionMode::kLanding || mode == MissionMode::kGoAround;
        EXPECT_TRUE(answer->proven || at_deck) << seed << ", " << k;  // docs/safety.md says when
      }
      if (setpoint.level) {
        EXPECT_TRUE(setpoint.wrench.moment_B.isZero() && setpoint.R_WB.col(2).z() == 1.0);
      }
      nearest_wall = std::min(nearest_wall, DistanceTo(world.wall, world.vehicle.p_WB));
      same = !setpoint.level && setpoint.thrusts == last.thrusts && setpoint.t == last.t ? same + 1
                                                                                         : 0;
      longest = std::max(longest, same);
      last = setpoint;
      world.Step(Autopilot(setpoint, world, now));
    }
    EXPECT_LE(longest, 49) << seed;
    EXPECT_GT(nearest_wall, HullAtEveryTilt(world.model)) << seed;
    if (!onboard.status().mission.motors_armed) {
      EXPECT_GT(world.foot_force, 0.0) << seed;
    }
    EXPECT_GT(committed, 10) << seed;
    EXPECT_GT(onboard.steps()[static_cast<int>(StepTime::kResumed)], 10) << seed;
    EXPECT_TRUE(allocated == 0 || solvers::AllocationCount() < 0) << seed << ": " << allocated;
  }
}

// A measurement that comes twice acts as if it came once.
TEST(OnboardFlights, DoublesChangeNoBit) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Landing once = Fly(seed, {}), twice = Fly(seed, {0.0, 0.0, 1.0});
    EXPECT_EQ(once.off, twice.off) << seed;
    EXPECT_EQ(once.nearest_wall, twice.nearest_wall) << seed;
    EXPECT_GT(twice.taken[static_cast<int>(Taken::kDoubled)], 1000);
  }
}

// A whole flight: measurements and set-points, plans and all. The first seconds allocate room that is kept.
TEST(OnboardFlights, NothingIsAllocatedOnceItFlies) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  ToyWorld world;
  world.vehicle.p_WB = {0.0, 0.0, 2.0};
  world.pad_start.x() = 12.0;
  const OnboardOptions options = LandingOptions(world.model, ToyWorld::kDeck);
  Onboard onboard(options, LandingParts(options));
  onboard.Take(world.vehicle);
  onboard.Begin(world.vehicle.t, world.thrusts);
  long taking = 0, stepping = 0;
  int steps = 0;
  for (bool armed = true; armed && world.vehicle.t < 30.0; ++steps) {
    const double t = world.vehicle.t;
    const estimation::DepthImage image = steps % 50 == 0 ? world.Depth() : estimation::DepthImage{};
    const long before = solvers::AllocationCount();
    onboard.Take(world.vehicle);
    onboard.Take(estimation::FootForce{t, world.foot_force});
    if (steps % 50 == 0) onboard.Take(world.PadGps());
    if (steps % 50 == 0) onboard.Take(image);
    if (steps % 25 == 0 && world.SeesTags()) onboard.Take(world.Sighting());
    const long taken = solvers::AllocationCount();
    const Setpoint& setpoint = onboard.Step(t);
    const long stepped = solvers::AllocationCount();
    if (t > 2.0) {
      taking += taken - before;
      stepping += stepped - taken;
    }
    armed = setpoint.armed;
    world.Step(setpoint.thrusts);
  }
  EXPECT_FALSE(onboard.Step(100.0).armed);
  EXPECT_TRUE(onboard.Step(100.0).CountsAt(100.0));  // they stand still for good
  EXPECT_EQ(taking, 0);
  EXPECT_EQ(stepping, 0);
}

TEST(OnboardFlights, SameSeedSameBits) {
  const Landing a = Fly(5, kMess), b = Fly(5, kMess);
  EXPECT_EQ(a.off, b.off);
  EXPECT_EQ(a.taken, b.taken);
}

}  // namespace
}  // namespace touchdown::control
