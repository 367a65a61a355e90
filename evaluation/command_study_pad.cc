// SPDX-License-Identifier: BSD-3-Clause
// touchdown study pad: how well the pad is known and foretold in flights, by each model of the filter.
#include "touchdown/evaluation/command_study_pad.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/list_option.h"
#include "touchdown/evaluation/pad_report.h"
#include "touchdown/evaluation/pad_summary.h"
#include "touchdown/evaluation/progress.h"
#include "touchdown/evaluation/report_program.h"

namespace touchdown::evaluation {
namespace {

struct PadStudyArguments {
  PadStudyOptions options;
  std::string db;
  std::string picture;
  bool json = false;
};

int Run(const PadStudyArguments& arguments, const Registries& registries) {
  CheckOutputs(arguments.db, arguments.picture);
  const PadStudy study =
      RunPadStudy(arguments.options, registries, Progress({.things = "flights"}));
  if (arguments.json) {
    std::cout << PadStudyJson(arguments.options, study).dump(2) << std::endl;
  } else {
    std::cout << PadStudyText(arguments.options, study) << std::flush;
  }
  const auto write = [&](const std::string& path) {
    WritePadStudy(path, arguments.options, study);
  };
  if (!arguments.db.empty()) write(arguments.db);
  if (!arguments.picture.empty()) DrawFrom(arguments.db, arguments.picture, write, DrawPadStudy);
  const std::vector<PadDemand> demands = PadDemands(arguments.options, study);
  const bool met = std::all_of(demands.begin(), demands.end(),
                               [](const PadDemand& demand) { return demand.met(); });
  return met ? kDone : kFellShort;
}

}  // namespace

void AddPadStudyCommand(CLI::App& study, const Registries& registries, CommandRun* run) {
  CLI::App* command = study.add_subcommand(
      "pad", "How well the pad is known and foretold in flights, by both models of its filter");
  const auto arguments = std::make_shared<PadStudyArguments>();
  PadStudyOptions& options = arguments->options;
  options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  AddListOption(*command, "--scenarios", &options.scenarios, "Names or files", "NAME,...", {});
  AddListOption(*command, "--sigmas", &options.sigmas, "Of the pad's GPS [m]", "0.01,0.5,...",
                FiniteRange(0.0, 100.0));
  command->add_option("--trials", options.trials, "Flights of each scenario and sigma")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--set", options.overrides, "Change a key of the scenarios")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--jobs", options.jobs, "Threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "Seed of the study; trial seeds follow from it")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      ->capture_default_str();
  AddFileOption(*command, "--db", &arguments->db, "Write the table, an SQLite file", "F.db");
  AddFileOption(*command, "--picture", &arguments->picture, "Draw the prediction's errors",
                "F.png");
  command->add_flag("--json", arguments->json, "Print one JSON document on stdout");
  command->callback([arguments, &registries, run] {
    *run = [arguments, &registries] { return Run(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
