// SPDX-License-Identifier: BSD-3-Clause
// touchdown plan: one replanning step, solved and explained.
#include <charconv>
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "evaluation/program/commands.h"
#include "evaluation/record/plan_case.h"
#include "evaluation/record/plan_report.h"
#include "evaluation/report/report_program.h"

namespace touchdown::evaluation {
namespace {

struct PlanArguments {
  ScenarioArguments scenario;
  std::string from;
  std::string picture;
  bool json = false;
};

struct StepName {
  std::string record;
  int step = 0;
};

StepName ParseStep(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  StepName name;
  if (colon != std::string::npos && colon > 0) {
    name.record = text.substr(0, colon);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, name.step);
    if (error == std::errc() && stop == end && name.step >= 0) return name;
  }
  throw BadInput(
      fmt::format("--from {}: write RECORD:N, N the number of a replanning step.", text));
}

SolvedStep SolveRecorded(const PlanArguments& arguments, const Registries& registries) {
  const StepName name = ParseStep(arguments.from);
  const std::vector<std::string> overrides = arguments.scenario.Overrides();
  const RecordedFlight flight = ReadRecord(name.record, overrides, registries);
  const int steps = static_cast<int>(flight.plans.size());
  if (name.step >= steps) {
    throw BadInput(steps == 0 ? fmt::format("{}: it holds no replanning step.", name.record)
                              : fmt::format("--from {}: {} holds the replanning steps 0 to {}.",
                                            arguments.from, name.record, steps - 1));
  }
  SolvedStep solved = SolveStep(flight, name.step, registries);
  solved.source = fmt::format("replanning step {} of {} ({}, seed {})", name.step, name.record,
                              flight.scenario.name, flight.scenario.seed);
  solved.same = Same(solved.outcome, solved.recorded.result);
  return solved;
}

SolvedStep SolveStart(const PlanArguments& arguments, const Registries& registries) {
  const Scenario scenario = arguments.scenario.Load(registries);
  SolvedStep solved = SolveStep(StepFromStart(scenario, registries), 0, registries);
  solved.source = fmt::format("first plan of {} (seed {}), obstacles and pad known", scenario.name,
                              scenario.seed);
  return solved;
}

// The picture is drawn from the step's own document, which is never kept.
void Draw(const std::string& picture, const SolvedStep& solved) {
  const auto write = [&](const std::string& path) {
    std::ofstream out(path);
    out << PlanJson(solved, true).dump() << std::endl;
    if (!out) {
      throw std::runtime_error(fmt::format("--picture {}: it could not be drawn.", picture));
    }
  };
  DrawFrom("", picture, write, DrawPlan);
}

int RunPlan(const PlanArguments& arguments, const Registries& registries) {
  if (!arguments.picture.empty()) CheckPicturePath("--picture", arguments.picture);
  const SolvedStep solved = arguments.from.empty() ? SolveStart(arguments, registries)
                                                   : SolveRecorded(arguments, registries);
  if (arguments.json) {
    std::cout << PlanJson(solved, false).dump(2) << std::endl;
  } else {
    std::cout << PlanText(solved) << std::flush;
  }
  if (!arguments.picture.empty()) Draw(arguments.picture, solved);
  return solved.outcome.status == planning::ReplanStatus::kUnsafe ? kFellShort : kDone;
}

}  // namespace

void AddPlanCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command =
      app.AddCommand("plan", "Solve one planning problem and explain it", "profile.md");
  const auto arguments = std::make_shared<PlanArguments>();
  arguments->scenario.AddTo(command, false);
  const Option seed = command.Add("--seed", arguments->scenario.seed, "Short for --set seed=");
  seed.TypeName("S");
  command
      .AddFile(
          "--from", &arguments->from,
          std::string("Solve replanning step N of a record again (`land --record`) instead of a "
                      "first plan from the scenario's start, where obstacles and pad are known. "
                      "--backend, --set ") +
              kReplayKeys + " change the planner",
          "RECORD:N")
      .Excludes(seed)
      .Excludes(command.Find("SCENARIO"));
  command.AddFile("--picture", &arguments->picture,
                  "Draw views, speed and acceleration against the limits, cost by iteration",
                  "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return RunPlan(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
