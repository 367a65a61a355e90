// SPDX-License-Identifier: BSD-3-Clause
// A comparison in words and in JSON. Times are thread CPU time to the gap.
#include "evaluation/compare/compare_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/build_info.h"
#include "evaluation/compare/compare_summary.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

std::string Cell(const std::optional<double>& value, const char* format) {
  if (!value) return "-";
  if (!std::isfinite(*value)) return "fail";
  return fmt::format(fmt::runtime(format), *value);
}

Json Finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json QuantilesOrNull(const Quantiles& q) {
  return {{"median", Finite(q.median)},
          {"p95", Finite(q.p95)},
          {"p99", Finite(q.p99)},
          {"max", Finite(q.max)}};
}

std::string SharesText(const std::optional<ShareSummary>& shares) {
  if (!shares) return "-";
  return fmt::format("{:.0f}/{:.0f}/{:.0f}/{:.0f}", 100.0 * shares->evaluation,
                     100.0 * shares->whitening, 100.0 * shares->native, 100.0 * shares->adapter);
}

// Times over some of the problems are not comparable with times over all.
std::string TableRow(const BackendSummary& s, int all, bool interval) {
  std::string solved = SolvedText(s, all);
  if (!s.ran_all) {
    return fmt::format("  {:<15}{:>27}{:>9}{:>9}{:>9}{:>9}\n", s.backend, solved, "-", "-", "-",
                       "-");
  }
  if (interval && all > 0) {
    solved += fmt::format(" [{:.1f}, {:.1f}] %", 100.0 * s.solved_interval.lo,
                          100.0 * s.solved_interval.hi);
  }
  return fmt::format("  {:<15}{:>27}{:>9}{:>9}{:>9}{:>9}{:>6}{:>6}{:>10}{:>10}{:>10}  {}\n",
                     s.backend, solved, Cell(s.cpu_ms.median, "{:.3f}"),
                     Cell(s.cpu_ms.p95, "{:.3f}"), Cell(s.cpu_ms.p99, "{:.3f}"),
                     Cell(s.cpu_ms.max, "{:.3f}"), Cell(s.iterations.median, "{:.0f}"),
                     Cell(s.evaluations.median, "{:.0f}"), Cell(s.tight_gap.median, "{:.1e}"),
                     Cell(s.tight_gap.p95, "{:.1e}"),
                     fmt::format("{}/{}", s.agreeing, s.reported_success), SharesText(s.shares));
}

constexpr char kTableLegend[] =
    "  reached: feasible and within the gap; iter, eval: medians of iterations and evaluations "
    "until "
    "then; tight solves: to 1e-10, with their\n"
    "  gap to the best known cost; agree: within 1e-4 of it, of those that say they converged; "
    "eval/whiten/native/adapter: evaluation of terms,\n"
    "  whitening, the solver library, what is between; docs/compare.md\n";

std::string Table(const std::vector<BackendSummary>& summaries, int all, bool interval) {
  std::string text = fmt::format("  {:<42}{:>36}{:>12}{:>30}  {}\n", "", "time to the gap [ms]", "",
                                 "tight solves", "wall time of the solves to the gap");
  text +=
      fmt::format("  {:<15}{:>27}{:>9}{:>9}{:>9}{:>9}{:>6}{:>6}{:>10}{:>10}{:>10}  {}\n", "backend",
                  interval ? "reached, 95 % interval" : "reached", "median", "p95", "p99", "max",
                  "iter", "eval", "gap p50", "p95", "agree", "eval/whiten/native/adapter %");
  for (const BackendSummary& summary : summaries) text += TableRow(summary, all, interval);
  return text + kTableLegend;
}

std::string DeadlineTable(double deadline_ms, const std::vector<BackendSummary>& summaries) {
  std::string text = fmt::format(
      "  stopped after {:.4g} ms of wall time:\n  {:<15}{:>12}{:>10}{:>10}{:>12}{:>12}{:>16}\n",
      deadline_ms, "backend", "back median", "p99", "max ms", "gap p50", "gap p95",
      "best returned");
  for (const BackendSummary& s : summaries) {
    if (!s.deadline || !s.ran_all) continue;
    const DeadlineSummary& d = *s.deadline;
    text +=
        fmt::format("  {:<15}{:>12}{:>10}{:>10}{:>12}{:>12}{:>16}\n", s.backend,
                    Cell(d.wall_ms.median, "{:.3f}"), Cell(d.wall_ms.p99, "{:.3f}"),
                    Cell(d.wall_ms.max, "{:.3f}"), Cell(d.gap.median, "{:.1e}"),
                    Cell(d.gap.p95, "{:.1e}"), fmt::format("{} of {}", d.best_returned, d.solves));
  }
  return text +
         "  back: when the backend returned; gap: of what it returned; best returned: no feasible "
         "point that it evaluated was better\n";
}

