// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/study_rates.h"

#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/study_run.h"
#include "evaluation/judge/landing_judge.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

std::string TitleOf(const Json& entries, const std::string& name) {
  for (const Json& entry : entries) {
    if (entry.at("name") == name) return entry.at("title");
  }
  return name;
}

struct Row {
  std::string outcome;
  bool landed = false;
  double time_to_land_s = 0.0, touchdown_error_m = 0.0;
};

std::map<std::pair<std::string, std::string>, std::vector<Row>> ReadRows(
    const std::string& folder) {
  const std::string path = StudyTablePath(folder);
  std::map<std::pair<std::string, std::string>, std::vector<Row>> rows;
  NamingFile(path, kFileOfTrials, [&] {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    ReadManifest(db, path);
    SqliteStatement trials = db.Prepare(
        "SELECT cell.value, method.value, outcome, landed, time_to_land_s, touchdown_error_m FROM "
        "trial "
        "JOIN variation AS cell ON cell.trial = trial.trial AND cell.key = 'cell' "
        "JOIN variation AS method ON method.trial = trial.trial AND method.key = 'method' "
        "ORDER BY trial.trial");
    while (trials.Step()) {
      rows[{trials.Text(0), trials.Text(1)}].push_back(
          {trials.Text(2), trials.Integer(3) != 0, trials.Real(4), trials.Real(5)});
    }
  });
  return rows;
}

bool Succeeded(const std::string& name) {
  const std::optional<Outcome> outcome = OutcomeNamed(name);
  return outcome && IsSuccess(*outcome);
}

PartRates RatesOf(const std::vector<Row>& rows) {
  PartRates part;
  std::vector<double> times, errors;
  for (const Row& row : rows) {
    ++part.trials;
    ++part.outcomes[row.outcome];
    part.succeeded += Succeeded(row.outcome);
    if (!row.landed) continue;
    times.push_back(row.time_to_land_s);
    errors.push_back(row.touchdown_error_m);
  }
  part.rate = ClopperPearson(part.succeeded, part.trials);
  part.time_to_land_s = QuantilesOf(times);
  part.touchdown_error_m = QuantilesOf(errors);
  return part;
}

bool IsError(const std::string& name) {
  const std::optional<Outcome> outcome = OutcomeNamed(name);
  return outcome && IsLost(*outcome);
}

std::string OthersText(const PartRates& part) {
  std::vector<std::string> others;
  for (const auto& [outcome, count] : part.outcomes) {
    if (!Succeeded(outcome)) others.push_back(fmt::format("{} {}", count, outcome));
  }
  return others.empty() ? "" : fmt::format("; {}", fmt::join(others, ", "));
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

// The plan as study_plan.cc wrote it.
StudyRates Gather(const std::string& folder, const Json& plan) {
  StudyRates rates;
  rates.folder = folder;
  rates.study = plan.at("study");
  rates.quick = plan.at("quick");
  rates.part = plan.contains("selection") && !plan.at("selection").is_null();
  rates.seed = plan.at("seed");
  const auto rows = ReadRows(folder);
  for (const Json& planned : plan.at("parts")) {
    const std::pair<std::string, std::string> of(planned.at("cell"), planned.at("method"));
    const auto flown = rows.find(of);
    PartRates part = flown == rows.end() ? PartRates() : RatesOf(flown->second);
    std::tie(part.cell, part.method) = of;
    part.cell_title = TitleOf(plan.at("cells"), part.cell);
    part.method_title = TitleOf(plan.at("methods"), part.method);
    part.planned = planned.at("trials");
    part.refusal = planned.value("refusal", "");
    rates.trials += part.trials;
    for (const auto& [outcome, count] : part.outcomes) rates.errors += IsError(outcome) ? count : 0;
    rates.parts.push_back(std::move(part));
  }
  return rates;
}

std::string PartText(const PartRates& part) {
  if (!part.refusal.empty()) return "not flown: " + part.refusal;
  const std::optional<double>& median = part.time_to_land_s.median;
  std::string text =
      part.trials == 0
          ? "none flown yet"
          : fmt::format("succeeded {} of {} [{:.1f}, {:.1f}] %{}{}", part.succeeded, part.trials,
                        100.0 * part.rate.lo, 100.0 * part.rate.hi,
                        median ? fmt::format(", median of the landed {:.1f} s", *median) : "",
                        OthersText(part));
  if (part.trials < part.planned) text += fmt::format("; {} planned", part.planned);
  return text;
}

}  // namespace

StudyRates ReadStudyRates(const std::string& folder) {
  const Json plan = ReadStudyPlan(folder);
  try {
    StudyRates rates = Gather(folder, plan);
    if (rates.trials > 0) return rates;
    throw BadInput(fmt::format("{}: the study holds no trial.", StudyTablePath(folder)));
  } catch (const nlohmann::json::exception& error) {
    throw BadInput(
        fmt::format("{}/study.json: it is not a study's plan ({}).", folder, error.what()));
  }
}

std::string StudyRatesText(const StudyRates& rates) {
  std::string text = rates.part ? "a part of study " + rates.study + "\n" : "";
  std::string cell;
  for (const PartRates& part : rates.parts) {
    if (part.cell != cell) text += part.cell_title + "\n";
    cell = part.cell;
    text += fmt::format("  {:<24} {}\n", part.method, PartText(part));
  }
  if (rates.errors > 0) {
    text += fmt::format("{} trials ended in an error of the program, crashed or hung (--retry)\n",
                        rates.errors);
  }
  return text;
}

Json StudyRatesJson(const StudyRates& rates) {
  Json json = {{"study", rates.study},   {"folder", rates.folder}, {"quick", rates.quick},
               {"part", rates.part},     {"seed", rates.seed},     {"trials", rates.trials},
               {"errors", rates.errors}, {"parts", Json::array()}};
  for (const PartRates& part : rates.parts) {
    json["parts"].push_back({{"cell", part.cell},
                             {"cell_title", part.cell_title},
                             {"method", part.method},
                             {"method_title", part.method_title},
                             {"planned", part.planned},
                             {"refusal", part.refusal.empty() ? Json() : Json(part.refusal)},
                             {"trials", part.trials},
                             {"succeeded", part.succeeded},
                             {"rate_lo", part.rate.lo},
                             {"rate_hi", part.rate.hi},
                             {"time_to_land_median_s", OrNull(part.time_to_land_s.median)},
                             {"touchdown_error_median_m", OrNull(part.touchdown_error_m.median)},
                             {"outcomes", part.outcomes}});
  }
  return json;
}

}  // namespace touchdown::evaluation
