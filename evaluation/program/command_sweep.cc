// SPDX-License-Identifier: BSD-3-Clause
// touchdown sweep: many landings of one scenario, their table and their file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/html.h"
#include "evaluation/base/output_path.h"
#include "evaluation/campaign/campaign_progress.h"
#include "evaluation/campaign/recorded_trials.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/campaign/sweep_page.h"
#include "evaluation/campaign/sweep_report.h"
#include "evaluation/campaign/trial_store.h"
#include "evaluation/program/commands.h"
#include "evaluation/report/report_program.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

struct SweepArguments {
  ScenarioArguments scenario;
  std::vector<std::string> vary;
  int trials = 20;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::uint64_t seed = 1;
  std::string shard = "1/1";
  double trial_limit_s = CampaignOptions().trial_limit_s;
  bool retry = false;
  std::string db;
  std::string picture;
  std::string html;
  std::string record = "none";
  bool json = false;
};

// A picture has the varied keys as axes: two lists at most, because a table of cells is flat.
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

void CheckSweepOutputs(const SweepArguments& arguments) {
  if (!arguments.db.empty() && arguments.db == arguments.picture) {
    throw BadInput(fmt::format("--db and --picture are the same file, {}.", arguments.db));
  }
  if (arguments.retry && arguments.db.empty()) {
    throw BadInput("--retry has no effect without --db.");
  }
  if (!arguments.db.empty()) CheckOutputPath("--db", arguments.db);
  if (!arguments.picture.empty()) CheckPicturePath("--picture", arguments.picture);
  if (!arguments.html.empty()) CheckPagePath("--html", arguments.html);
  CheckRecorded(arguments.record, arguments.html);
}

int Sweep(const SweepArguments& arguments, const Registries& registries) {
  SweepOptions options;
  options.scenario_path = FindScenario(arguments.scenario.scenario);
  options.overrides = arguments.scenario.Overrides();
  for (const std::string& text : arguments.vary)
    options.variations.push_back(Variation::Parse(text, registries));
  CheckPicture(arguments.picture, options.variations);
  options.trials = arguments.trials;
  options.seed = arguments.seed;
  CampaignOptions flight;
  flight.jobs = arguments.jobs;
  flight.db = arguments.db;
  flight.shard = Shard::Parse(arguments.shard);
  flight.trial_limit_s = arguments.trial_limit_s;
  flight.retry = arguments.retry;
  if (flight.shard.number > options.trials) {
    throw BadInput(
        fmt::format("--shard {}: it has no trials, of {}.", arguments.shard, options.trials));
  }
  const Campaign campaign = SweepCampaign(options, registries);
  CheckSweepOutputs(arguments);
  const CampaignResult result = RunCampaign(campaign, flight, registries, CampaignProgress());
  if (!result.reports) return kDone;
  if (result.interrupted_by != 0) return Interrupted(result, arguments.db);
  if (arguments.json) {
    std::cout << SweepJson(campaign, result.rows).dump(2) << std::endl;
  } else {
    std::cout << SweepText(campaign, result.rows) << std::flush;
  }
  const auto write = [&](const std::string& path) { WriteTrials(path, campaign, result.rows); };
  if (!arguments.picture.empty()) DrawFrom(arguments.db, arguments.picture, write, DrawSweep);
  if (!arguments.html.empty()) {
    const auto flights = RecordFlown(arguments.html, result.rows, RecordedNamed(arguments.record),
                                     flight, registries);
    WriteHtml("--html", arguments.html, SweepPage(campaign, result.rows, flights));
    if (!arguments.json) PrintPagePath(arguments.html);
  }
  const bool lost = std::any_of(result.rows.begin(), result.rows.end(),
                                [](const SweepRow& row) { return IsLost(row.result.outcome); });
  return lost ? kFellShort : kDone;
}

}  // namespace

void AddSweepCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand("sweep", "Fly many landings of one scenario", "sweep.md");
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
  command.Add("--jobs", arguments->jobs, "Trials flown at a time")
      .Check(Range(1, 1024))
      .ShowDefault();
  command.Add("--seed", arguments->seed, "Seed of the sweep; trial seeds follow from it")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.Add("--shard", arguments->shard, "Fly only the K-th of N parts of the trials")
      .TypeName("K/N")
      .ShowDefault();
  command
      .Add("--trial-limit", arguments->trial_limit_s,
           "Wall time after which a trial is given up as hung [s]")
      .Check(Range(0.1, 1e6))
      .ShowDefault();
  command.AddFile("--db", &arguments->db,
                  "Keep the trials, an SQLite file; with one of the same sweep go on where it ends",
                  "F.db");
  command.AddFile("--picture", &arguments->picture, "Draw success and time to land over --vary",
                  "F.png");
  command.AddFile("--html", &arguments->html, "Write the report as a page", "F.html");
  AddRecorded(command, &arguments->record,
              "Fly these again, with a record and a page that shows the flight, which the report "
              "links: failures, or all");
  command.AddFlag("--retry", arguments->retry,
                  "Fly again what crashed, hung or ended in an error, of the trials in --db");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return Sweep(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
