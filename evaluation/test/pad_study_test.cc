// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/pad/pad_study.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/studies/pad/pad_report.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

constexpr double kSpeed = 0.8;     // [m/s]
constexpr double kTurnRate = 0.4;  // [rad/s]

/// A pad on a circle, or straight on; exact fixes at 10 Hz, and sightings from straight above.
PadLog DrivenLog(double turn_rate, bool tags, double duration = 8.0) {
  const auto pad_at = [turn_rate](double t) {
    estimation::PadState pad;
    pad.yaw = turn_rate * t;
    pad.yaw_rate = turn_rate;
    if (turn_rate == 0.0) {
      pad.p_WP << kSpeed * t, 0.0, 0.5;
    } else {
      const double radius = kSpeed / turn_rate;
      pad.p_WP << radius * std::sin(pad.yaw), radius * (1.0 - std::cos(pad.yaw)), 0.5;
    }
    pad.v_WP << kSpeed * std::cos(pad.yaw), kSpeed * std::sin(pad.yaw), 0.0;
    return pad;
  };
  PadLog log;
  for (int k = 0; k <= duration * kPadLogRate; ++k) {
    const double t = k / kPadLogRate;
    const estimation::PadState pad = pad_at(t);
    if (k % 5 == 0) log.arrivals.push_back({t, estimation::PadGpsFix{t, pad.p_WP.head<2>(), 0.01}});
    if (tags && k % 3 == 0) {
      estimation::BelievedSighting seen;
      seen.believed.t = t;
      seen.believed.p_WB = pad.p_WP + Eigen::Vector3d(0.0, 0.0, 1.0);
      seen.sighting = {t, {0.0, 0.0, -1.0}, pad.yaw, Eigen::Vector3d::Constant(0.005), 0.01, 4};
      log.arrivals.push_back({t, seen});
    }
    log.truth.push_back({t, true, pad});
  }
  return log;
}

std::vector<PadStudyRow> Replay(const PadLog& log, estimation::PadModel model) {
  estimation::PadFilterOptions options;
  options.pad_height = 0.5;
  std::vector<PadStudyRow> rows = ReplayPadLog(log, options);
  std::erase_if(rows, [model](const PadStudyRow& row) { return row.model != model; });
  return rows;
}

TEST(PadStudy, WithTagsTheTurnIsPredictedAndThePaperGoesStraightOn) {
  const PadLog log = DrivenLog(kTurnRate, true);
  const auto turn_rate = Replay(log, estimation::PadModel::kTurnRate);
  const auto paper = Replay(log, estimation::PadModel::kPaper);
  ASSERT_EQ(turn_rate.size(), 1U);
  ASSERT_EQ(paper.size(), 1U);
  EXPECT_EQ(turn_rate[0].course, PadCourse::kTurn);
  EXPECT_TRUE(turn_rate[0].tags);
  // From 3 s to 6.5 s: later the log does not reach the horizon.
  EXPECT_EQ(turn_rate[0].sums.samples, 176);
  EXPECT_EQ(paper[0].sums.samples, 176);
  const auto rms = [](const PadStudyRow& row) {
    return std::sqrt(row.sums.prediction2 / row.sums.samples);
  };
  EXPECT_LT(rms(turn_rate[0]), 0.01);
  // Straight on from the circle: off by its sagitta, r (1 - cos(angle)), and a little along it.
  const double angle = kTurnRate * kPadHorizon;
  EXPECT_NEAR(rms(paper[0]), kSpeed / kTurnRate * (1.0 - std::cos(angle)), 0.08);
}

TEST(PadStudy, SamplesAreToldApartByCourseAndSource) {
  const auto straight = Replay(DrivenLog(0.0, false), estimation::PadModel::kTurnRate);
  ASSERT_EQ(straight.size(), 1U);
  EXPECT_EQ(straight[0].course, PadCourse::kStraight);
  EXPECT_FALSE(straight[0].tags);
  EXPECT_LT(straight[0].sums.nees_state / straight[0].sums.samples, 1.0);

  PadLog bend = DrivenLog(0.0, false);
  for (PadTruth& truth : bend.truth) {
    if (truth.t > 5.0) truth.pad.yaw_rate = 0.3;
  }
  int changing = 0;
  for (const PadStudyRow& row : Replay(bend, estimation::PadModel::kTurnRate)) {
    if (row.course == PadCourse::kChanging) changing = row.sums.samples;
  }
  EXPECT_EQ(changing, 75);  // as long as the bend lies within the horizon
}

