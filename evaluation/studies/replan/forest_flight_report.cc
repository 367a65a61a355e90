// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/forest_flight_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr FlightOutcome kOutcomes[] = {FlightOutcome::kReached, FlightOutcome::kCollided,
                                       FlightOutcome::kStuck, FlightOutcome::kCrashed};

constexpr ResultFormat kForestFormat{"touchdown forest flights", 1};

constexpr char kForestSchema[] = R"sql(
CREATE TABLE flight(planner TEXT, kind TEXT, flight INTEGER, seed INTEGER, outcome TEXT,
  message TEXT, time_s REAL, length_m REAL, clearance_m REAL, max_speed_mps REAL,
  max_acceleration_mps2 REAL, plans INTEGER, steps_without_plan INTEGER,
  PRIMARY KEY(planner, kind, flight));
CREATE TABLE timing(planner TEXT, kind TEXT, flight INTEGER, step INTEGER, cpu_ms REAL);
)sql";

std::string Number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

Json QuantilesJson(const Quantiles& q) {
  if (!q.median) return nullptr;
  return {{"median", *q.median}, {"p95", *q.p95}, {"p99", *q.p99}, {"max", *q.max}};
}

int StepsWithoutPlan(const ForestFlight& flight) {
  int sum = 0;
  for (const auto& [what, count] : flight.others) sum += count;
  return sum;
}

std::map<std::string, int> AllOthers(const std::vector<ForestFlight>& flights) {
  std::map<std::string, int> all;
  for (const ForestFlight& flight : flights) {
    for (const auto& [what, count] : flight.others) all[what] += count;
  }
  return all;
}

}  // namespace

std::string ForestFlightText(const std::vector<ForestFlightPart>& parts) {
  std::string text = "36 m through forests, a point seeing obstacles within 5 m\n";
  for (const ForestFlightPart& part : parts) {
    FlightSummary s = Summarise(part.flights);
    text += fmt::format(
        "kind {}, {}: reached {} of {}, 95 % [{:.1f}, {:.1f}] %; collided {}, stuck {}, crashed "
        "{}\n",
        part.options.kind.name, part.planner(), s.outcomes[FlightOutcome::kReached], s.flights,
        100.0 * s.reached.lo, 100.0 * s.reached.hi, s.outcomes[FlightOutcome::kCollided],
        s.outcomes[FlightOutcome::kStuck], s.outcomes[FlightOutcome::kCrashed]);
    text += fmt::format(
        "  median time {} s (of those that arrive, length {} m), largest speed {} m/s; clearance "
        "median {}, least {:.3f} "
        "m\n",
        Number(s.time.median, "{:.1f}"), Number(s.length.median, "{:.1f}"),
        Number(s.max_speed.median, "{:.2f}"), Number(s.clearance.median, "{:.3f}"),
        s.least_clearance);
    text += fmt::format(
        "  step, thread CPU time: median {}, p95 {}, p99 {}, max {} ms where a solver was asked; "
        "{} of {} "
        "steps made no plan\n",
        Number(s.step_ms.median, "{:.3f}"), Number(s.step_ms.p95, "{:.3f}"),
        Number(s.step_ms.p99, "{:.3f}"), Number(s.step_ms.max, "{:.3f}"), s.failed, s.steps);
    for (const auto& [what, count] : AllOthers(part.flights)) {
      text += fmt::format("    {} x {}\n", count, what);
    }
    for (const ForestFlight& flight : part.flights) {
      if (flight.outcome == FlightOutcome::kReached) continue;
      text += fmt::format("    flight {} {} after {:.1f} s{}{}\n", flight.index,
                          ToString(flight.outcome), flight.time, flight.message.empty() ? "" : ": ",
                          flight.message);
    }
  }
  return text;
}

Json ForestFlightJson(const std::vector<ForestFlightPart>& parts) {
  Json json;
  json["flights"] = Json::array();
  for (const ForestFlightPart& part : parts) {
    FlightSummary s = Summarise(part.flights);
    Json outcomes;
    for (const FlightOutcome outcome : kOutcomes) outcomes[ToString(outcome)] = s.outcomes[outcome];
    json["flights"].push_back({{"kind", part.options.kind.name},
                               {"planner", part.planner()},
                               {"seed", part.options.seed},
                               {"flights", s.flights},
                               {"outcomes", outcomes},
                               {"reached_interval_95", {s.reached.lo, s.reached.hi}},
                               {"time_s", QuantilesJson(s.time)},
                               {"length_m", QuantilesJson(s.length)},
                               {"max_speed_mps", QuantilesJson(s.max_speed)},
                               {"max_acceleration_mps2", QuantilesJson(s.max_acceleration)},
                               {"clearance_m", QuantilesJson(s.clearance)},
                               {"least_clearance_m", s.least_clearance},
                               {"steps", s.steps},
                               {"steps_without_plan", AllOthers(part.flights)},
                               {"wall_clock", {{"step_cpu_ms", QuantilesJson(s.step_ms)}}}});
  }
  return json;
}

void WriteForestFlights(const std::string& path, const std::vector<ForestFlightPart>& parts) {
  WriteResultFile(path, kForestFormat, kForestSchema, {}, [&](SqliteDb& db) {
    SqliteStatement insert =
        db.Prepare("INSERT INTO flight VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    SqliteStatement timing = db.Prepare("INSERT INTO timing VALUES(?, ?, ?, ?, ?)");
    for (const ForestFlightPart& part : parts) {
      for (const ForestFlight& f : part.flights) {
        insert.Run(part.planner(), part.options.kind.name, f.index,
                   static_cast<std::int64_t>(part.options.seed), ToString(f.outcome), f.message,
                   f.time, f.length, f.clearance, f.max_speed, f.max_acceleration, f.plans,
                   StepsWithoutPlan(f));
        for (std::size_t i = 0; i < f.step_ms.size(); ++i) {
          timing.Run(part.planner(), part.options.kind.name, f.index, static_cast<int>(i),
                     f.step_ms[i]);
        }
      }
    }
  });
}

}  // namespace touchdown::evaluation
