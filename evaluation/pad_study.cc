// SPDX-License-Identifier: BSD-3-Clause
// The pad filter on closed-loop data. A flight is flown once, with the filter of its scenario; then a
// filter of each model is given the very measurements that came to it, at the moments at which they
// came, and is asked 50 times a second where the pad is, how fast, and where it will be, the last as
// the planner asks (estimation::Predict). A sample's course goes by the true turn rate up to its
// horizon: no model can know of a turn that has not begun.
#include "touchdown/evaluation/pad_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Core>

#include "touchdown/estimation/pad_predictor.h"
#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/on_threads.h"
#include "touchdown/evaluation/perception.h"
#include "touchdown/evaluation/scenario_value.h"
#include "touchdown/evaluation/sweep.h"

namespace touchdown::evaluation {
namespace {

using estimation::PadBelief;
using estimation::PadMotion;
using estimation::PadState;

constexpr double kSteadyTurn = 0.02;  // turn rates that differ by less are one [rad/s]
constexpr double kPi = std::numbers::pi;

PadCourse CourseOf(const PadLog& log, std::size_t from, std::size_t to) {
  double low = log.truth[from].pad.yaw_rate, high = low;
  for (std::size_t k = from; k <= to; ++k) {
    low = std::min(low, log.truth[k].pad.yaw_rate);
    high = std::max(high, log.truth[k].pad.yaw_rate);
  }
  if (high - low > kSteadyTurn) return PadCourse::kChanging;
  return std::max(std::abs(low), std::abs(high)) < kSteadyTurn ? PadCourse::kStraight
                                                               : PadCourse::kTurn;
}

// The truth as the belief's motion has it; of the two descriptions of a motion the nearer one.
estimation::PadVector TruthFor(const PadBelief& belief, const PadState& pad) {
  estimation::PadVector truth = estimation::PadVector::Zero();
  truth.head<2>() = pad.p_WP.head<2>();
  if (belief.motion == PadMotion::kVelocity) {
    truth.segment<2>(2) = pad.v_WP.head<2>();
    return truth;
  }
  const Eigen::Vector2d along(std::cos(pad.yaw), std::sin(pad.yaw));
  const bool around = std::abs(estimation::WrapAngle(belief.mean(3) - pad.yaw)) > 0.5 * kPi;
  truth(2) = (around ? -1.0 : 1.0) * pad.v_WP.head<2>().dot(along);
  truth(3) = pad.yaw + (around ? kPi : 0.0);
  if (belief.motion == PadMotion::kTurn) truth(4) = pad.yaw_rate;
  return truth;
}

PadSums Compare(const estimation::PadFilter& filter, const PadTruth& now, const PadTruth& later) {
  const PadState estimate = filter.Estimate(now.t);
  const PadState foretold = Predict(filter).At(later.t);
  const PadBelief belief = filter.BeliefAt(now.t);
  PadSums sums;
  sums.samples = 1;
  sums.position2 = (estimate.p_WP - now.pad.p_WP).head<2>().squaredNorm();
  sums.velocity2 = (estimate.v_WP - now.pad.v_WP).head<2>().squaredNorm();
  sums.prediction2 = (foretold.p_WP - later.pad.p_WP).head<2>().squaredNorm();
  sums.nees_position = PositionNees(estimate, now.pad.p_WP.head<2>()) / 2.0;
  sums.nees_state = StateNees(belief, TruthFor(belief, now.pad)) / StateSize(belief.motion);
  sums.nees_prediction = PositionNees(foretold, later.pad.p_WP.head<2>()) / 2.0;
  return sums;
}

void Give(const PadArrival& arrival, estimation::PadFilter* filter) {
  if (const auto* fix = std::get_if<estimation::PadGpsFix>(&arrival.measurement)) {
    filter->AddGps(*fix);
  } else {
    const auto& seen = std::get<BelievedSighting>(arrival.measurement);
    filter->AddSighting(seen.sighting, seen.believed);
  }
}

}  // namespace

const char* ToString(PadCourse course) {
  switch (course) {
    case PadCourse::kStraight:
      return "straight";
    case PadCourse::kTurn:
      return "turn";
    case PadCourse::kChanging:
      return "changing";
  }
  return "unknown";
}

void PadSums::Add(const PadSums& other) {
  samples += other.samples;
  position2 += other.position2;
  velocity2 += other.velocity2;
  prediction2 += other.prediction2;
  nees_position += other.nees_position;
  nees_state += other.nees_state;
  nees_prediction += other.nees_prediction;
}

std::vector<PadStudyRow> ReplayPadLog(const PadLog& log,
                                      const estimation::PadFilterOptions& options) {
  constexpr auto kAhead = static_cast<std::size_t>(kPadHorizon * kPadLogRate + 0.5);
  estimation::PadFilter filter(options);
  std::map<std::pair<PadCourse, bool>, PadSums> sums;
  std::size_t arrived = 0;
  double tag_t = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + kAhead < log.truth.size() && log.truth[k].flying; ++k) {
    const double t = log.truth[k].t;
    for (; arrived < log.arrivals.size() && log.arrivals[arrived].t <= t; ++arrived) {
      Give(log.arrivals[arrived], &filter);
      if (std::holds_alternative<BelievedSighting>(log.arrivals[arrived].measurement)) {
        tag_t = log.arrivals[arrived].t;
      }
    }
    if (t < kPadSettled || !filter.initialized()) continue;
    sums[{CourseOf(log, k, k + kAhead), t - tag_t <= kPadTagsFresh}].Add(
        Compare(filter, log.truth[k], log.truth[k + kAhead]));
  }
  std::vector<PadStudyRow> rows;
  for (const auto& [key, sum] : sums) {
    PadStudyRow row;
    row.model = options.model;
    row.course = key.first;
    row.tags = key.second;
    row.sums = sum;
    rows.push_back(row);
  }
  return rows;
}

