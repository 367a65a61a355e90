// SPDX-License-Identifier: BSD-3-Clause
// A profile in words and in JSON. Times are thread CPU time, wall time beside.
#include "evaluation/profile/profile_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/build_info.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json MillisecondsJson(const Quantiles& q) {
  return {{"median_ms", OrNull(q.median)},
          {"p95_ms", OrNull(q.p95)},
          {"p99_ms", OrNull(q.p99)},
          {"max_ms", OrNull(q.max)}};
}

std::string Cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string Row(const StageSummary& s) {
  const Quantiles& cpu = s.cpu_ms;
  const Quantiles& wall = s.wall_ms;
  return fmt::format("  {:<12}{:>8}{:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}   {:>7}{:>8}\n",
                     s.stage, s.used, Cell(cpu.median, 3), Cell(cpu.p95, 3), Cell(cpu.p99, 3),
                     Cell(cpu.max, 3), Cell(wall.median, 3), Cell(wall.p95, 3), Cell(wall.p99, 3),
                     Cell(wall.max, 3), Cell(s.allocations.median, 0), Cell(s.allocations.max, 0));
}

std::string Source(const Profile& profile) {
  if (!profile.record.empty()) {
    return fmt::format("replayed from {}, {} passes", profile.record, profile.runs.size());
  }
  const std::uint64_t seed = profile.runs.front().seed;
  if (profile.runs.size() == 1) {
    return fmt::format("flown with seed {} ({})", seed, profile.runs.front().outcome);
  }
  int landed = 0;
  for (const ProfileRun& run : profile.runs) landed += run.outcome == "landed";
  return fmt::format("flown with seeds {} to {} ({} of {} landed)", seed, profile.runs.back().seed,
                     landed, profile.runs.size());
}

// What one looks at next.
std::string SlowestText(const Profile& profile, const ProfileSummary& summary) {
  if (summary.slowest.empty()) return {};
  const bool several = profile.record.empty() && profile.runs.size() > 1;
  std::vector<std::string> steps;
  for (const ProfileSummary::SlowStep& slow : summary.slowest) {
    steps.push_back(fmt::format("{}{} ({:.2f} ms, {} solves)", slow.step,
                                several ? fmt::format(" with seed {}", slow.seed) : "", slow.cpu_ms,
                                slow.solves));
  }
  std::string text = fmt::format("  slowest steps: {}\n", fmt::join(steps, ", "));
  if (!profile.record.empty()) {
    text += fmt::format("    touchdown plan --from {}:{}\n", profile.record,
                        summary.slowest.front().step);
  }
  return text;
}

Json StageJson(const StageSummary& s) {
  Json json = MillisecondsJson(s.cpu_ms);
  json["wall"] = MillisecondsJson(s.wall_ms);
  json["samples"] = s.samples;
  json["used"] = s.used;
  json["allocations"] = {{"median", OrNull(s.allocations.median)},
                         {"max", OrNull(s.allocations.max)}};
  return json;
}

}  // namespace

std::string ProfileText(const Profile& profile) {
  const ProfileSummary summary = Summarise(profile);
  std::string text =
      fmt::format("{}, planner {}, backend {}: {}\n", profile.scenario.name,
                  profile.scenario.planner, profile.scenario.solver_name(), Source(profile));
  text += fmt::format("  {}\n", BuildLine());
  text += fmt::format("  {:<12}{:>8}{:>36}   {:>36}   {:>15}\n", "", "", "thread CPU time [ms]",
                      "wall time [ms]", "allocations");
  text += fmt::format("  {:<12}{:>8}{:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}   {:>7}{:>8}\n",
                      "stage", "used in", "median", "p95", "p99", "max", "median", "p95", "p99",
                      "max", "median", "max");
  for (const StageSummary& stage : summary.stages) text += Row(stage);
  text += Row(summary.total);
  text +=
      "  used in: steps, or images for sense and map, that spent time in the stage, the others "
      "count "
      "as 0; total: a whole step, without sense\n"
      "  and map; allocations: of heap memory; docs/profile.md\n";
  const int steps = summary.total.samples;
  text += fmt::format("  {} of {} replanning steps took longer than {:g} ms of wall time\n",
                      summary.deadline_misses, steps, profile.deadline_ms);
  text += SlowestText(profile, summary);
  if (!profile.allocations_counted) {
    text += "  allocations are not counted; docs/profile.md says how\n";
  }
  if (profile.compared > 0) {
    text += fmt::format("  {} of {} answers are the recorded ones bit for bit\n", profile.same,
                        profile.compared);
  }
  if (profile.spans.dropped() > 0) {
    text += fmt::format("  {} spans did not fit into the trace\n", profile.spans.dropped());
  }
  return text;
}

Json ProfileJson(const Profile& profile, const MachineState& machine) {
  const ProfileSummary summary = Summarise(profile);
  Json json;
  json["scenario"] = profile.scenario.name;
  json["planner"] = profile.scenario.planner;
  json["backend"] = profile.scenario.solver_name();
  json["record"] = profile.record.empty() ? Json() : Json(profile.record);
  Json seeds = Json::array();
  for (const ProfileRun& run : profile.runs) seeds.push_back(run.seed);
  json["seeds"] = seeds;
  json["replans"] = summary.total.samples;
  json["stages"] = Json::object();
  for (const StageSummary& stage : summary.stages) json["stages"][stage.stage] = StageJson(stage);
  json["total"] = StageJson(summary.total);
  json["slowest"] = Json::array();
  for (const ProfileSummary::SlowStep& slow : summary.slowest) {
    json["slowest"].push_back({{"step", slow.step},
                               {"seed", slow.seed},
                               {"cpu_ms", slow.cpu_ms},
                               {"solves", slow.solves}});
  }
  json["deadline_ms"] = profile.deadline_ms;
  json["deadline_misses"] = summary.deadline_misses;
  json["allocations_per_replan"] = OrNull(summary.total.allocations.median);
  json["allocations_per_replan_max"] = OrNull(summary.total.allocations.max);
  json["same_as_record"] = nullptr;
  if (profile.compared > 0) {
    json["same_as_record"] = {{"same", profile.same}, {"compared", profile.compared}};
  }
  json["dropped_spans"] = profile.spans.dropped();
  json["machine"] = MachineJson(machine);
  for (const auto& [key, value] : BuildManifest()) json["build"][key] = value;
  return json;
}

}  // namespace touchdown::evaluation
