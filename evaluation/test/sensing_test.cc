// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "control/onboard/pad_search.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/flight/depth_sensor.h"
#include "evaluation/flight/pad_sensor.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/scenario_world.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Overrides = std::vector<std::string>;

Scenario Open(const Overrides& overrides) {
  return LoadScenario(FindScenario("open"), overrides, StandardRegistries());
}

std::string Deterministic(const Scenario& scenario, const TrialResult& result) {
  nlohmann::ordered_json json = LandJson(scenario, result);
  json.erase("wall_clock");
  return json.dump();
}

/// A sighting, with the vehicle's true state at its time stamp.
struct PadDetection {
  estimation::PadSighting sighting;
  estimation::VehicleState vehicle;
};

/// The sensor's view of a standing pad, from `height` above it and `aside` of it.
struct Watch {
  std::vector<PadDetection> detections;
  std::vector<double> arrivals;
  int searched = 0;  ///< images
  SensingTimes times;
};

/// @param speed at which the vehicle passes over the pad [m/s].
Watch WatchPad(const Overrides& overrides, int images, double height, double aside = 0.0,
               double speed = 0.0, bool thrifty = true) {
  const Scenario scenario = Open(overrides);
  const sim::WorldConfig world = WorldOf(scenario, DrawTrial(scenario, 1), StandardRegistries());
  const auto sensor = MakePadSensor(scenario, world, 7);
  control::PadSearch look(thrifty);
  estimation::PadState pad;
  pad.p_WP = {3.0, 2.0, scenario.pad.deck_height};
  estimation::PadFilterOptions options;
  options.pad_height = scenario.pad.deck_height;
  estimation::PadFilter filter(options);
  Watch watch;
  const auto vehicle_at = [&](double t) {
    estimation::VehicleState vehicle;
    vehicle.t = t;
    vehicle.v_WB.x() = speed;
    vehicle.p_WB = pad.p_WP + Eigen::Vector3d(aside + speed * t, 0.0, height);
    return vehicle;
  };
  for (int k = 0; k < images; ++k) {
    const estimation::VehicleState vehicle = vehicle_at(k / scenario.tag_rate);
    filter.AddGps({vehicle.t, pad.p_WP.head<2>(), 0.05});
    sensor->Look(vehicle, vehicle, pad, &watch.times);
    while (const auto seen = sensor->Poll(vehicle.t)) {
      std::optional<estimation::PadSighting> sighting;
      if (seen->image) {
        sighting = look.Find(*seen->image, vehicle_at(seen->image->t), filter);
        watch.searched += look.searched() ? 1 : 0;
      } else {
        sighting = seen->sighting;
      }
      if (!sighting) continue;
      watch.detections.push_back({*sighting, vehicle_at(sighting->t)});
      watch.arrivals.push_back(vehicle.t);
    }
  }
  return watch;
}

double ErrorOf(const PadDetection& detection, double deck_height) {
  const Eigen::Vector3d p_WP =
      detection.vehicle.p_WB + detection.vehicle.q_WB * detection.sighting.p_BP_B;
  return (p_WP - Eigen::Vector3d(3.0, 2.0, deck_height)).norm();
}

TEST(PadSensor, BothKindsSeeThePadWhereItIs) {
  for (const char* kind : {"sensing=fast", "sensing=rendered"}) {
    const Watch watch = WatchPad({kind}, 10, 2.0);
    ASSERT_EQ(watch.detections.size(), 10U) << kind;
    for (const PadDetection& detection : watch.detections)
      EXPECT_LT(ErrorOf(detection, 0.5), 0.01) << kind;
  }
}

TEST(PadSensor, DropsItsShareOfTheImages) {
  const std::size_t fast = WatchPad({"camera.drop=0.3"}, 1000, 2.0).detections.size();
  EXPECT_NEAR(static_cast<double>(fast), 700.0, 60.0);
  // The same stream drops the same images of both kinds.
  const Watch few = WatchPad({"camera.drop=0.3"}, 40, 2.0);
  const Watch rendered = WatchPad({"camera.drop=0.3", "sensing=rendered"}, 40, 2.0);
  EXPECT_LT(rendered.detections.size(), 40U);
  ASSERT_EQ(few.detections.size(), rendered.detections.size());
  for (std::size_t i = 0; i < few.detections.size(); ++i) {
    EXPECT_EQ(few.detections[i].sighting.t, rendered.detections[i].sighting.t);
  }
}

TEST(PadSensor, LatencyDelaysButKeepsTheStamp) {
  const Watch watch = WatchPad({"camera.latency_ms=120"}, 40, 2.0);
  ASSERT_GE(watch.detections.size(), 30U);
  for (std::size_t i = 0; i < watch.detections.size(); ++i) {
    const double age = watch.arrivals[i] - watch.detections[i].sighting.t;
    EXPECT_NEAR(age, 0.15, 1e-9);  // the first look after 120 ms
  }
}

