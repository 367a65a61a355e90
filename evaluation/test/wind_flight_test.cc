// SPDX-License-Identifier: BSD-3-Clause
// Whole flights in wind, and with vehicles that differ from the model of their onboard software.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sliding_mean.h"
#include "evaluation/flight/air.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/air/pad_wake.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Overrides = std::vector<std::string>;

// Steady wind to the north over a pad that stands ahead of the start or drives a circle there. It is ahead because the
// camera does not see what is straight below, and the vehicle does not sink into the unseen.
const Overrides kNorthWind = {"wind.direction_random=false", "wind.direction_deg=90"};
const Overrides kAbovePad = {"task=follow", "follow.time=0", "pad.motion=static",
                             "pad.start=[3.0, 0.2]", "pad.prediction=oracle"};

Overrides Join(Overrides a, const Overrides& b, const Overrides& c = {}) {
  a.insert(a.end(), b.begin(), b.end());
  a.insert(a.end(), c.begin(), c.end());
  return a;
}

Scenario Open(const Overrides& overrides) {
  return LoadScenario(FindScenario("open"), overrides, StandardRegistries());
}

TrialResult Fly(const Overrides& overrides, TrialRecord* record = nullptr, std::uint64_t seed = 1) {
  return RunTrial(Open(overrides), seed, StandardRegistries(), record);
}

std::string Deterministic(const Scenario& scenario, const TrialResult& result) {
  nlohmann::ordered_json json = LandJson(scenario, result);
  json.erase("wall_clock");
  return json.dump();
}

std::string Refusal(const Overrides& overrides) {
  try {
    Open(overrides);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

// In open sky, with a wide hull (its margins) and a nose that the wind lifts. The vehicle used to stand for ever,
// because cells in front and below were never in the image.
TEST(WindFlight, WhoDoesNotSeeTheWayForItsLeanLooksFromElsewhere) {
  const TrialResult result =
      Fly({"pad.motion=circle", "pad.heading_deg=-90", "pad.turn_rate=-0.07", "pad.speed=0.23",
           "pad.start=[-3.5, -12.8]", "start.position=[1.7, -9.2, 2.48]", "start.yaw_deg=-165",
           "depth.rate=14.6", "depth.noise=0.016", "own_state=estimated", "wind.mean=8.6",
           "wind.max=10", "plant.mass=0.87", "plant.drag=1.14", "plant.thrust=0.9",
           "limits.acceleration=0.7", "descent=vertical", "timeout=60"},
          nullptr, 2);
  EXPECT_EQ(result.outcome, Outcome::kLanded) << result.detail;
  EXPECT_EQ(result.safety->uncertified_steps, 0);
}

TEST(WindFlight, SteadyWindLeavesNoSteadyError) {
  const Overrides wind = {"wind.mean=11", "timeout=18"};
  const TrialResult with = Fly(Join(kAbovePad, kNorthWind, wind));
  ASSERT_TRUE(with.following);
  EXPECT_LE(with.following->mean_error_m, 0.02);
  // Against 4 N the position loop alone has an error of 4 N / (m kp), and so has the paper's law.
  const TrialResult without =
      Fly(Join(kAbovePad, kNorthWind, Join(wind, {"control.disturbance=false"})));
  ASSERT_TRUE(without.following);
  EXPECT_GT(without.following->mean_error_m, 0.3);
}

// Set free level instead, knowing neither wind nor mass, the vehicle is blown up to 1.5 m off.
TEST(WindFlight, BeginsWithAHoverWhateverTheWindAndThePlant) {
  for (const char* own_state : {"true", "estimated"}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const TrialResult result =
          Fly({std::string("own_state=") + own_state, "wind.mean=11", "wind.max=15",
               "plant.mass=0.8", "plant.thrust=1.2", "plant.drag=1.2", "timeout=1"},
              nullptr, seed);
      ASSERT_TRUE(result.safety);
      EXPECT_LE(result.safety->tracking_max_m, 0.3) << own_state << ", seed " << seed;
      EXPECT_EQ(result.safety->uncertified_steps, 0) << own_state << ", seed " << seed;
    }
  }
}

TEST(WindFlight, InSteadyWindTheHoverGoesOn) {
  const TrialResult result =
      Fly({"wind.mean=11", "plant.mass=0.8", "plant.thrust=1.2", "plant.drag=1.2", "timeout=1"});
  ASSERT_TRUE(result.safety);
  EXPECT_LE(result.safety->tracking_max_m, 0.03);
}

TEST(WindFlight, TheLawLeansFartherThanStopsCountOn) {
  const Scenario scenario = Open({"limits.tilt_deg=35"});
  constexpr double kDeg = 3.14159265358979323846 / 180.0;
  EXPECT_NEAR(EnvelopeOf(scenario).TrackingTilt(), 55.0 * kDeg, 1e-12);
  const planning::ReplannerOptions options = PlannerOptions(
      scenario, sim::LoadVehicleModel(sim::DefaultVehicleMjcf()), StandardRegistries().terms);
  EXPECT_NEAR(options.problem.vehicle.stop_tilt_max, 45.0 * kDeg, 1e-12);
}

// The reason for the larger lean: the vehicle is as light, and the gusts are as strong, as the
// limits allow.
TEST(WindFlight, GustsDoNotBlowALightVehicleOffItsReference) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TrialResult result =
        RunTrial(LoadScenario(FindScenario("straight_turn"),
                              {"wind.mean=11", "wind.max=15", "plant.mass=0.8", "plant.thrust=0.9",
                               "plant.drag=1.2", "timeout=10"},
                              StandardRegistries()),
                 seed, StandardRegistries());
    ASSERT_TRUE(result.safety);
    EXPECT_LE(result.safety->tracking_max_m, 0.3) << seed;
  }
}

