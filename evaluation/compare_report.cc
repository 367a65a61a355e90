// SPDX-License-Identifier: BSD-3-Clause
// A comparison in words and in JSON. Times are thread CPU time to the gap.
#include "touchdown/evaluation/compare_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "touchdown/evaluation/build_info.h"
#include "touchdown/evaluation/compare_summary.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

const char* Arrival(const CompareOptions& options) {
  return options.cases.problem.arrival == planning::ArrivalMode::kFree ? "free" : "fixed";
}
const char* Limits(const CompareOptions& options) {
  return options.cases.problem.limits_mode == planning::LimitsMode::kHard ? "hard" : "soft";
}
const char* Endpoint(const CompareOptions& options) {
  return options.cases.problem.endpoint == planning::EndpointMode::kExplicit ? "explicit"
                                                                             : "eliminated";
}

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

std::string TableRow(const BackendSummary& s) {
  const std::string solved =
      s.problems == 0 ? "-"
                      : fmt::format("{} of {} [{:.1f}, {:.1f}] %", s.solved, s.problems,
                                    100.0 * s.solved_interval.lo, 100.0 * s.solved_interval.hi);
  return fmt::format("  {:<15}{:>27}{:>9}{:>9}{:>9}{:>9}{:>6}{:>6}{:>10}{:>10}{:>10}  {}\n",
                     s.backend, solved, Cell(s.cpu_ms.median, "{:.3f}"),
                     Cell(s.cpu_ms.p95, "{:.3f}"), Cell(s.cpu_ms.p99, "{:.3f}"),
                     Cell(s.cpu_ms.max, "{:.3f}"), Cell(s.iterations.median, "{:.0f}"),
                     Cell(s.evaluations.median, "{:.0f}"), Cell(s.tight_gap.median, "{:.1e}"),
                     Cell(s.tight_gap.p95, "{:.1e}"),
                     fmt::format("{}/{}", s.agreeing, s.reported_success), SharesText(s.shares));
}

std::string Table(const CompareResult& result, int points) {
  std::string text =
      fmt::format("  {:<15}{:>27}{:>9}{:>9}{:>9}{:>9}{:>6}{:>6}{:>10}{:>10}{:>10}  {}\n", "backend",
                  "solved, 95 % interval", "median", "p95", "p99", "max ms", "it", "eval",
                  "gap p50", "p95", "agree", "eval/whiten/native/adapter %");
  for (const BackendSummary& summary : Summarise(result, points)) text += TableRow(summary);
  return text;
}

std::string DeadlineTable(const CompareOptions& options, const CompareResult& result, int points) {
  std::string text = fmt::format(
      "  stopped after {:.4g} ms of wall time:\n  {:<15}{:>12}{:>10}{:>10}{:>12}{:>12}{:>16}\n",
      *options.deadline_ms, "backend", "back median", "p99", "max ms", "gap p50", "gap p95",
      "best returned");
  for (const BackendSummary& s : Summarise(result, points)) {
    if (!s.deadline) continue;
    const DeadlineSummary& d = *s.deadline;
    text +=
        fmt::format("  {:<15}{:>12}{:>10}{:>10}{:>12}{:>12}{:>16}\n", s.backend,
                    Cell(d.wall_ms.median, "{:.3f}"), Cell(d.wall_ms.p99, "{:.3f}"),
                    Cell(d.wall_ms.max, "{:.3f}"), Cell(d.gap.median, "{:.1e}"),
                    Cell(d.gap.p95, "{:.1e}"), fmt::format("{} of {}", d.best_returned, d.solves));
  }
  return text;
}

std::string ScalingTable(const CompareOptions& options, const CompareResult& result) {
  std::string text = "CPU time per iteration of the tight solves [ms], and its log-log slope\n  ";
  text += fmt::format("{:<15}", "points");
  for (const int points : options.points) text += fmt::format("{:>10}", points);
  text += fmt::format("{:>10}\n", "slope");
  for (std::size_t i = 0; i < result.backends.size(); ++i) {
    text += fmt::format("  {:<15}", result.backends[i]);
    for (const int points : options.points) {
      text += fmt::format("{:>10}", Cell(Summarise(result, points)[i].ms_per_iteration, "{:.4f}"));
    }
    text += fmt::format("{:>10}\n", Cell(ScalingSlope(result, result.backends[i]), "{:.2f}"));
  }
  return text;
}

// Figures of the problems, so that a reader knows what was solved.
std::string ProblemsText(const CompareOptions& options, const CompareResult& result, int points) {
  std::vector<double> pairs, durations;
  int redrawn = 0;
  int not_clear = 0;
  int unsolved = 0;
  int kept = 0;
  int without = 0;
  for (const ProblemRow& row : result.problems) {
    if (row.points != points) continue;
    pairs.push_back(static_cast<double>(row.made.pairs.size()));
    durations.push_back(row.made.duration);
    redrawn += row.made.draws - 1;
    not_clear += row.made.not_clear;
    unsolved += row.made.unsolved;
    kept += !row.made.clear;
    without += !std::isfinite(row.reference_cost);
  }
  std::string text = fmt::format(
      "{} points, {} arrival, {} limits, {} endpoint, {} start: {} problems in forest {}, seed {}\n"
      "  in the median T {:.2f} s and {:.0f} pairs\n"
      "  {} scenes drawn again: {} not clear within the limits, {} where a solve for the pairs "
      "failed, {} out of reach\n",
      points, Arrival(options), Limits(options), Endpoint(options),
      options.cases.warm ? "warm" : "cold", pairs.size(), options.cases.forest, options.cases.seed,
      Quantile(durations, 0.5).value_or(0.0), Quantile(pairs, 0.5).value_or(0.0), redrawn,
      not_clear, unsolved, redrawn - not_clear - unsolved);
  if (kept > 0) {
    text += fmt::format("  {} problems not clear with this many points: pairs of the last round\n",
                        kept);
  }
  if (without > 0) {
    text +=
        fmt::format("  {} problems without a feasible point from any backend, left out\n", without);
  }
  return text;
}

