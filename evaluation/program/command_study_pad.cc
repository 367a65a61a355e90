// SPDX-License-Identifier: BSD-3-Clause
// touchdown study pad: how exactly each model of the pad filter estimates and predicts the pad in flights.
#include "evaluation/program/command_study_pad.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/progress.h"
#include "evaluation/report/report_program.h"
#include "evaluation/studies/pad/pad_report.h"
#include "evaluation/studies/pad/pad_summary.h"

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

void AddPadStudyCommand(Command study, const Registries& registries, CommandRun* run) {
  const Command command = study.AddCommand(
      "pad", "Accuracy of the pad filter in flights, for both of its models", "pad_filter.md");
  const auto arguments = std::make_shared<PadStudyArguments>();
  PadStudyOptions& options = arguments->options;
  options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.AddList("--scenarios", &options.scenarios, "Names or files", "NAME,...", AnyWord());
  command.AddList("--sigmas", &options.sigmas, "Of the pad's GPS [m]", "0.01,0.5,...",
                  Range(0.0, 100.0));
  command.Add("--trials", options.trials, "Flights of each scenario and sigma")
      .Check(Range(1, 1000000))
      .ShowDefault();
  command.Add("--set", options.overrides, "Change a key of the scenarios")
      .TypeName("KEY=VALUE")
      .OneWord();
  command.Add("--jobs", options.jobs, "Flights at a time").Check(Range(1, 1024)).ShowDefault();
  command.Add("--seed", options.seed, "Seed of the study; trial seeds follow from it")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.AddFile("--db", &arguments->db, "Write the table, an SQLite file", "F.db");
  command.AddFile("--picture", &arguments->picture, "Draw the prediction's errors", "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return Run(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
