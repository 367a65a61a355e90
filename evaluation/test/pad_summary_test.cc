// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/pad/pad_summary.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/studies/pad/pad_report.h"

namespace touchdown::evaluation {
namespace {

PadStudyOptions TwoScenarios() {
  PadStudyOptions options;
  options.scenarios = {"straight_turn", "circle"};
  options.sigmas = {0.01, 0.5};
  return options;
}

/// A flight of each cell, without any sample.
PadStudy Unsampled(const PadStudyOptions& options) {
  PadStudy study;
  study.motions = {"straight_turn", "circle"};
  for (int s = 0; s < 2; ++s) {
    for (int g = 0; g < static_cast<int>(options.sigmas.size()); ++g) {
      study.flights.push_back({s, g, 0, 1, s == 0 ? Outcome::kLanded : Outcome::kCollision});
    }
  }
  return study;
}

/// Ten samples of both models: `ratio` of the errors 1.5 s ahead, `nees` of the state.
void AddSamples(int flight, PadCourse course, bool tags, double ratio, double nees,
                PadStudy* study) {
  for (const auto model : {estimation::PadModel::kPaper, estimation::PadModel::kTurnRate}) {
    PadStudyRow row;
    row.flight = flight;
    row.model = model;
    row.course = course;
    row.tags = tags;
    row.sums.samples = 10;
    row.sums.prediction2 = model == estimation::PadModel::kPaper ? 10.0 : 10.0 * ratio * ratio;
    row.sums.nees_state = 10.0 * nees;
    study->rows.push_back(row);
  }
}

/// "text <= limit: what became of it" of all.
std::vector<std::string> Texts(const std::vector<PadDemand>& demands) {
  std::vector<std::string> texts;
  for (const PadDemand& demand : demands) {
    std::ostringstream text;
    text << demand.text << " <= " << std::setprecision(3) << demand.limit << ": ";
    text << (!demand.value ? "no samples" : demand.met() ? "met" : "missed");
    texts.push_back(text.str());
  }
  return texts;
}

TEST(PadSummary, RatioAndIntervalAreOfTheFlights) {
  PadStudyOptions options;
  options.scenarios = {"circle"};
  options.sigmas = {0.01};
  PadStudy study;
  study.motions = {"circle"};
  for (int trial = 0; trial < 40; ++trial) {
    study.flights.push_back({0, 0, trial, 1, Outcome::kLanded});
    for (const auto model : {estimation::PadModel::kPaper, estimation::PadModel::kTurnRate}) {
      PadStudyRow row;
      row.flight = trial;
      row.model = model;
      row.course = PadCourse::kTurn;
      row.sums.samples = 10;
      row.sums.prediction2 = model == estimation::PadModel::kPaper ? 40.0 : 8.0 + 4.0 * (trial % 2);
      study.rows.push_back(row);
    }
  }
  const auto cell = Summarise(study, {});
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->flights, 40);
  EXPECT_DOUBLE_EQ(cell->paper.prediction_m, 2.0);
  EXPECT_DOUBLE_EQ(cell->ratio, 0.5);
  // The mean of 40 draws of 8 or 12 has a deviation of 0.32.
  EXPECT_NEAR(cell->interval.lo, std::sqrt((10.0 - 1.96 * 0.316) / 40.0), 0.005);
  EXPECT_NEAR(cell->interval.hi, std::sqrt((10.0 + 1.96 * 0.316) / 40.0), 0.005);
  PadStudyCell straight;
  straight.course = PadCourse::kStraight;
  EXPECT_FALSE(Summarise(study, straight));
}

TEST(PadSummary, WithoutSamplesEveryDemandIsAskedAndNoneIsMet) {
  const PadStudyOptions options = TwoScenarios();
  const PadStudy study = Unsampled(options);
  const std::vector<PadDemand> demands = PadDemands(options, study);
  const std::vector<std::string> expected = {
      "straight_turn, sigma 0.01 m: prediction on straights, turn_rate over paper <= 1.5: no "
      "samples",
      "straight_turn, sigma 0.01 m: NEES of the state over its size <= 1.5: no samples",
      "straight_turn, sigma 0.5 m: prediction on straights, turn_rate over paper <= 1.5: no "
      "samples",
      "straight_turn, sigma 0.5 m: NEES of the state over its size <= 1.5: no samples",
      "circle, sigma 0.01 m: prediction on the circle, turn_rate over paper <= 0.333: no samples",
      "circle, sigma 0.01 m: the same with tags <= 0.333: no samples",
      "circle, sigma 0.01 m: NEES of the state over its size <= 1.5: no samples",
      "circle, sigma 0.5 m: prediction on the circle, turn_rate over paper <= 0.7: no samples",
      "circle, sigma 0.5 m: the same with tags <= 0.333: no samples",
      "circle, sigma 0.5 m: NEES of the state over its size <= 1.5: no samples"};
  EXPECT_EQ(Texts(demands), expected);
  for (const PadDemand& demand : demands) EXPECT_FALSE(demand.met()) << demand.text;
  // Flights that left no sample were flown all the same.
  const auto json = PadStudyJson(options, study);
  EXPECT_EQ(json["flights"][0]["flown"], 1);
  EXPECT_EQ(json["flights"][0]["landed"], 1);
  EXPECT_EQ(json["flights"][2]["flown"], 1);
  EXPECT_EQ(json["flights"][2]["landed"], 0);
  EXPECT_TRUE(json["demands"][0]["value"].is_null());
  EXPECT_FALSE(json["demands"][0]["met"]);
  EXPECT_NE(PadStudyText(options, study).find("circle, GPS 0.5 m, 1 flights, 0 landed"),
            std::string::npos);
}

TEST(PadSummary, DemandsGoByTheScenariosMotionAndTheirOwnSamples) {
  const PadStudyOptions options = TwoScenarios();
  PadStudy study = Unsampled(options);
  AddSamples(0, PadCourse::kStraight, false, 1.4, 1.0, &study);
  AddSamples(0, PadCourse::kTurn, false, 9.0, 1.0, &study);  // the straight alone is asked for
  AddSamples(1, PadCourse::kStraight, false, 1.6, 1.7, &study);
  AddSamples(2, PadCourse::kTurn, true, 0.3, 0.5, &study);
  AddSamples(2, PadCourse::kStraight, false, 9.0, 1.0, &study);  // a circle stays one
  AddSamples(3, PadCourse::kTurn, false, 0.75, 1.0, &study);
  const std::vector<std::string> expected = {
      "straight_turn, sigma 0.01 m: prediction on straights, turn_rate over paper <= 1.5: met",
      "straight_turn, sigma 0.01 m: NEES of the state over its size <= 1.5: met",
      "straight_turn, sigma 0.5 m: prediction on straights, turn_rate over paper <= 1.5: missed",
      "straight_turn, sigma 0.5 m: NEES of the state over its size <= 1.5: missed",
      "circle, sigma 0.01 m: prediction on the circle, turn_rate over paper <= 0.333: met",
      "circle, sigma 0.01 m: the same with tags <= 0.333: met",
      "circle, sigma 0.01 m: NEES of the state over its size <= 1.5: met",
      "circle, sigma 0.5 m: prediction on the circle, turn_rate over paper <= 0.7: missed",
      "circle, sigma 0.5 m: the same with tags <= 0.333: no samples",
      "circle, sigma 0.5 m: NEES of the state over its size <= 1.5: met"};
  EXPECT_EQ(Texts(PadDemands(options, study)), expected);
}

TEST(PadSummary, WhatNothingErrsInIsNoBetterAndSpoilsNoInterval) {
  PadStudy study;
  for (int trial = 0; trial < 3; ++trial) {
    study.flights.push_back({0, 0, trial, 1, Outcome::kLanded});
    AddSamples(trial, PadCourse::kTurn, false, 0.5, 1.0, &study);
  }
  for (PadStudyRow& row : study.rows) {
    if (row.flight < 2) row.sums.prediction2 = 0.0;
  }
  const auto cell = Summarise(study, {});
  EXPECT_DOUBLE_EQ(cell->ratio, 0.5);
  EXPECT_DOUBLE_EQ(cell->interval.lo, 0.5);
  EXPECT_DOUBLE_EQ(cell->interval.hi, 1.0);  // resamples without the third flight
}

}  // namespace
}  // namespace touchdown::evaluation
