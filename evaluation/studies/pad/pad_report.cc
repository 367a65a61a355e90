// SPDX-License-Identifier: BSD-3-Clause
// The study of the pad filter in words, in JSON and as a table of its flights.
#include "evaluation/studies/pad/pad_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/studies/pad/pad_summary.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr ResultFormat kFormat{"touchdown pad study", 2};

constexpr char kSchema[] = R"sql(
CREATE TABLE flight(flight INTEGER PRIMARY KEY, scenario TEXT, gps_sigma_m REAL, trial INTEGER,
  seed INTEGER, outcome TEXT);
CREATE TABLE error(flight INTEGER REFERENCES flight, model TEXT, course TEXT, tags INTEGER,
  samples INTEGER, position2_m2 REAL, velocity2_m2ps2 REAL, prediction2_m2 REAL,
  nees_position REAL, nees_state REAL, nees_prediction REAL);
CREATE TABLE cell(scenario TEXT, gps_sigma_m REAL, course TEXT, source TEXT, model TEXT,
  samples INTEGER, flights INTEGER, position_m REAL, velocity_mps REAL, prediction_m REAL,
  nees_position REAL, nees_state REAL, nees_prediction REAL, ratio REAL, ratio_lo REAL,
  ratio_hi REAL);
)sql";

const char* CourseName(const PadStudyCell& cell) {
  return cell.course ? ToString(*cell.course) : "all";
}

const char* SourceName(const PadStudyCell& cell) {
  if (!cell.tags) return "all";
  return *cell.tags ? "tags" : "gps";
}

std::string ModelLine(const PadModelFigures& f) {
  return fmt::format("{:>8.3f}{:>7.3f}{:>7.3f}{:>6.2f}{:>6.2f}{:>6.2f}", f.position_m,
                     f.velocity_mps, f.prediction_m, f.nees_position, f.nees_state,
                     f.nees_prediction);
}

Json ModelJson(const PadModelFigures& f) {
  return {{"rmse_position_m", f.position_m},     {"rmse_velocity_mps", f.velocity_mps},
          {"rmse_prediction_m", f.prediction_m}, {"nees_position_per_dof", f.nees_position},
          {"nees_state_per_dof", f.nees_state},  {"nees_prediction_per_dof", f.nees_prediction}};
}

struct OutcomeCount {
  int flights = 0, landed = 0;
};

OutcomeCount CountOutcomes(const PadStudy& study, int scenario, int sigma) {
  OutcomeCount count;
  for (const PadStudyFlight& flight : study.flights) {
    if (flight.scenario != scenario || flight.sigma != sigma) continue;
    ++count.flights;
    if (flight.outcome == Outcome::kLanded) ++count.landed;
  }
  return count;
}

// The line above the cells of a scenario and a sigma.
std::string Heading(const PadStudyOptions& options, const PadStudy& study, int scenario,
                    int sigma) {
  const OutcomeCount count = CountOutcomes(study, scenario, sigma);
  std::string text =
      fmt::format("{}, GPS {:g} m, {} flights, {} landed, seed {}\n", options.scenarios[scenario],
                  options.sigmas[sigma], count.flights, count.landed, options.seed);
  text += fmt::format("{:<9}{:<5}{:>8}{:>40}{:>40}{:>24}\n", "course", "by", "samples", "paper",
                      "turn_rate", "prediction");
  text += fmt::format("{:<22}", "");
  for (int model = 0; model < 2; ++model) {
    text += fmt::format("{:>8}{:>7}{:>7}{:>6}{:>6}{:>6}", "p [m]", "v", "1.5 s", "NEESp", "state",
                        "1.5 s");
  }
  return text + fmt::format("{:>24}\n", "turn_rate/paper, 95 %");
}

}  // namespace

