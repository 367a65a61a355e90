// SPDX-License-Identifier: BSD-3-Clause
// touchdown sweep: many landings of one scenario on threads, their table and its study file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/commands.h"
#include "touchdown/evaluation/progress.h"
#include "touchdown/evaluation/sweep.h"
#include "touchdown/evaluation/sweep_report.h"
#include "touchdown/evaluation/trial_table.h"

namespace touchdown::evaluation {
namespace {

struct SweepArguments {
  ScenarioArguments scenario;
  std::vector<std::string> vary;
  int trials = 20;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::uint64_t seed = 1;
  std::string db;
  bool json = false;
};

int Sweep(const SweepArguments& arguments, const Registries& registries) {
  SweepOptions options;
  options.scenario_path = FindScenario(arguments.scenario.scenario);
  options.overrides = arguments.scenario.Overrides();
  for (const std::string& text : arguments.vary)
    options.variations.push_back(Variation::Parse(text));
  options.trials = arguments.trials;
  options.seed = arguments.seed;
  const std::vector<SweepTrial> trials = PlanSweep(options, registries);
  for (const SweepTrial& trial : trials) {
    if (trial.scenario.planning.latency.measured && arguments.jobs > 1) {
      throw BadInput(
          "--jobs must be 1 with planning.latency=measured: trials would slow each other.");
    }
  }
  if (!arguments.db.empty()) CheckNewStudy("--db", arguments.db);
  const std::vector<SweepRow> rows = RunSweep(trials, arguments.jobs, registries,
                                              Progress({.things = "trials", .with_rate = true}));
  if (arguments.json) {
    std::cout << SweepJson(options, rows).dump(2) << std::endl;
  } else {
    std::cout << SweepText(options, rows) << std::flush;
  }
  if (!arguments.db.empty()) WriteTrialTable(arguments.db, options, rows);
  const bool all_flown = std::none_of(rows.begin(), rows.end(), [](const SweepRow& row) {
    return row.result.outcome == Outcome::kError;
  });
  return all_flown ? kDone : kFellShort;
}

}  // namespace

void AddSweepCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand("sweep", "Fly many landings of one scenario");
  const auto arguments = std::make_shared<SweepArguments>();
  arguments->scenario.AddTo(command, true);
  command.Add("--trials", arguments->trials, "Number of trials")
      .Check(Range(1, 1000000))
      .ShowDefault();
  command
      .Add("--vary", arguments->vary,
           "Change a key from trial to trial: a range to draw from, or values in turn")
      .TypeName("KEY=LO..HI|a,b,c")
      .OneWord();
  command.Add("--jobs", arguments->jobs, "Threads").Check(Range(1, 1024)).ShowDefault();
  command.Add("--seed", arguments->seed, "Seed of the sweep; trial seeds follow from it")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.AddFile("--db", &arguments->db, "Write the trial table, an SQLite file", "F.db");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return Sweep(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