TEST(WindFlight, OnACircleTooWithTheEstimatedMomentAndForce) {
  const TrialResult result =
      Fly(Join({"task=follow", "follow.time=0", "pad.motion=circle", "pad.speed=1",
                "pad.turn_rate=0.5", "pad.start=[3.0, 0.2]", "pad.prediction=oracle"},
               kNorthWind, {"wind.mean=11", "timeout=22"}));
  ASSERT_TRUE(result.following);
  EXPECT_LE(result.following->mean_error_m, 0.02);
}

TEST(WindFlight, RecordHoldsTheAirAndTheEstimateInTheWorldsAxes) {
  TrialRecord record;
  Fly(Join(kAbovePad, kNorthWind, {"wind.mean=7", "timeout=6"}), &record);
  const RecordSample& last = record.samples.back();
  EXPECT_LT((last.air - Eigen::Vector3d(0.0, 7.0, 0.0)).norm(), 1e-12);
  // Pushed to the north by rotor and body drag; the vehicle leans against it, to the south.
  const double drag = 0.19 * 7.0 + 0.5 * 1.225 * 0.03 * 49.0;
  EXPECT_NEAR(last.disturbance.force_W.y(), drag, 0.1 * drag);
  EXPECT_NEAR(last.disturbance.force_W.x(), 0.0, 0.1);
  EXPECT_LT((last.vehicle.q_WB * Eigen::Vector3d::UnitZ()).y(), -0.1);
  // Plans were told of it, over the mass.
  const Eigen::Vector3d& pull = record.plans.back().request.input.pull_W;
  EXPECT_GT(pull.y(), 0.5 * drag / 1.18);
  EXPECT_LE(pull.y(), 1.1 * drag / 1.18);
}

TEST(WindFlight, StillAirIsTheSameWhateverTheOtherKeysSay) {
  const Overrides brief = {"timeout=3"};
  const Overrides keys = {"wind.direction_random=false", "wind.direction_deg=40",
                          "wind.gust.start=1", "wind.gust.period=4"};
  EXPECT_EQ(Deterministic(Open(brief), Fly(brief)),
            Deterministic(Open(brief), Fly(Join(brief, keys))));
}

TEST(WindFlight, WindShiftsNoOtherDraw) {
  Scenario calm = Open({"start.position_spread=[1, 1, 0]", "pad.phase_spread=2"});
  Scenario windy = calm;
  windy.wind.mean = 7.0;
  windy.wind.max = 11.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    EXPECT_EQ(DrawTrial(calm, seed).p_WB, DrawTrial(windy, seed).p_WB);
    EXPECT_EQ(DrawTrial(calm, seed).phase, DrawTrial(windy, seed).phase);
  }
  // The direction is drawn from the whole circle, or as it is set.
  EXPECT_NE(DrawTrial(windy, 1).wind_direction, DrawTrial(windy, 2).wind_direction);
  windy.wind.direction_random = false;
  windy.wind.direction_deg = -90.0;
  EXPECT_NEAR(DrawTrial(windy, 1).wind_direction, -0.5 * std::acos(-1.0), 1e-12);
}

TEST(WindFlight, TurbulentWindRepeatsBitByBit) {
  const Overrides wind = {"wind.mean=7", "wind.max=11", "timeout=4"};
  EXPECT_EQ(Deterministic(Open(wind), Fly(wind, nullptr, 5)),
            Deterministic(Open(wind), Fly(wind, nullptr, 5)));
  EXPECT_NE(Deterministic(Open(wind), Fly(wind, nullptr, 5)),
            Deterministic(Open(wind), Fly(wind, nullptr, 6)));
}

TEST(WindFlight, LandsInAGaleLeaningAgainstIt) {
  const TrialResult result = Fly({"wind.mean=11", "wind.max=15"});
  ASSERT_EQ(result.outcome, Outcome::kLanded) << result.detail;
  EXPECT_LE(result.touchdown->error_m, 0.3);
  EXPECT_GT(result.touchdown->tilt, 10.0 / 57.3);
  EXPECT_LT(result.touchdown->tilt_over_equilibrium, 10.0 / 57.3);
}

