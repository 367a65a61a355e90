// SPDX-License-Identifier: BSD-3-Clause
// touchdown study run FILE, and study paper, solvers and ablation: the shipped ones. Every method in
// every cell of a study file, flown into a folder, and the report that is drawn from the folder.
#include "evaluation/program/command_study_run.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/launch.h"
#include "evaluation/campaign/campaign_progress.h"
#include "evaluation/campaign/study_rates.h"
#include "evaluation/campaign/study_run.h"
#include "evaluation/report/report_program.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

constexpr char kPage[] = "evaluation_protocol.md";

struct StudyRunArguments {
  std::string file;
  std::string out;
  StudySelection selection;
  bool report_only = false;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string seed;
  std::string shard = "1/1";
  bool retry = false;
  std::string record = "none";
  bool json = false;
};

// A study flies for minutes: enough to install what its report needs, for those who want one.
bool CanReport() {
  try {
    CheckStudyReport();
    return true;
  } catch (const std::runtime_error& missing) {
    spdlog::warn("{}", missing.what());
    return false;
  }
}

// The rates need nothing but the folder. The report is drawn from it by another program, which may fail.
int Tell(const StudyRunArguments& arguments, const std::string& folder, bool report) {
  const StudyRates rates = ReadStudyRates(folder);
  if (!arguments.json) std::cout << StudyRatesText(rates) << std::flush;
  bool failed = false;
  if (report) {
    try {
      WriteStudyReport(folder);
    } catch (const std::runtime_error& error) {
      spdlog::error("{}", error.what());
      failed = true;
    }
  }
  report = report && !failed;
  if (arguments.json) {
    nlohmann::ordered_json json = StudyRatesJson(rates);
    json["report"] = report ? nlohmann::ordered_json(folder + "/report.html") : nullptr;
    std::cout << json.dump(2) << std::endl;
  } else if (report) {
    std::cout << fmt::format("Report: {0}/report.html, {0}/report.md\n", folder) << std::flush;
  }
  return rates.errors == 0 && !failed ? kDone : kFellShort;
}

int Run(const StudyRunArguments& arguments, const Registries& registries) {
  const StudyFile file = LoadStudyFile(FindStudyFile(arguments.file), registries);
  if (arguments.selection.Part() && arguments.out.empty()) {
    throw BadInput("--cells, --methods and --trials need --out: study_" + file.name +
                   " is the whole study's folder.");
  }
  const std::string folder = arguments.out.empty() ? "study_" + file.name : arguments.out;
  if (arguments.report_only) {
    if (arguments.retry) throw BadInput("--retry has no effect with --report-only.");
    if (arguments.record != "none") throw BadInput("--record has no effect with --report-only.");
    if (std::filesystem::exists(StudyTablePath(folder))) return Tell(arguments, folder, true);
    throw BadInput(fmt::format("--report-only: {} is missing; the study must be flown first.",
                               StudyTablePath(folder)));
  }
  const Shard shard = Shard::Parse(arguments.shard);
  if (arguments.record != "none" && shard.of > 1) {
    throw BadInput("--record has no effect with --shard: flights are recorded when all are flown.");
  }
  const std::uint64_t seed = arguments.seed.empty() ? file.seed : std::stoull(arguments.seed);
  const StudyPlan plan = PlanStudy(file, arguments.selection, seed, registries);
  const bool alone = !LaunchedAsOneOfSeveral();
  const bool report = shard.of == 1 && (!alone || CanReport());
  CampaignOptions options;
  options.jobs = arguments.jobs;
  options.shard = shard;
  options.retry = arguments.retry;
  const CampaignResult result =
      FlyStudy(plan, folder, options, RecordedNamed(arguments.record), registries);
  if (!result.reports) return kDone;
  if (result.interrupted_by != 0) return Interrupted(result, StudyTablePath(folder, shard));
  if (shard.of == 1) return Tell(arguments, folder, report && (alone || CanReport()));
  std::cout << fmt::format("{} trials of shard {} are in {}\n", result.state.flown, arguments.shard,
                           StudyTablePath(folder, shard));
  return kDone;
}

void AddOptions(Command command, const std::shared_ptr<StudyRunArguments>& arguments,
                const Registries& registries, CommandRun* run) {
  command.AddFlag("--quick", arguments->selection.quick, "The short form: few seeds, main cells");
  command.AddList("--cells", &arguments->selection.cells, "Only these cells", "NAME,NAME,...",
                  AnyWord());
  command.AddList("--methods", &arguments->selection.methods, "Only these methods", "NAME,NAME,...",
                  AnyWord());
  command
      .Add("--trials", arguments->selection.trials,
           "Of each method in each cell: the first so many seeds, also more than its file says")
      .Check(Range(1, 100000));
  command.AddFile("--out", &arguments->out,
                  "The study's folder, made where it is missing; study_NAME unless given",
                  "FOLDER");
  command.Add("--jobs", arguments->jobs, "Trials flown at a time")
      .Check(Range(1, 1024))
      .ShowDefault();
  command.Add("--seed", arguments->seed, "Seed of the study instead of its file's")
      .TypeName("S")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53));
  command.Add("--shard", arguments->shard, "Fly only the K-th of N parts, into a file of its own")
      .TypeName("K/N")
      .ShowDefault();
  command.AddFlag("--retry", arguments->retry,
                  "Fly again what crashed, hung or ended in an error, of the trials in the folder");
  AddRecorded(command, &arguments->record,
              "Beside the first trial of some parts, fly these again, with a record and a page "
              "that shows the flight, which the report links: failures, or all");
  command.AddFlag("--report-only", arguments->report_only,
                  "Write the report of what the folder holds, without flying");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return Run(*arguments, registries); };
  });
}

}  // namespace

void AddStudyRunCommands(Command study, const Registries& registries, CommandRun* run) {
  const std::pair<const char*, const char*> shipped[] = {
      {"paper", "The comparative study of the landing paper, with its figures"},
      {"solvers", "Every solver backend in the closed loop"},
      {"ablation", "What each part of the method contributes"}};
  for (const auto& [name, help] : shipped) {
    const auto arguments = std::make_shared<StudyRunArguments>();
    arguments->file = name;
    AddOptions(study.AddCommand(name, help, kPage), arguments, registries, run);
  }
  const Command command = study.AddCommand("run", "A study of your own, from its file", kPage);
  const auto arguments = std::make_shared<StudyRunArguments>();
  command.Add("FILE", arguments->file, "Study file, or the name of a shipped one").Required();
  AddOptions(command, arguments, registries, run);
}

}  // namespace touchdown::evaluation