Json SummaryJson(const BackendSummary& s) {
  Json json;
  json["problems"] = s.problems;
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
  json["endpoint_residual"] = {{"position_m_max", s.end_position_max},
                               {"velocity_mps_max", s.end_velocity_max}};
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

/// What the problems of one size were drawn from.
Json ScenesJson(const CompareResult& result, int points) {
  int drawn = 0, not_clear = 0, unsolved = 0, clear = 0;
  for (const ProblemRow& row : result.problems) {
    if (row.points != points) continue;
    drawn += row.made.draws;
    not_clear += row.made.not_clear;
    unsolved += row.made.unsolved;
    clear += row.made.clear ? 1 : 0;
  }
  return {{"drawn", drawn}, {"not_clear", not_clear}, {"unsolved", unsolved}, {"clear", clear}};
}

// Only backends that ran all problems: figures over different problems are not to be compared.
Json PooledJson(const CompareResult& result) {
  Json json = Json::object();
  const int all = RatedProblems(result, 0);
  for (const BackendSummary& summary : Summarise(result, 0)) {
    if (summary.problems == all) json[summary.backend] = SummaryJson(summary);
  }
  return json;
}

Json BackendsJson(const CompareResult& result, int points) {
  Json json = Json::object();
  for (const BackendSummary& summary : Summarise(result, points)) {
    json[summary.backend] = SummaryJson(summary);
  }
  return json;
}

}  // namespace

std::string CompareText(const CompareOptions& options, const CompareResult& result) {
  std::string text = fmt::format(
      "Thread CPU time to within {:.0e} of the best known cost, feasible; judged outside the "
      "solvers\n{}\n",
      options.gap, BuildLine());
  for (const int points : options.points) {
    text += ProblemsText(options, result, points) + Table(result, points);
    if (options.deadline_ms) text += DeadlineTable(options, result, points);
  }
  if (options.points.size() > 1) text += ScalingTable(options, result);
  for (const Refusal& refusal : result.refusals) {
    text += options.points.size() > 1
                ? fmt::format("{} points: {}\n", refusal.points, refusal.reason)
                : refusal.reason + "\n";
  }
  return text;
}

Json CompareSettings(const CompareOptions& options) {
  const planning::LandingProblemOptions& problem = options.cases.problem;
  Json terms = Json::object();
  for (const planning::TermSettings& settings : problem.settings) {
    Json& term = terms[settings.name];
    if (settings.weight) term["weight"] = *settings.weight;
    if (settings.hard) term["hard"] = *settings.hard;
    for (const auto& [key, value] : settings.parameters) term[key] = value;
  }
  return {{"seed", options.cases.seed},
          {"points", options.points},
          {"start", options.cases.warm ? "warm" : "cold"},
          {"arrival", Arrival(options)},
          {"limits", Limits(options)},
          {"endpoint", Endpoint(options)},
          {"gap", options.gap},
          {"repeats", options.repeats},
          {"deadline_ms", options.deadline_ms ? Json(*options.deadline_ms) : Json()},
          {"forest", options.cases.forest},
          {"inflation_m", options.cases.inflation},
          {"speed_limit_mps", problem.limits.speed},
          {"acceleration_limit_mps2", problem.limits.acceleration},
          {"terms", terms},
          {"backend_seconds", options.backend_seconds}};
}

Json CompareJson(const CompareOptions& options, const CompareResult& result,
                 const MachineState& machine) {
  Json json;
  json["problems"] = options.problems;
  json["settings"] = CompareSettings(options);
  json["backends"] = PooledJson(result);
  json["by_points"] = Json::object();
  for (const int points : options.points) {
    json["by_points"][std::to_string(points)] = BackendsJson(result, points);
    json["scenes"][std::to_string(points)] = ScenesJson(result, points);
  }
  json["scaling_slope"] = Json::object();
  for (const std::string& backend : result.backends) {
    json["scaling_slope"][backend] = Finite(ScalingSlope(result, backend));
  }
  json["refused"] = Json::array();
  for (const Refusal& refusal : result.refusals) {
    json["refused"].push_back(
        {{"points", refusal.points}, {"backend", refusal.backend}, {"reason", refusal.reason}});
  }
  json["machine"] = {{"pinned_cpu", machine.pinned ? Json(*machine.pinned) : Json()},
                     {"load_before", Finite(machine.load_before)},
                     {"load_after", Finite(machine.load_after)}};
  return json;
}

}  // namespace touchdown::evaluation