std::string PadStudyText(const PadStudyOptions& options, const PadStudy& study) {
  std::string text;
  const std::vector<PadStudyCell> cells = PadStudyCells(options, study);
  auto cell = cells.begin();  // in the order of the loops
  for (int s = 0; s < static_cast<int>(options.scenarios.size()); ++s) {
    for (int g = 0; g < static_cast<int>(options.sigmas.size()); ++g) {
      text += Heading(options, study, s, g);
      for (; cell != cells.end() && cell->scenario == s && cell->sigma == g; ++cell) {
        text += fmt::format("{:<9}{:<5}{:>8}{}{}{:>8.2f} [{:>5.2f}, {:>5.2f}]\n", CourseName(*cell),
                            SourceName(*cell), cell->samples, ModelLine(cell->paper),
                            ModelLine(cell->turn_rate), cell->ratio, cell->interval.lo,
                            cell->interval.hi);
      }
      text += "\n";
    }
  }
  text += "Demands on turn_rate:\n";
  for (const PadDemand& demand : PadDemands(options, study)) {
    const std::string value =
        demand.value ? fmt::format("{:.2f}", *demand.value) : std::string("no samples");
    text += fmt::format("  {:<76}{:>10}, at most {:.2f}: {}\n", demand.text, value, demand.limit,
                        demand.met() ? "yes" : "no");
  }
  return text;
}

Json PadStudyJson(const PadStudyOptions& options, const PadStudy& study) {
  Json json = {{"seed", options.seed},     {"trials", options.trials}, {"set", options.overrides},
               {"horizon_s", kPadHorizon}, {"flights", Json::array()}, {"cells", Json::array()},
               {"demands", Json::array()}};
  for (std::size_t s = 0; s < options.scenarios.size(); ++s) {
    for (std::size_t g = 0; g < options.sigmas.size(); ++g) {
      const OutcomeCount count = CountOutcomes(study, static_cast<int>(s), static_cast<int>(g));
      json["flights"].push_back({{"scenario", options.scenarios[s]},
                                 {"gps_sigma_m", options.sigmas[g]},
                                 {"flown", count.flights},
                                 {"landed", count.landed}});
    }
  }
  for (const PadStudyCell& cell : PadStudyCells(options, study)) {
    json["cells"].push_back({{"scenario", options.scenarios[cell.scenario]},
                             {"gps_sigma_m", options.sigmas[cell.sigma]},
                             {"course", CourseName(cell)},
                             {"source", SourceName(cell)},
                             {"samples", cell.samples},
                             {"flights", cell.flights},
                             {"paper", ModelJson(cell.paper)},
                             {"turn_rate", ModelJson(cell.turn_rate)},
                             {"prediction_ratio", cell.ratio},
                             {"interval_95", {cell.interval.lo, cell.interval.hi}}});
  }
  for (const PadDemand& demand : PadDemands(options, study)) {
    json["demands"].push_back({{"demand", demand.text},
                               {"value", demand.value ? Json(*demand.value) : Json()},
                               {"limit", demand.limit},
                               {"met", demand.met()}});
  }
  return json;
}

void WritePadStudy(const std::string& path, const PadStudyOptions& options, const PadStudy& study) {
  ManifestFacts facts;
  facts.emplace_back("seed", std::to_string(options.seed));
  for (std::size_t i = 0; i < options.overrides.size(); ++i) {
    facts.emplace_back(fmt::format("set_{}", i), options.overrides[i]);
  }
  WriteResultFile(path, kFormat, kSchema, facts, [&](SqliteDb& db) {
    SqliteStatement flown = db.Prepare("INSERT INTO flight VALUES(?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < study.flights.size(); ++i) {
      const PadStudyFlight& flight = study.flights[i];
      flown.Run(static_cast<std::int64_t>(i), options.scenarios[flight.scenario],
                options.sigmas[flight.sigma], flight.trial, static_cast<std::int64_t>(flight.seed),
                ToString(flight.outcome));
    }
    SqliteStatement error = db.Prepare("INSERT INTO error VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const PadStudyRow& row : study.rows) {
      const PadSums& sums = row.sums;
      error.Run(row.flight, std::string(ToString(row.model)), ToString(row.course), row.tags,
                sums.samples, sums.position2, sums.velocity2, sums.prediction2, sums.nees_position,
                sums.nees_state, sums.nees_prediction);
    }
    SqliteStatement insert =
        db.Prepare("INSERT INTO cell VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const PadStudyCell& cell : PadStudyCells(options, study)) {
      for (const bool paper : {true, false}) {
        const PadModelFigures& f = paper ? cell.paper : cell.turn_rate;
        insert.Run(options.scenarios[cell.scenario], options.sigmas[cell.sigma], CourseName(cell),
                   SourceName(cell), paper ? "paper" : "turn_rate", cell.samples, cell.flights,
                   f.position_m, f.velocity_mps, f.prediction_m, f.nees_position, f.nees_state,
                   f.nees_prediction, cell.ratio, cell.interval.lo, cell.interval.hi);
      }
    }
  });
}

}  // namespace touchdown::evaluation
