// SPDX-License-Identifier: BSD-3-Clause
// A sweep in words and in JSON. Every rate comes with its 95 % Clopper-Pearson interval; figures at
// touchdown are over the landed trials, and the number of those stands beside them.
#include "evaluation/campaign/sweep_report.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "evaluation/base/statistics.h"
#include "evaluation/campaign/sweep_cells.h"
#include "evaluation/record/trial_json.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// A figure of a trial, if it has one, for a summary over trials.
struct Figure {
  const char* key;
  const char* label;
  const char* unit;
  std::optional<double> (*of)(const TrialResult&);
};

template <class Value>
std::optional<double> AtTouchdown(const TrialResult& r, Value value) {
  if (!r.landed()) return std::nullopt;
  return value(*r.touchdown);
}

std::optional<double> Gap(const TrialResult& r) {
  if (!r.t_star_s || !r.t_star_upper_s) return std::nullopt;
  return *r.t_star_upper_s / *r.t_star_s - 1.0;
}

// Figures at touchdown are of the landed trials, those of following of the ones that followed.
const Figure kFigures[] = {
    {"time_to_land_s", "time to land", "s",
     [](const TrialResult& r) { return AtTouchdown(r, [](const Touchdown& d) { return d.t; }); }},
    {"touchdown_error_m", "touchdown error", "m",
     [](const TrialResult& r) {
       return AtTouchdown(r, [](const Touchdown& d) { return d.error_m; });
     }},
    {"relative_speed_mps", "relative speed at contact", "m/s",
     [](const TrialResult& r) {
       return AtTouchdown(r, [](const Touchdown& d) { return d.relative_velocity.norm(); });
     }},
    {"relative_horizontal_mps", "  horizontal", "m/s",
     [](const TrialResult& r) {
       return AtTouchdown(r,
                          [](const Touchdown& d) { return d.relative_velocity.head<2>().norm(); });
     }},
    {"relative_vertical_mps", "  vertical, downwards", "m/s",
     [](const TrialResult& r) {
       return AtTouchdown(r, [](const Touchdown& d) { return -d.relative_velocity.z(); });
     }},
    {"tilt_over_equilibrium_deg", "tilt over equilibrium", "deg",
     [](const TrialResult& r) {
       return AtTouchdown(
           r, [](const Touchdown& d) { return d.tilt_over_equilibrium * estimation::kDegPerRad; });
     }},
    {"min_clearance_m", "least true clearance", "m",
     [](const TrialResult& r) { return r.min_clearance_m; }},
    {"estimator_nees_position", "pad NEES (2 expected)", "",
     [](const TrialResult& r) {
       return r.estimator ? std::optional(r.estimator->nees_position_mean) : std::nullopt;
     }},
    {"own_rmse_position_m", "own position error, RMS", "m",
     [](const TrialResult& r) {
       return r.own_state ? std::optional(r.own_state->rmse_position_m) : std::nullopt;
     }},
    {"time_to_done_s", "time until it was done", "s",
     [](const TrialResult& r) {
       return r.succeeded() && !r.landed() ? std::optional(r.simulated_s) : std::nullopt;
     }},
    {"following_error_m", "following error, last 10 s", "m",
     [](const TrialResult& r) {
       return r.following && r.succeeded() ? std::optional(r.following->mean_error_m)
                                           : std::nullopt;
     }},
    {"following_speed_mps", "relative speed, last 10 s", "m/s",
     [](const TrialResult& r) {
       return r.following && r.succeeded() ? std::optional(r.following->relative_speed_mps)
                                           : std::nullopt;
     }},
    {"t_star_s", "T*, bound on time to land", "s", [](const TrialResult& r) { return r.t_star_s; }},
    {"t_star_gap", "T*, upper bound over lower - 1", "", Gap},
    {"time_ratio", "time to land over T*", "", [](const TrialResult& r) { return r.time_ratio(); }},
};

struct Column {
  const char* key;
  const char* label;
  const char* unit;
  std::vector<double> values;
};

std::vector<Column> Columns(const std::vector<SweepRow>& rows) {
  std::vector<Column> columns;
  for (const Figure& figure : kFigures) {
    Column& column = columns.emplace_back(Column{figure.key, figure.label, figure.unit, {}});
    for (const SweepRow& row : rows) {
      if (const std::optional<double> value = figure.of(row.result))
        column.values.push_back(*value);
    }
  }
  // Only some styles have them.
  Column x{"mean_abs_error_x_m", "mean |error| x, last 5 s", "m", {}};
  Column y{"mean_abs_error_y_m", "mean |error| y, last 5 s", "m", {}};
  for (const SweepRow& row : rows) {
    const auto last = LastErrors(row.trial.scenario, row.result);
    if (!last) continue;
    x.values.push_back(last->x());
    y.values.push_back(last->y());
  }
  columns.push_back(std::move(x));
  columns.push_back(std::move(y));
  return columns;
}