TEST(PadStudy, EndsAtContact) {
  PadLog log = DrivenLog(0.0, false);
  for (PadTruth& truth : log.truth) truth.flying = truth.t < 5.0;
  const auto rows = Replay(log, estimation::PadModel::kPaper);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].sums.samples, 100);
}

TEST(PadStudy, ASightingThatTheFilterRefusesIsNoTagSeen) {
  PadLog log = DrivenLog(kTurnRate, false);
  const PadLog seen = DrivenLog(kTurnRate, true);
  for (const estimation::PadArrival& arrival : seen.arrivals) {
    if (!std::holds_alternative<estimation::BelievedSighting>(arrival.measurement)) continue;
    if (arrival.t < 4.0 || arrival.t > 4.05) continue;
    estimation::PadArrival off = arrival;  // one image, 20 m beside the pad
    std::get<estimation::BelievedSighting>(off.measurement).believed.p_WB.x() += 20.0;
    log.arrivals.push_back(off);
    break;
  }
  std::stable_sort(
      log.arrivals.begin(), log.arrivals.end(),
      [](const estimation::PadArrival& a, const estimation::PadArrival& b) { return a.t < b.t; });
  for (const auto model : {estimation::PadModel::kPaper, estimation::PadModel::kTurnRate}) {
    const auto rows = Replay(log, model);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_FALSE(rows[0].tags);
  }
}

TEST(PadStudy, RefusesWhatItWouldOverwriteAndAFilterInAnotherFrame) {
  PadStudyOptions options;
  options.scenarios = {"open"};
  options.trials = 1;
  const auto refusal = [&](const std::string& set) -> std::string {
    options.overrides = {set};
    try {
      RunPadStudy(options, StandardRegistries(), [](int, int) { FAIL(); });
    } catch (const BadInput& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(refusal("gps.sigma=1").find("--sigmas"), std::string::npos);
  EXPECT_NE(refusal("gps={sigma: 0.3}").find("--sigmas"), std::string::npos);
  EXPECT_NE(refusal("own_state=estimated").find("own_state"), std::string::npos);
}

TEST(PadStudyFlight, IsTheFlightsOwnFilterAndDoesNotDependOnJobs) {
  PadStudyOptions options;
  options.scenarios = {"open"};
  options.sigmas = {0.05};
  options.trials = 2;
  const auto quiet = [](int, int) {};
  const auto one = RunPadStudy(options, StandardRegistries(), quiet);
  options.jobs = 2;
  const auto two = RunPadStudy(options, StandardRegistries(), quiet);
  EXPECT_EQ(PadStudyJson(options, one).dump(), PadStudyJson(options, two).dump());

  // The log of a flight, replayed, gives the filter that it was flown with.
  const Scenario scenario = LoadScenario(FindScenario("open"), {}, StandardRegistries());
  TrialSamples samples;
  TrialRecord record;
  RunTrial(scenario, 3, StandardRegistries(), &record, nullptr, &samples);
  ASSERT_EQ(samples.pad.truth.size(), record.samples.size());
  estimation::PadFilter filter(PadFilterOptionsOf(scenario));
  std::size_t arrived = 0;
  for (const RecordSample& sample : record.samples) {
    for (; arrived < samples.pad.arrivals.size() && samples.pad.arrivals[arrived].t <= sample.t;
         ++arrived) {
      const estimation::PadArrival& arrival = samples.pad.arrivals[arrived];
      if (const auto* fix = std::get_if<estimation::PadGpsFix>(&arrival.measurement)) {
        filter.AddGps(*fix);
      } else {
        const auto& seen = std::get<estimation::BelievedSighting>(arrival.measurement);
        filter.AddSighting(seen.sighting, seen.believed);
      }
    }
    if (!sample.pad_known) continue;
    ASSERT_EQ(filter.Estimate(sample.t).p_WP, sample.pad_estimate.p_WP) << sample.t;
  }
}

}  // namespace
}  // namespace touchdown::evaluation
