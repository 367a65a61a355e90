// SPDX-License-Identifier: BSD-3-Clause
// The study of the pad filter by cells. Flights are independent, samples of one flight are not: the
// bootstrap draws flights with replacement (B. Efron, 1979; percentile interval).
#include "touchdown/evaluation/pad_summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "touchdown/sim/random_stream.h"

namespace touchdown::evaluation {
namespace {

constexpr int kResamples = 2000;

// Sums of a flight by both models; the samples are the same.
struct FlightSums {
  PadSums paper, turn_rate;
};

PadModelFigures FiguresOf(const PadSums& sums) {
  const double n = sums.samples;
  return {
      std::sqrt(sums.position2 / n), std::sqrt(sums.velocity2 / n), std::sqrt(sums.prediction2 / n),
      sums.nees_position / n,        sums.nees_state / n,           sums.nees_prediction / n};
}

Interval RatioInterval(const std::vector<FlightSums>& flights) {
  sim::RandomStream draw(1, "pad study bootstrap");
  std::vector<double> ratios;
  for (int i = 0; i < kResamples; ++i) {
    double paper = 0.0, turn_rate = 0.0;
    for (std::size_t k = 0; k < flights.size(); ++k) {
      const auto at = static_cast<std::size_t>(draw.Uniform(0.0, 1.0) * flights.size());
      paper += flights[at].paper.prediction2;
      turn_rate += flights[at].turn_rate.prediction2;
    }
    ratios.push_back(std::sqrt(turn_rate / paper));
  }
  return {*Quantile(ratios, 0.025), *Quantile(ratios, 0.975)};
}

bool DrivesCircle(const std::vector<PadStudyRow>& rows, int scenario) {
  return std::none_of(rows.begin(), rows.end(), [scenario](const PadStudyRow& row) {
    return row.scenario == scenario && row.course != PadCourse::kTurn;
  });
}

}  // namespace

std::optional<PadStudyCell> Summarise(const std::vector<PadStudyRow>& rows, PadStudyCell cell) {
  std::map<int, FlightSums> by_trial;
  FlightSums total;
  for (const PadStudyRow& row : rows) {
    if (row.scenario != cell.scenario || row.sigma != cell.sigma) continue;
    if ((cell.course && row.course != *cell.course) || (cell.tags && row.tags != *cell.tags)) {
      continue;
    }
    const bool paper = row.model == estimation::PadModel::kPaper;
    FlightSums& flight = by_trial[row.trial];
    (paper ? flight.paper : flight.turn_rate).Add(row.sums);
    (paper ? total.paper : total.turn_rate).Add(row.sums);
  }
  if (total.paper.samples == 0) return std::nullopt;
  cell.samples = total.paper.samples;
  cell.flights = static_cast<int>(by_trial.size());
  cell.paper = FiguresOf(total.paper);
  cell.turn_rate = FiguresOf(total.turn_rate);
  cell.ratio = cell.turn_rate.prediction_m / cell.paper.prediction_m;
  std::vector<FlightSums> flights;
  for (const auto& [trial, sums] : by_trial) flights.push_back(sums);
  cell.interval = RatioInterval(flights);
  return cell;
}

std::vector<PadStudyCell> PadStudyCells(const PadStudyOptions& options,
                                        const std::vector<PadStudyRow>& rows) {
  const std::vector<std::optional<PadCourse>> courses = {PadCourse::kStraight, PadCourse::kTurn,
                                                         PadCourse::kChanging, std::nullopt};
  const std::vector<std::optional<bool>> sources = {false, true, std::nullopt};
  std::vector<PadStudyCell> cells;
  for (std::size_t s = 0; s < options.scenarios.size(); ++s) {
    for (std::size_t g = 0; g < options.sigmas.size(); ++g) {
      for (const auto& course : courses) {
        for (const auto& tags : sources) {
          PadStudyCell asked;
          asked.scenario = static_cast<int>(s);
          asked.sigma = static_cast<int>(g);
          asked.course = course;
          asked.tags = tags;
          if (const auto cell = Summarise(rows, asked)) cells.push_back(*cell);
        }
      }
    }
  }
  return cells;
}

std::vector<PadDemand> PadDemands(const PadStudyOptions& options,
                                  const std::vector<PadStudyRow>& rows) {
  std::vector<PadDemand> demands;
  const auto ask = [&](const PadStudyCell& cell, const std::string& what, double value,
                       double limit) {
    demands.push_back({fmt::format("{}, sigma {:g} m: {}", options.scenarios[cell.scenario],
                                   options.sigmas[cell.sigma], what),
                       value, limit});
  };
  for (const PadStudyCell& cell : PadStudyCells(options, rows)) {
    const bool any_source = !cell.tags;
    const bool good_gps = options.sigmas[cell.sigma] <= kPadGoodGps;
    if (!cell.course && any_source) {
      ask(cell, "NEES of the state over its size", cell.turn_rate.nees_state, 1.5);
    } else if (cell.course == PadCourse::kStraight && any_source) {
      ask(cell, "prediction on straights, turn_rate over paper", cell.ratio, 1.5);
    } else if (cell.course != PadCourse::kTurn || !DrivesCircle(rows, cell.scenario)) {
      continue;
    } else if (any_source) {
      ask(cell, "prediction on the circle, turn_rate over paper", cell.ratio,
          good_gps ? 1.0 / 3.0 : 0.7);
    } else if (*cell.tags) {
      ask(cell, "the same with tags", cell.ratio, 1.0 / 3.0);
    }
  }
  return demands;
}

}  // namespace touchdown::evaluation