int Count(const std::vector<SweepRow>& rows, bool (TrialResult::*holds)() const) {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(),
                                        [&](const SweepRow& r) { return (r.result.*holds)(); }));
}

/// What success is called: the task may differ from trial to trial.
const char* SuccessWord(const std::vector<SweepRow>& rows) {
  const auto all = [&](TaskKind task) {
    return std::all_of(rows.begin(), rows.end(),
                       [&](const SweepRow& r) { return r.trial.scenario.task == task; });
  };
  if (all(TaskKind::kLand)) return "landed";
  if (all(TaskKind::kGoTo)) return "arrived";
  return all(TaskKind::kFollow) ? "followed" : "done";
}

std::vector<double> ReplanTimes(const std::vector<SweepRow>& rows) {
  std::vector<double> times;
  for (const SweepRow& row : rows) {
    const std::vector<double>& of_trial = row.result.timing.replan_wall_ms;
    times.insert(times.end(), of_trial.begin(), of_trial.end());
  }
  return times;
}

Json TrialJson(const SweepRow& row) {
  Json json = LandJson(row.trial.scenario, row.result);
  json.erase("wall_clock");
  json["trial"] = row.trial.index;
  json["replay"] = row.trial.Replay();
  json["varied"] = Json::object();
  for (const auto& [key, value] : row.trial.varied) json["varied"][key] = value;
  return json;
}

struct FlownCell {
  std::vector<std::pair<std::string, std::string>> values;
  CellFigures figures;
};

// Listed values have a rate each, because a rate over all of them means nothing.
std::vector<FlownCell> FlownCells(const Campaign& campaign, const std::vector<SweepRow>& rows) {
  const CellPlan plan = PlanCells(campaign);
  std::vector<CellTally> tallies(plan.cells.size());
  for (const SweepRow& row : rows) {
    const int cell = plan.cell_of.at(static_cast<std::size_t>(row.trial.index));
    tallies.at(static_cast<std::size_t>(cell)).Add(row.result);
  }
  std::vector<FlownCell> cells;
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    cells.push_back({plan.cells[i].values, tallies[i].Figures()});
  }
  return cells;
}

std::string CellsText(const std::vector<FlownCell>& cells) {
  std::string text;
  for (const FlownCell& cell : cells) {
    std::vector<std::string> values;
    for (const auto& [key, value] : cell.values) values.push_back(key + "=" + value);
    const CellFigures& f = cell.figures;
    text += fmt::format("  {:<40} {} of {}", fmt::format("{}", fmt::join(values, " ")), f.succeeded,
                        f.trials);
    if (f.rate) text += fmt::format(" [{:.1f}, {:.1f}] %", 100.0 * f.rate->lo, 100.0 * f.rate->hi);
    if (f.time_to_land_median_s) {
      text += fmt::format(", medians of the landed {:.2f} s, {:.3f} m", *f.time_to_land_median_s,
                          *f.touchdown_error_median_m);
    }
    text += "\n";
  }
  return text;
}

Json CellsJson(const std::vector<FlownCell>& cells) {
  Json json = Json::array();
  for (const FlownCell& cell : cells) {
    const CellFigures& f = cell.figures;
    Json& entry = json.emplace_back();
    for (const auto& [key, value] : cell.values) entry["values"][key] = value;
    entry["trials"] = f.trials;
    entry["succeeded"] = f.succeeded;
    entry["interval_95"] = f.rate ? Json({f.rate->lo, f.rate->hi}) : Json();
    entry["time_to_land_median_s"] =
        f.time_to_land_median_s ? Json(*f.time_to_land_median_s) : Json();
    entry["touchdown_error_median_m"] =
        f.touchdown_error_median_m ? Json(*f.touchdown_error_median_m) : Json();
  }
  return json;
}

}  // namespace