TEST(PadSensor, AHalfCoveredPadShowsTwoTagsAndIsStillWhereItIs) {
  for (const char* kind : {"sensing=fast", "sensing=rendered"}) {
    for (const double height : {1.0, 2.0, 3.0}) {
      const Watch watch = WatchPad({kind, "camera.occlusion=0.5"}, 6, height);
      EXPECT_GE(watch.detections.size(), 5U) << kind << " at " << height;
      for (const PadDetection& detection : watch.detections) {
        EXPECT_LE(detection.sighting.tags_seen, 2) << kind;
        EXPECT_LT(ErrorOf(detection, 0.5), 0.08) << kind << " at " << height;
      }
    }
  }
  EXPECT_TRUE(WatchPad({"camera.occlusion=0.9"}, 10, 2.0).detections.empty());
  EXPECT_TRUE(WatchPad({"camera.occlusion=0.9", "sensing=rendered"}, 5, 2.0).detections.empty());
}

TEST(PadSensor, PassingOverImagesOnlySavesTime) {
  const auto pass = [](bool thrifty) {
    return WatchPad({"sensing=rendered"}, 50, 2.0, -8.0, 5.0, thrifty);
  };
  const Watch thrifty = pass(true);
  const Watch all = pass(false);
  ASSERT_GT(all.detections.size(), 10U);
  ASSERT_EQ(thrifty.detections.size(), all.detections.size());
  for (std::size_t i = 0; i < all.detections.size(); ++i) {
    EXPECT_EQ(thrifty.detections[i].sighting.t, all.detections[i].sighting.t);
    EXPECT_EQ(thrifty.detections[i].sighting.p_BP_B, all.detections[i].sighting.p_BP_B);
    EXPECT_EQ(thrifty.detections[i].sighting.yaw_BP, all.detections[i].sighting.yaw_BP);
  }
}

TEST(PadSensor, EveryTenthImageIsSearchedAnyhow) {
  EXPECT_EQ(WatchPad({"sensing=rendered"}, 9, 2.0, -20.0).searched, 0);
  EXPECT_EQ(WatchPad({"sensing=rendered"}, 10, 2.0, -20.0).searched, 1);
}

TEST(DepthSensor, DropsAndDelaysItsImages) {
  for (const char* kind : {"sensing=fast", "sensing=rendered"}) {
    const Scenario scenario =
        Open({kind, "depth.drop=0.5", "depth.latency_ms=150", "depth.width=40", "depth.height=30"});
    const auto sensors = MakeDepthSensors(
        scenario, WorldOf(scenario, DrawTrial(scenario, 1), StandardRegistries()), 3);
    ASSERT_EQ(sensors.size(), 1U);
    DepthSensor* const sensor = sensors[0].get();
    SensingTimes times;
    int arrived = 0;
    for (int k = 0; k < 100; ++k) {
      estimation::VehicleState vehicle;
      vehicle.t = 0.1 * k;
      vehicle.p_WB.z() = 2.0;
      sensor->Look(vehicle, {}, &times);
      while (auto timed = sensor->Poll(vehicle.t)) {
        EXPECT_NEAR(vehicle.t - timed->image.t, 0.2, 1e-9);
        EXPECT_EQ(timed->image.depth.size(), 1200U);
        ++arrived;
        sensor->Recycle(std::move(*timed));
      }
    }
    EXPECT_NEAR(arrived, 50, 20) << kind;
  }
}

// Side by side in two threads, each with its own cameras.
TEST(SensingFlight, ARenderedFlightLandsAndRepeatsBitByBit) {
  const Scenario scenario = Open({"sensing=rendered", "gps.sigma=0.5", "camera.drop=0.1"});
  TrialRecord records[2];
  std::string results[2];
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&, i] {
      const TrialResult result = RunTrial(scenario, 3, StandardRegistries(), &records[i]);
      EXPECT_TRUE(result.landed()) << result.detail;
      EXPECT_GT(result.timing.sensing_stages.pad_image, 0.0);
      EXPECT_GT(result.timing.sensing_stages.depth_image, 0.0);
      results[i] = Deterministic(scenario, result);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(results[0], results[1]);
  ASSERT_EQ(records[0].samples.size(), records[1].samples.size());
  for (std::size_t i = 0; i < records[0].samples.size(); ++i) {
    const RecordSample& a = records[0].samples[i];
    const RecordSample& b = records[1].samples[i];
    ASSERT_EQ(a.vehicle.p_WB, b.vehicle.p_WB) << "at " << a.t;
    ASSERT_EQ(a.pad_estimate.p_WP, b.pad_estimate.p_WP) << "at " << a.t;
    ASSERT_EQ(a.rotor_thrusts, b.rotor_thrusts) << "at " << a.t;
  }
}