/// The solved problems in figures.
struct ProblemsSummary {
  int all = 0;
  int free_arrival = 0, hard_limits = 0, explicit_endpoint = 0;
  int with_pairs = 0;       ///< bound to free space
  int standing = 0;         ///< the start is within the gap
  int without = 0;          ///< a reference
  Quantiles points, pairs;  ///< pairs: of those that have any
  Quantiles duration_s;
};

std::string FlightsText(const CompareResult& result) {
  const std::size_t flown = result.flights.size();
  return result.flights_there && *result.flights_there > static_cast<int>(flown)
             ? fmt::format("the first {} of {} flights", flown, *result.flights_there)
             : fmt::format("{} flights", flown);
}

// One word, unless the flights differ.
std::string Kinds(const char* one, int of_one, const char* other, int of_other) {
  if (of_other == 0) return one;
  return of_one == 0 ? other : fmt::format("{} {}, {} {}", one, of_one, other, of_other);
}

ProblemsSummary Of(const std::vector<ProblemRow>& problems) {
  ProblemsSummary of;
  std::vector<double> points, pairs, durations;
  for (const ProblemRow& row : problems) {
    ++of.all;
    of.free_arrival += row.free_arrival;
    of.hard_limits += row.hard_limits;
    of.explicit_endpoint += row.explicit_endpoint;
    of.with_pairs += row.pairs > 0;
    of.standing += row.standing;
    of.without += !std::isfinite(row.reference_cost);
    points.push_back(row.points);
    durations.push_back(row.duration_s);
    if (row.pairs > 0) pairs.push_back(row.pairs);
  }
  of.points = QuantilesOf(points);
  of.pairs = QuantilesOf(pairs);
  of.duration_s = QuantilesOf(durations);
  return of;
}

}  // namespace

std::string SolvedText(const BackendSummary& s, int all) {
  return s.ran_all ? fmt::format("{} of {}", s.solved, all)
                   : fmt::format("{} of {} run, of {}", s.solved, s.problems, all);
}

std::string CompareProblemsText(const CompareResult& result) {
  const ProblemsSummary of = Of(result.problems);
  const bool one = result.flights.size() == 1;
  std::string text = fmt::format(
      "{} problems as {} posed them, {} of {} solves{}\n"
      "  arrival: free {}, fixed {}; limits: {}; end: {}; in the median {:.0f} control points, "
      "T {:.2f} s; with pairs {}, {:.0f} in the median\n",
      of.all, one ? result.flights.front() : FlightsText(result),
      result.every == 1 ? "all" : fmt::format("one in {}", result.every), result.asked,
      one ? "" : fmt::format(" (from `{}` on)", result.flights.front()), of.free_arrival,
      of.all - of.free_arrival, Kinds("soft", of.all - of.hard_limits, "hard", of.hard_limits),
      Kinds("eliminated", of.all - of.explicit_endpoint, "explicit", of.explicit_endpoint),
      of.points.median.value_or(0.0), of.duration_s.median.value_or(0.0), of.with_pairs,
      of.pairs.median.value_or(0.0));
  if (of.standing > 0) {
    text += fmt::format("  {} not timed: their start is within the gap already\n", of.standing);
  }
  if (result.refused > 0) {
    text += fmt::format("  {} more that none of these backends takes\n", result.refused);
  }
  for (const std::string& note : result.notes) text += fmt::format("  {}\n", note);
  if (of.without > 0) {
    text += fmt::format("  {} without a feasible point from any backend, left out\n", of.without);
  }
  return text;
}