std::string SweepText(const Campaign& campaign, const std::vector<SweepRow>& rows) {
  const int n = static_cast<int>(rows.size());
  const int k = Count(rows, &TrialResult::succeeded);
  const Interval interval = ClopperPearson(k, n);
  const std::vector<FlownCell> cells = FlownCells(campaign, rows);
  const std::string rate = cells.size() > 1
                               ? "95 % Clopper-Pearson of each value"
                               : fmt::format("95 % Clopper-Pearson [{:.1f} %, {:.1f} %]",
                                             100.0 * interval.lo, 100.0 * interval.hi);
  std::string text =
      fmt::format("{}: {} of {} {}, {}, sweep seed {}\n", rows.front().trial.scenario.name, k, n,
                  SuccessWord(rows), rate, campaign.seed);
  if (cells.size() > 1) text += CellsText(cells);
  text += fmt::format("  {:<33}{:>10}{:>10}{:>10}{:>10}{:>6}\n", "", "median", "p95", "min", "max",
                      "n");
  for (const Column& column : Columns(rows)) {
    if (column.values.empty()) continue;
    const std::string label =
        column.unit[0] == '\0' ? column.label : fmt::format("{} [{}]", column.label, column.unit);
    text += fmt::format("  {:<33}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>6}\n", label,
                        *Quantile(column.values, 0.5), *Quantile(column.values, 0.95),
                        *Quantile(column.values, 0.0), *Quantile(column.values, 1.0),
                        column.values.size());
  }
  text +=
      fmt::format("  n: trials that have the figure; p95: of 95 % of them it is no larger{}\n",
                  std::any_of(rows.begin(), rows.end(),
                              [](const SweepRow& row) { return row.result.t_star_s.has_value(); })
                      ? "; T*: no flight within the limits makes contact earlier (docs/t_star.md)"
                      : "");
  const auto without = std::count_if(rows.begin(), rows.end(), [](const SweepRow& row) {
    return row.result.landed() && row.result.t_star_s && !row.result.time_ratio();
  });
  if (without > 0) {
    text += fmt::format(
        "  {} landed without a ratio to T*: they once exceeded a limit that T* keeps to\n",
        without);
  }
  std::map<std::string, std::vector<const SweepRow*>> failures;
  for (const SweepRow& row : rows) {
    if (!row.result.succeeded()) failures[ToString(row.result.outcome)].push_back(&row);
  }
  for (const auto& [outcome, failed] : failures) {
    text += fmt::format("  {} x {}: {}\n", failed.size(), outcome,
                        Explain(failed.front()->result.outcome));
    for (const SweepRow* row : failed) {
      text += fmt::format("    trial {} at {:.2f} s. {}\n      {}\n", row->trial.index,
                          row->result.simulated_s, row->result.detail, row->trial.Replay());
    }
  }
  if (!failures.empty()) {
    text +=
        "  each command flies that trial alone; with --plot F.png it is drawn, with --record F.db "
        "every step is kept\n";
  } else {
    const SweepTrial& first = rows.front().trial;
    text += fmt::format("  trial {} again, alone:\n      {}\n", first.index, first.Replay());
  }
  return text;
}

Json SweepJson(const Campaign& campaign, const std::vector<SweepRow>& rows) {
  const int n = static_cast<int>(rows.size());
  const int k = Count(rows, &TrialResult::landed);
  const Interval interval = ClopperPearson(k, n);
  Json json;
  json["scenario"] = rows.front().trial.scenario.name;
  json["seed"] = campaign.seed;
  json["trials"] = n;
  json["landed"] = k;
  json["landed_fraction"] = static_cast<double>(k) / n;
  const std::vector<FlownCell> cells = FlownCells(campaign, rows);
  json["landed_interval_95"] = cells.size() > 1 ? Json() : Json({interval.lo, interval.hi});
  json["cells"] = CellsJson(cells);
  json["succeeded"] = Count(rows, &TrialResult::succeeded);
  Json summary = Json::object();
  for (const Column& column : Columns(rows)) {
    summary[column.key] = QuantilesJson(column.values);
    summary[column.key]["n"] = column.values.size();
  }
  json["summary"] = summary;
  Json outcomes = Json::object();
  for (const SweepRow& row : rows) {
    Json& count = outcomes[ToString(row.result.outcome)];
    count = count.is_null() ? 1 : count.get<int>() + 1;
  }
  json["outcomes"] = outcomes;
  json["results"] = Json::array();
  double wall = 0.0;
  double simulated = 0.0;
  int misses = 0;
  for (const SweepRow& row : rows) {
    json["results"].push_back(TrialJson(row));
    wall += row.result.timing.wall_s;
    simulated += row.result.timing.simulated_s;
    misses += row.result.timing.deadline_misses;
  }
  json["wall_clock"] = {{"replan_latency_ms", QuantilesJson(ReplanTimes(rows))},
                        {"deadline_misses", misses},
                        {"realtime_factor", wall > 0.0 ? Json(simulated / wall) : Json()}};
  return json;
}

}  // namespace touchdown::evaluation
