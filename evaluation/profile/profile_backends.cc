// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/profile/profile_backends.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/build_info.h"
#include "evaluation/compare/compare_report.h"
#include "evaluation/profile/profile_report.h"
#include "evaluation/record/record_reader.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

CompareOptions SolvesOf(const BackendsOptions& options, double gap) {
  CompareOptions compare;
  compare.from = options.record;
  compare.set = options.overrides;
  compare.bench.backends = options.backends;
  compare.bench.gap = gap;
  compare.bench.repeats = options.repeats;
  compare.bench.shares = false;
  compare.bench.backend_seconds = std::numeric_limits<double>::infinity();
  return compare;
}

// The median of each step's passes, as for each solve: repeated passes are no additional steps.
Quantiles MedianSteps(const Profile& profile) {
  std::vector<double> medians;
  for (std::size_t step = 0; step < profile.runs.front().samples.replans.size(); ++step) {
    std::vector<double> passes;
    for (const ProfileRun& run : profile.runs) {
      passes.push_back(1e3 * run.samples.replans[step].times.total.cpu);
    }
    medians.push_back(*Quantile(passes, 0.5));
  }
  return QuantilesOf(medians);
}

int Plans(const ProfileRun& run) {
  int plans = 0;
  for (const ReplanSample& sample : run.samples.replans) {
    plans += sample.status == planning::ReplanStatus::kPlanned;
  }
  return plans;
}

Json StepJson(const BackendLatency& of) {
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  return {{"median_ms", number(of.step_ms.median)},
          {"p95_ms", number(of.step_ms.p95)},
          {"p99_ms", number(of.step_ms.p99)},
          {"max_ms", number(of.step_ms.max)},
          {"allocations",
           {{"median", number(of.allocations.median)}, {"max", number(of.allocations.max)}}}};
}

std::string Cell(const std::optional<double>& value) {
  if (!value) return "-";
  return std::isfinite(*value) ? fmt::format("{:.3f}", *value) : "fail";
}

std::string Cells(const Quantiles& q) {
  return fmt::format("{:>9}{:>9}{:>9}", Cell(q.median), Cell(q.p95), Cell(q.p99));
}

}  // namespace

BackendsProfile ProfileBackends(const BackendsOptions& options, const Registries& registries,
                                const BackendsProgress& progress) {
  const RecordedFlight flight = ReadRecord(options.record, options.overrides, registries);
  BackendsProfile profile;
  profile.record = options.record;
  profile.scenario = flight.scenario.name;
  profile.steps = static_cast<int>(flight.plans.size());
  profile.repeats = options.repeats;
  const double flown = flight.scenario.solver.gap;
  profile.gap = options.gap.value_or(flown > 0.0 ? flown : BenchOptions().gap);
  profile.solves = RunCompare(SolvesOf(options, profile.gap), registries,
                              [&](int done, int all) { progress("problems", done, all); });
  const std::vector<BackendSummary> solves = Summarise(profile.solves);
  for (std::size_t i = 0; i < solves.size(); ++i) {
    std::vector<std::string> overrides = options.overrides;
    overrides.push_back("solver.backend=" + solves[i].backend);
    if (options.gap) overrides.push_back(fmt::format("solver.gap={}", *options.gap));
    ProfileOptions replay;
    replay.repeats = options.repeats;
    const Profile steps = ProfileRecord(ReadRecord(options.record, overrides, registries), replay,
                                        registries, [](int, int) {});
    profile.backends.push_back({solves[i], MedianSteps(steps), Summarise(steps).total.allocations,
                                Plans(steps.runs.front())});
    progress("backends", static_cast<int>(i) + 1, static_cast<int>(solves.size()));
  }
  return profile;
}

std::string BackendsText(const BackendsProfile& profile) {
  std::string text = fmt::format(
      "{}: the {} steps of {}, asked again of each backend, {} passes; thread CPU time in ms\n"
      "  {}\n",
      profile.scenario, profile.steps, profile.record, profile.repeats, BuildLine());
  text += CompareProblemsText(profile.solves);
  text += fmt::format(
      "  solve: until a feasible point is within {:g} of the best known cost; whole step: with "
      "this backend in the loop, also where its problem is optimal at the start\n"
      "  {:<15}{:>12}{:>27}   {:>27}{:>7}{:>20}\n"
      "  {:<15}{:>12}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>7}{:>12}{:>8}\n",
      profile.gap, "", "", "solve", "whole step", "", "allocations a step", "backend", "reached",
      "median", "p95", "p99", "median", "p95", "p99", "plans", "median", "max");
  const int all = TimedProblems(profile.solves);
  for (const BackendLatency& of : profile.backends) {
    const Quantiles& heap = of.allocations;
    const auto count = [](const std::optional<double>& n) {
      return n ? fmt::format("{:.0f}", *n) : std::string("-");
    };
    text += fmt::format("  {:<15}{:>12}{}   {}{:>7}{:>12}{:>8}\n", of.solves.backend,
                        SolvedText(of.solves, all), Cells(of.solves.cpu_ms), Cells(of.step_ms),
                        of.plans, count(heap.median), count(heap.max));
  }
  text +=
      "  reached: feasible and within the gap; plans: steps that made a new plan; allocations: of "
      "heap memory; docs/profile.md\n";
  for (const Refusal& refusal : profile.solves.refusals) text += refusal.reason + "\n";
  return text;
}

Json BackendsJson(const BackendsProfile& profile, const MachineState& machine) {
  Json json = {{"scenario", profile.scenario}, {"record", profile.record},
               {"steps", profile.steps},       {"repeats", profile.repeats},
               {"gap", profile.gap},           {"problems", CompareProblemsJson(profile.solves)}};
  json["backends"] = Json::object();
  for (const BackendLatency& of : profile.backends) {
    json["backends"][of.solves.backend] = {
        {"solve", BackendSummaryJson(of.solves)}, {"step", StepJson(of)}, {"plans", of.plans}};
  }
  json["refused"] = RefusalsJson(profile.solves.refusals);
  json["machine"] = MachineJson(machine);
  for (const auto& [key, value] : BuildManifest()) json["build"][key] = value;
  return json;
}

}  // namespace touchdown::evaluation