std::vector<PadStudyRow> RunPadStudy(const PadStudyOptions& options, const Registries& registries,
                                     const std::function<void(int done, int all)>& progress) {
  struct Flight {
    int scenario, sigma, trial;
    SweepTrial plan;
  };
  std::vector<Flight> flights;
  for (std::size_t s = 0; s < options.scenarios.size(); ++s) {
    for (std::size_t g = 0; g < options.sigmas.size(); ++g) {
      SweepOptions sweep;
      sweep.scenario_path = FindScenario(options.scenarios[s]);
      sweep.overrides = options.overrides;
      sweep.overrides.push_back("gps.sigma=" + WriteNumber(options.sigmas[g]));
      sweep.trials = options.trials;
      sweep.seed = options.seed;
      for (SweepTrial& trial : PlanSweep(sweep, registries)) {
        flights.push_back(
            {static_cast<int>(s), static_cast<int>(g), trial.index, std::move(trial)});
      }
    }
  }
  const int all = static_cast<int>(flights.size());
  std::vector<std::vector<PadStudyRow>> of_flight(flights.size());
  const auto fly = [&](int i) {
    const Flight& flight = flights[static_cast<std::size_t>(i)];
    TrialSamples samples;
    const TrialResult result =
        RunTrial(flight.plan.scenario, flight.plan.seed, registries, nullptr, nullptr, &samples);
    for (const auto model : {estimation::PadModel::kPaper, estimation::PadModel::kTurnRate}) {
      estimation::PadFilterOptions filter = PadFilterOptionsOf(flight.plan.scenario);
      filter.model = model;
      for (PadStudyRow row : ReplayPadLog(samples.pad, filter)) {
        row.scenario = flight.scenario;
        row.sigma = flight.sigma;
        row.trial = flight.trial;
        row.seed = flight.plan.seed;
        row.outcome = result.outcome;
        of_flight[static_cast<std::size_t>(i)].push_back(row);
      }
    }
  };
  RunOnThreads(all, options.jobs, fly, [&](int done) { progress(done, all); });
  std::vector<PadStudyRow> rows;
  for (const auto& some : of_flight) rows.insert(rows.end(), some.begin(), some.end());
  return rows;
}

}  // namespace touchdown::evaluation