TEST(WindFlight, LandsThoughTheVehicleIsNotWhatItsPilotThinks) {
  for (const char* alteration : {"plant.mass=1.2", "plant.thrust=0.9", "plant.rotor_lag=1.5"}) {
    const TrialResult result = Fly({alteration});
    EXPECT_EQ(result.outcome, Outcome::kLanded) << alteration << ": " << result.detail;
  }
}

TEST(WindFlight, AnEstimatedOwnStateDoesNotShakeTheVehicle) {
  // Root mean square of the angular rate while it keeps above a pad that stands.
  const auto shake = [](const char* disturbance) {
    TrialRecord record;
    Fly(Join(kAbovePad, {"own_state=estimated", "timeout=12"}, {disturbance}), &record);
    double sum = 0.0;
    int count = 0;
    for (const RecordSample& sample : record.samples) {
      if (sample.t < 5.0) continue;
      sum += sample.vehicle.w_WB_B.squaredNorm();
      ++count;
    }
    return std::sqrt(sum / count);
  };
  const double with = shake("control.disturbance=true");
  const double without = shake("control.disturbance=false");
  RecordProperty("with_rad_s", std::to_string(with));
  RecordProperty("without_rad_s", std::to_string(without));
  EXPECT_LT(with, 1.3 * without + 0.005);
}

TEST(WindFlight, GroundEffectAndWakeChangeTheFlightAndItLandsAllTheSame) {
  const TrialResult plain = Fly({"wind.mean=4"});
  const TrialResult both = Fly({"wind.mean=4", "air.ground_effect=true", "air.pad_wake=true"});
  EXPECT_EQ(both.outcome, Outcome::kLanded) << both.detail;
  EXPECT_NE(plain.effort_n2s, both.effort_n2s);
}

// The recorded air is the input of the physics: wind and wake, each separately.
TEST(WindFlight, TheWakeAloneIsInTheAirBehindThePad) {
  const Overrides overrides = Join(kNorthWind, {"wind.mean=6", "air.pad_wake=true"});
  const Scenario scenario = Open(overrides);
  TrialRecord record;
  const TrialResult with = Fly(overrides, &record);
  const TrialResult without = Fly(Join(kNorthWind, {"wind.mean=6"}));
  EXPECT_NE(with.effort_n2s, without.effort_n2s);
  const Eigen::Vector3d wind(0.0, 6.0, 0.0);
  double strongest = 0.0;
  for (const RecordSample& sample : record.samples) {
    const Eigen::Vector3d wake =
        sim::PadWake(PadGeometryOf(scenario), sample.pad, wind, sample.vehicle.p_WB);
    EXPECT_LT((sample.air - wind - wake).norm(), 1e-9) << sample.t;
    strongest = std::max(strongest, (sample.air - wind).norm());
  }
  RecordProperty("strongest_mps", std::to_string(strongest));
  EXPECT_GT(strongest, 0.03);
}

TEST(WindFlight, AGustComesWhenAndAsStrongAsTheScenarioSays) {
  TrialRecord record;
  Fly(Join(kAbovePad, kNorthWind,
           {"wind.mean=2", "wind.gust.speed=5", "wind.gust.start=3", "wind.gust.duration=1.6",
            "wind.gust.period=4", "timeout=9"}),
      &record);
  const auto along = [&record](double t) -> double {
    for (const RecordSample& sample : record.samples) {
      if (sample.t >= t - 1e-6) return sample.air.y();
    }
    return NAN;
  };
  EXPECT_NEAR(along(2.0), 2.0, 1e-9);
  EXPECT_NEAR(along(3.4), 2.0 + 2.5, 1e-2);  // half way up
  EXPECT_NEAR(along(3.8), 2.0 + 5.0, 1e-2);  // its peak
  EXPECT_NEAR(along(5.0), 2.0, 1e-9);
  EXPECT_NEAR(along(7.8), 2.0 + 5.0, 1e-2);  // the next one's
  // The gust pushes the vehicle to the north, farther off than ever before.
  double before = 0.0, after = 0.0;
  for (const RecordSample& sample : record.samples) {
    const double off = sample.vehicle.p_WB.y() - sample.reference.p_WB.y();
    if (sample.t > 2.0 && sample.t < 3.0) before = std::max(before, off);
    if (sample.t > 3.0 && sample.t < 4.6) after = std::max(after, off);
  }
  EXPECT_GT(after, before + 0.01);
}

TEST(WindFlight, RefusesWhatCannotBe) {
  using testing::HasSubstr;
  EXPECT_THAT(Refusal({"wind.mean=7", "wind.max=4"}),
              HasSubstr("wind.max must be 0 or in [7, 40]"));
  EXPECT_THAT(Refusal({"wind.gust.period=1"}),
              HasSubstr("wind.gust.period must be 0 or in [2, 600]"));
  EXPECT_THAT(Refusal({"plant.mass=1.9", "plant.thrust=0.6"}), HasSubstr("more thrust"));
  EXPECT_THAT(Refusal({"plant.thrust=0.3"}),
              HasSubstr("plant.thrust must be a number in [0.5, 2]"));
}

}  // namespace
}  // namespace touchdown::evaluation