TEST(SensingFlight, EveryFaultTakesEffectAndFastFlightsLandAllTheSame) {
  const auto fly = [](const Overrides& overrides) {
    const Scenario scenario = Open(overrides);
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries());
    EXPECT_TRUE(result.landed()) << result.detail << " with "
                                 << (overrides.empty() ? "" : overrides[0]);
    return Deterministic(scenario, result);
  };
  std::vector<std::string> seen = {fly({})};
  // No key without its fault changes anything.
  EXPECT_EQ(fly({"gps.outlier_size=50", "gps.outage=[3, 3]", "camera.noise=5",
                 "camera.outage=[3, 3]", "depth.outage=[3, 3]"}),
            seen[0]);
  for (const Overrides& fault : std::vector<Overrides>{{"gps.outage=[2, 4]"},
                                                       {"gps.outliers=0.1"},
                                                       {"camera.drop=0.3"},
                                                       {"camera.outage=[4, 5]"},
                                                       {"camera.occlusion=0.4"},
                                                       {"camera.occlusion=0.5"},
                                                       {"camera.latency_ms=60"},
                                                       {"depth.noise=0.01"},
                                                       {"depth.drop=0.3"},
                                                       {"depth.outage=[1, 2]"},
                                                       {"depth.latency_ms=60"}}) {
    seen.push_back(fly(fault));
    // In the empty field only the pad vehicle itself can cause errors of the depth camera.
    if (fault[0].rfind("depth", 0) != 0) {
      EXPECT_NE(seen.back(), seen[0]) << fault[0];
    }
  }
}

// What docs/safety.md says of a depth camera that dies: the vehicle rests in space that it has proven. It may also be
// dead from the start.
TEST(SensingFlight, WithoutADepthCameraTheVehicleComesToRestAndTouchesNothing) {
  for (const double dies : {0.0, 1.0, 2.0}) {
    const Scenario scenario = LoadScenario(
        FindScenario("forest"), {fmt::format("depth.outage=[{}, 600]", dies), "timeout=20"},
        StandardRegistries());
    const std::uint64_t seed = 1 + static_cast<std::uint64_t>(dies);
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, seed, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kInfeasible) << dies << " s: " << result.detail;
    ASSERT_TRUE(result.safety);
    EXPECT_EQ(result.safety->uncertified_steps, 0) << dies << " s";
    EXPECT_GT(*result.min_clearance_m, 0.0) << dies << " s";
    const auto lost =
        std::find_if(record.events.begin(), record.events.end(),
                     [](const RecordEvent& e) { return e.text.starts_with("hold ("); });
    ASSERT_NE(lost, record.events.end()) << dies << " s";
    EXPECT_LT(lost->t, dies + 5.3) << "for want of a plan, or of depth images";
    for (const RecordSample& sample : record.samples) {
      if (sample.t < dies + 8.3) continue;
      ASSERT_LT(sample.vehicle.v_WB.norm(), 0.1) << "at " << sample.t << " s";
    }
  }
}

TEST(SensingFlight, ADepthCameraThatComesBackLands) {
  const Scenario scenario =
      LoadScenario(FindScenario("forest"), {"depth.outage=[2, 12]"}, StandardRegistries());
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
  EXPECT_TRUE(result.landed()) << result.detail;
  const auto has = [&record](const char* text) {
    return std::any_of(record.events.begin(), record.events.end(),
                       [text](const RecordEvent& event) { return event.text == text; });
  };
  EXPECT_TRUE(has("hold (depth_lost)"));
  EXPECT_TRUE(has("tracking (recovered)"));
}

// A downward camera that dies 1 s before contact: the rest of the way is bridged. Earlier: no landing.
TEST(SensingFlight, WithoutADownwardCameraOnlyAShortRestIsBridged) {
  const double contact = RunTrial(Open({}), 1, StandardRegistries()).touchdown->t;
  const auto dies = [&](double before) {
    return RunTrial(Open({fmt::format("camera.outage=[{}, 600]", contact - before), "timeout=25"}),
                    1, StandardRegistries());
  };
  EXPECT_TRUE(dies(1.0).landed());
  const TrialResult early = dies(4.0);
  EXPECT_EQ(early.outcome, Outcome::kTimeout) << early.detail;
}

// No tag is ever seen, however good the GPS. So the gate stays closed and the vehicle waits above it. In the vertical
// style it goes around. It never comes down.
TEST(SensingFlight, WithoutTagsNothingDescendsBelowTheGate) {
  for (const char* style : {"descent=planned", "descent=vertical"}) {
    const Scenario scenario = Open({"camera.occlusion=0.9", "gps.sigma=0.01", "timeout=25", style});
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, 1, StandardRegistries(), &record);
    EXPECT_EQ(result.outcome, Outcome::kTimeout);
    bool tags_lost = false;
    for (const RecordEvent& event : record.events) {
      tags_lost = tags_lost || event.text.find("tags_lost") != std::string::npos;
    }
    EXPECT_EQ(tags_lost, scenario.descent == DescentKind::kVertical);
    for (const RecordSample& sample : record.samples) {
      ASSERT_GT(sample.vehicle.p_WB.z() - sample.pad.p_WP.z(), 1.0) << style << sample.t;
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
