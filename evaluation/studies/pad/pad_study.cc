// SPDX-License-Identifier: BSD-3-Clause
// The pad filter on closed-loop data:
// 1. Fly a flight once, with the filter of its scenario.
// 2. Give a filter of each model the same measurements, at the moments at which they came.
// 3. Ask each 50 times a second for the pad's position and velocity, and for its future as the planner asks
//    (estimation::Predict).
// A sample's course follows from the true turn rate up to its horizon, because no model can predict a turn that has not
// begun.
#include "evaluation/studies/pad/pad_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/base/work_sharing.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/scenario/scenario_value.h"
#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/evaluation/base/shipped_files.h"

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

// The truth in the form of the estimate's motion. A motion has two descriptions; this is the nearer
// one.
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
  const PadState predicted = Predict(filter).At(later.t);
  const PadBelief belief = filter.BeliefAt(now.t);
  PadSums sums;
  sums.samples = 1;
  sums.position2 = (estimate.p_WP - now.pad.p_WP).head<2>().squaredNorm();
  sums.velocity2 = (estimate.v_WP - now.pad.v_WP).head<2>().squaredNorm();
  sums.prediction2 = (predicted.p_WP - later.pad.p_WP).head<2>().squaredNorm();
  sums.nees_position = PositionNees(estimate, now.pad.p_WP.head<2>()) / 2.0;
  sums.nees_state = StateNees(belief, TruthFor(belief, now.pad)) / StateSize(belief.motion);
  sums.nees_prediction = PositionNees(predicted, later.pad.p_WP.head<2>()) / 2.0;
  return sums;
}

void Give(const estimation::PadArrival& arrival, estimation::PadFilter* filter) {
  if (const auto* fix = std::get_if<estimation::PadGpsFix>(&arrival.measurement)) {
    filter->AddGps(*fix);
  } else {
    const auto& seen = std::get<estimation::BelievedSighting>(arrival.measurement);
    filter->AddSighting(seen.sighting, seen.believed);
  }
}

// The flights of a scenario and a sigma. The sigma precedes the user's overrides, so a changed sigma is noticed. The
// vertical style, whose flights are longer, precedes them too, so the user can choose the other.
// @throws BadInput
std::vector<SweepTrial> PlanCell(const PadStudyOptions& options, std::size_t scenario,
                                 std::size_t sigma, const Registries& registries) {
  SweepOptions sweep;
  sweep.scenario_path = FindScenario(options.scenarios[scenario]);
  sweep.overrides = options.overrides;
  sweep.overrides.insert(sweep.overrides.begin(),
                         {"gps.sigma=" + WriteNumber(options.sigmas[sigma]), "descent=vertical"});
  sweep.trials = options.trials;
  sweep.seed = options.seed;
  std::vector<SweepTrial> trials = PlanSweep(sweep, registries);
  for (const SweepTrial& trial : trials) {
    if (trial.scenario.gps.sigma != options.sigmas[sigma]) {
      throw BadInput("--set gps.sigma: study pad takes the sigmas of its cells from --sigmas.");
    }
    if (trial.scenario.own_state == OwnStateKind::kEstimated) {
      throw BadInput(
          fmt::format("{}: own_state: estimated cannot be used with study pad: its truth "
                      "is in W while that pad filter lives in the estimate's frame.",
                      options.scenarios[scenario]));
    }
  }
  return trials;
}

// What a flight leaves.
struct Flown {
  Outcome outcome = Outcome::kError;
  std::vector<PadStudyRow> rows;
};

constexpr char kFlown = 'f', kRefused = 'r', kFailed = 'e';

// The rows are numbers alone, and the process that reads them is of the same program.
std::string Packed(const Flown& flown) {
  static_assert(std::is_trivially_copyable_v<PadStudyRow>);
  std::string bytes(1, kFlown);
  bytes.append(reinterpret_cast<const char*>(&flown.outcome), sizeof(flown.outcome));
  bytes.append(reinterpret_cast<const char*>(flown.rows.data()),
               flown.rows.size() * sizeof(PadStudyRow));
  return bytes;
}

Flown Unpacked(const std::string& bytes) {
  Flown flown;
  std::memcpy(&flown.outcome, bytes.data() + 1, sizeof(flown.outcome));
  const char* rows = bytes.data() + 1 + sizeof(flown.outcome);
  const auto size = static_cast<std::size_t>(bytes.data() + bytes.size() - rows);
  flown.rows.resize(size / sizeof(PadStudyRow));
  if (size > 0) std::memcpy(flown.rows.data(), rows, size);
  return flown;
}