Json BackendSummaryJson(const BackendSummary& s) {
  Json json;
  json["problems"] = s.problems;
  json["ran_all"] = s.ran_all;
  json["solved"] = s.solved;
  json["solved_fraction"] =
      s.problems > 0 ? Json(static_cast<double>(s.solved) / s.problems) : Json();
  json["solved_interval_95"] = {s.solved_interval.lo, s.solved_interval.hi};
  json["time_ms"] = QuantilesOrNull(s.cpu_ms);
  json["wall_time_ms"] = QuantilesOrNull(s.wall_ms);
  json["iterations"] = QuantilesOrNull(s.iterations);
  json["evaluations"] = QuantilesOrNull(s.evaluations);
  json["cost_gap"] = QuantilesOrNull(s.tight_gap);
  json["tight_time_ms"] = QuantilesOrNull(s.tight_cpu_ms);
  json["reported_success"] = s.reported_success;
  json["reported_success_within_1e-4"] = s.agreeing;
  json["max_violation"] = s.violation_max;
  json["ms_per_iteration"] = Finite(s.ms_per_iteration);
  if (s.shares) {
    json["shares"] = {{"evaluation", s.shares->evaluation},
                      {"whitening", s.shares->whitening},
                      {"native", s.shares->native},
                      {"adapter", s.shares->adapter}};
  }
  if (s.deadline) {
    json["deadline"] = {{"return_ms", QuantilesOrNull(s.deadline->wall_ms)},
                        {"cost_gap", QuantilesOrNull(s.deadline->gap)},
                        {"solves", s.deadline->solves},
                        {"best_returned", s.deadline->best_returned}};
  }
  return json;
}

Json CompareProblemsJson(const CompareResult& result) {
  const ProblemsSummary of = Of(result.problems);
  return {{"all", of.all},
          {"timed", TimedProblems(result)},
          {"standing", of.standing},
          {"without_reference", of.without},
          {"free_arrival", of.free_arrival},
          {"hard_limits", of.hard_limits},
          {"explicit_endpoint", of.explicit_endpoint},
          {"with_pairs", of.with_pairs},
          {"points", QuantilesOrNull(of.points)},
          {"pairs", QuantilesOrNull(of.pairs)},
          {"duration_s", QuantilesOrNull(of.duration_s)},
          {"solves_asked", result.asked},
          {"every", result.every},
          {"refused_by_all", result.refused},
          {"notes", result.notes},
          {"flights", result.flights}};
}

Json RefusalsJson(const std::vector<Refusal>& refusals) {
  Json json = Json::array();
  for (const Refusal& refusal : refusals) {
    json.push_back({{"backend", refusal.backend}, {"reason", refusal.reason}});
  }
  return json;
}

namespace {

// Figures over other problems are not to be compared.
Json BackendsJson(const CompareResult& result) {
  Json json = Json::object();
  for (const BackendSummary& summary : Summarise(result)) {
    Json& backend = json[summary.backend] = BackendSummaryJson(summary);
    Json& by_points = backend["ms_per_iteration_by_points"] = Json::object();
    for (const auto& [points, ms] : TimePerIteration(result, summary.backend)) {
      by_points[std::to_string(points)] = ms;
    }
  }
  return json;
}

}  // namespace

std::string CompareText(const CompareOptions& options, const CompareResult& result) {
  std::string text = fmt::format(
      "Thread CPU time to within {:.0e} of the best known cost, feasible; judged outside the "
      "solvers. Medians "
      "at another gap are over other problems\n{}\n",
      options.bench.gap, BuildLine());
  const std::vector<BackendSummary> summaries = Summarise(result);
  text += CompareProblemsText(result) +
          Table(summaries, TimedProblems(result), result.flights.size() > 1);
  if (options.bench.deadline_ms) text += DeadlineTable(*options.bench.deadline_ms, summaries);
  for (const Refusal& refusal : result.refusals) text += refusal.reason + "\n";
  return text;
}

Json CompareSettings(const CompareOptions& options) {
  const BenchOptions& bench = options.bench;
  return {{"from", options.from},
          {"seed", options.seed},
          {"set", options.set},
          {"gap", bench.gap},
          {"repeats", bench.repeats},
          {"deadline_ms", bench.deadline_ms ? Json(*bench.deadline_ms) : Json()},
          {"backend_seconds", bench.backend_seconds}};
}

Json CompareJson(const CompareOptions& options, const CompareResult& result,
                 const MachineState& machine) {
  Json json;
  json["problems"] = CompareProblemsJson(result);
  json["settings"] = CompareSettings(options);
  json["backends"] = BackendsJson(result);
  json["refused"] = RefusalsJson(result.refusals);
  json["machine"] = MachineJson(machine);
  for (const auto& [key, value] : BuildManifest()) json["build"][key] = value;
  return json;
}

}  // namespace touchdown::evaluation
