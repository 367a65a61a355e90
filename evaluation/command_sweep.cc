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
#include "touchdown/evaluation/report_program.h"
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
  std::string picture;
  bool json = false;
};

// A picture has the axes that were varied: two lists at most, for a table of cells is flat.
void CheckPicture(const std::string& picture, const std::vector<Variation>& variations) {
  if (picture.empty()) return;
  const auto lists = std::count_if(variations.begin(), variations.end(),
                                   [](const Variation& v) { return !v.values.empty(); });
  if (variations.empty()) {
    throw BadInput(fmt::format(
        "--picture {}: it shows the outcome over what is varied, so it needs --vary.", picture));
  }
  if (lists > 2) {
    throw BadInput(
        fmt::format("--picture {}: lists of values can be given for two keys at most, and --vary "
                    "gives {}.",
                    picture, lists));
  }
}

int Sweep(const SweepArguments& arguments, const Registries& registries) {
  SweepOptions options;
  options.scenario_path = FindScenario(arguments.scenario.scenario);
  options.overrides = arguments.scenario.Overrides();
  for (const std::string& text : arguments.vary)
    options.variations.push_back(Variation::Parse(text));
  CheckPicture(arguments.picture, options.variations);
  options.trials = arguments.trials;
  options.seed = arguments.seed;
  const std::vector<SweepTrial> trials = PlanSweep(options, registries);
  for (const SweepTrial& trial : trials) {
    if (trial.scenario.planning.latency.measured && arguments.jobs > 1) {
      throw BadInput(
          "--jobs must be 1 with planning.latency=measured: trials would slow each other.");
    }
  }
  CheckOutputs(arguments.db, arguments.picture);
  const std::vector<SweepRow> rows = RunSweep(trials, arguments.jobs, registries,
                                              Progress({.things = "trials", .with_rate = true}));
  if (arguments.json) {
    std::cout << SweepJson(options, rows).dump(2) << std::endl;
  } else {
    std::cout << SweepText(options, rows) << std::flush;
  }
  const auto write = [&](const std::string& path) { WriteTrialTable(path, options, rows); };
  if (!arguments.db.empty()) write(arguments.db);
  if (!arguments.picture.empty()) DrawFrom(arguments.db, arguments.picture, write, DrawSweep);
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
  command.AddFile("--picture", &arguments->picture, "Draw success and time to land over --vary",
                  "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return Sweep(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
