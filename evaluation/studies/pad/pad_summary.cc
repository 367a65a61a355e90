// SPDX-License-Identifier: BSD-3-Clause
// The study of the pad filter by cells. Flights are independent, samples of one flight are not: the
// bootstrap draws flights with replacement (B. Efron, 1979; percentile interval).
#include "evaluation/studies/pad/pad_summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sim/base/random_stream.h"

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

// Of two sums of squares. What nothing errs in, neither of them does better.
double RatioOfRoots(double of, double over) {
  return of == 0.0 && over == 0.0 ? 1.0 : std::sqrt(of / over);
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
    ratios.push_back(RatioOfRoots(turn_rate, paper));
  }
  return {*Quantile(ratios, 0.025), *Quantile(ratios, 0.975)};
}

}  // namespace

std::optional<PadStudyCell> Summarise(const PadStudy& study, PadStudyCell cell) {
  std::map<int, FlightSums> by_flight;
  FlightSums total;
  for (const PadStudyRow& row : study.rows) {
    const PadStudyFlight& flown = study.flights[static_cast<std::size_t>(row.flight)];
    if (flown.scenario != cell.scenario || flown.sigma != cell.sigma) continue;
    if ((cell.course && row.course != *cell.course) || (cell.tags && row.tags != *cell.tags)) {
      continue;
    }
    const bool paper = row.model == estimation::PadModel::kPaper;
    FlightSums& flight = by_flight[row.flight];
    (paper ? flight.paper : flight.turn_rate).Add(row.sums);
    (paper ? total.paper : total.turn_rate).Add(row.sums);
  }
  if (total.paper.samples == 0) return std::nullopt;
  cell.samples = total.paper.samples;
  cell.flights = static_cast<int>(by_flight.size());
  cell.paper = FiguresOf(total.paper);
  cell.turn_rate = FiguresOf(total.turn_rate);
  cell.ratio = RatioOfRoots(total.turn_rate.prediction2, total.paper.prediction2);
  std::vector<FlightSums> flights;
  for (const auto& [index, sums] : by_flight) flights.push_back(sums);
  cell.interval = RatioInterval(flights);
  return cell;
}

std::vector<PadStudyCell> PadStudyCells(const PadStudyOptions& options, const PadStudy& study) {
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
          if (const auto cell = Summarise(study, asked)) cells.push_back(*cell);
        }
      }
    }
  }
  return cells;
}

std::vector<PadDemand> PadDemands(const PadStudyOptions& options, const PadStudy& study) {
  std::vector<PadDemand> demands;
  for (std::size_t s = 0; s < options.scenarios.size(); ++s) {
    for (std::size_t g = 0; g < options.sigmas.size(); ++g) {
      PadStudyCell all;
      all.scenario = static_cast<int>(s);
      all.sigma = static_cast<int>(g);
      const auto ask = [&](const PadStudyCell& asked, const char* what, const auto& figure,
                           double limit) {
        PadDemand demand;
        demand.text =
            fmt::format("{}, sigma {:g} m: {}", options.scenarios[s], options.sigmas[g], what);
        if (const auto cell = Summarise(study, asked)) demand.value = figure(*cell);
        demand.limit = limit;
        demands.push_back(demand);
      };
      const auto nees = [](const PadStudyCell& cell) { return cell.turn_rate.nees_state; };
      const auto ratio = [](const PadStudyCell& cell) { return cell.ratio; };
      PadStudyCell on = all;
      if (study.motions[s] == "circle") {
        on.course = PadCourse::kTurn;
        ask(on, "prediction on the circle, turn_rate over paper", ratio,
            options.sigmas[g] <= kPadGoodGps ? 1.0 / 3.0 : 0.7);
        on.tags = true;
        ask(on, "the same with tags", ratio, 1.0 / 3.0);
      } else {
        on.course = PadCourse::kStraight;
        ask(on, "prediction on straights, turn_rate over paper", ratio, 1.5);
      }
      ask(all, "NEES of the state over its size", nees, 1.5);
    }
  }
  return demands;
}

}  // namespace touchdown::evaluation