// Calls `fly` for every number in a process of its own, and `take` here for its result. @throws what `fly` throws, and
// std::runtime_error for one that dies or hangs: a mean over flights needs them all.
void FlyAll(int count, int jobs, const std::function<Flown(int)>& fly,
            const std::function<void(int, Flown)>& take,
            const std::function<void(int done, int all)>& progress) {
  constexpr double kLimit = 1800.0;  // [s]
  const auto work = [&](int i) {
    try {
      return Packed(fly(i));
    } catch (const BadInput& error) {
      return kRefused + std::string(error.what());
    } catch (const std::exception& error) {
      return kFailed + std::string(error.what());
    }
  };
  int done = 0;
  const auto receive = [&](const WorkerReply& reply) {
    if (reply.end == WorkerReply::End::kDied) {
      throw std::runtime_error(fmt::format("flight {} ended by {}", reply.item, reply.text));
    }
    if (reply.end == WorkerReply::End::kTimedOut) {
      throw std::runtime_error(
          fmt::format("flight {} had not ended after {} s", reply.item, kLimit));
    }
    if (reply.text[0] == kRefused) throw BadInput(reply.text.substr(1));
    if (reply.text[0] == kFailed) throw std::runtime_error(reply.text.substr(1));
    take(reply.item, Unpacked(reply.text));
    progress(++done, count);
  };
  ShareAll(count, jobs, work, kLimit, receive);
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
  const auto ahead = static_cast<std::size_t>(std::lround(kPadHorizon * kPadLogRate));
  constexpr std::array kModels = {estimation::PadModel::kPaper, estimation::PadModel::kTurnRate};
  std::vector<estimation::PadFilter> filters;
  for (const auto model : kModels) {
    estimation::PadFilterOptions of_model = options;
    of_model.model = model;
    filters.emplace_back(of_model);
  }
  std::map<std::pair<PadCourse, bool>, std::array<PadSums, kModels.size()>> sums;
  std::size_t arrived = 0;
  for (std::size_t k = 0; k + ahead < log.truth.size() && log.truth[k].flying; ++k) {
    const double t = log.truth[k].t;
    for (; arrived < log.arrivals.size() && log.arrivals[arrived].t <= t; ++arrived) {
      for (estimation::PadFilter& filter : filters) Give(log.arrivals[arrived], &filter);
    }
    if (t < kPadSettled || !filters[0].initialized() || !filters[1].initialized()) continue;
    const bool tags = std::max(filters[0].TagAge(t), filters[1].TagAge(t)) <= kPadTagsFresh;
    auto& of_models = sums[{CourseOf(log, k, k + ahead), tags}];
    for (std::size_t m = 0; m < kModels.size(); ++m) {
      of_models[m].Add(Compare(filters[m], log.truth[k], log.truth[k + ahead]));
    }
  }
  std::vector<PadStudyRow> rows;
  for (const auto& [key, of_models] : sums) {
    for (std::size_t m = 0; m < kModels.size(); ++m) {
      PadStudyRow row;
      row.model = kModels[m];
      row.course = key.first;
      row.tags = key.second;
      row.sums = of_models[m];
      rows.push_back(row);
    }
  }
  return rows;
}

PadStudy RunPadStudy(const PadStudyOptions& options, const Registries& registries,
                     const std::function<void(int done, int all)>& progress) {
  PadStudy study;
  std::vector<Scenario> scenario_of;  // by flight
  for (std::size_t s = 0; s < options.scenarios.size(); ++s) {
    for (std::size_t g = 0; g < options.sigmas.size(); ++g) {
      for (SweepTrial& trial : PlanCell(options, s, g, registries)) {
        study.motions.resize(s + 1, trial.scenario.pad.motion);
        study.flights.push_back(
            {static_cast<int>(s), static_cast<int>(g), trial.index, trial.seed, {}});
        scenario_of.push_back(std::move(trial.scenario));
      }
    }
  }
  const bool rendered = std::any_of(scenario_of.begin(), scenario_of.end(), [](const Scenario& s) {
    return s.sensing == SensingKind::kRendered;
  });
  if (rendered) RequireRenderedSensing();
  const auto fly = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    TrialSamples samples;
    Flown flown;
    flown.outcome =
        RunTrial(scenario_of[at], study.flights[at].seed, registries, nullptr, nullptr, &samples)
            .outcome;
    flown.rows = ReplayPadLog(samples.pad, PadFilterOptionsOf(scenario_of[at]));
    for (PadStudyRow& row : flown.rows) row.flight = i;
    return flown;
  };
  std::vector<std::vector<PadStudyRow>> rows_of(study.flights.size());
  FlyAll(
      static_cast<int>(study.flights.size()), options.jobs, fly,
      [&](int i, Flown flown) {
        study.flights[static_cast<std::size_t>(i)].outcome = flown.outcome;
        rows_of[static_cast<std::size_t>(i)] = std::move(flown.rows);
      },
      progress);
  for (const auto& some : rows_of) study.rows.insert(study.rows.end(), some.begin(), some.end());
  return study;
}

}  // namespace touchdown::evaluation
