// SPDX-License-Identifier: BSD-3-Clause
// touchdown study hostile: landings in difficult worlds, under every assumed condition and some
// beyond the assumptions.
#include "evaluation/program/command_study_hostile.h"

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
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_report.h"
#include "evaluation/studies/hostile/hostile_study.h"
#include "evaluation/studies/hostile/hostile_tally.h"

namespace touchdown::evaluation {
namespace {

struct HostileArguments {
  HostileOptions options;
  bool within_only = false;
  std::optional<int> only;
  std::optional<int> show;
  bool ways = false;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string shard = "1/1";
  double trial_limit_s = CampaignOptions().trial_limit_s;
  bool retry = false;
  std::string db;
  std::string html;
  std::string record = "none";
  std::string against;
  bool json = false;
};

void CheckArguments(const HostileArguments& arguments, const Command& command) {
  for (const char* alone : {"--only", "--show", "--ways"}) {
    if (!command.Given(alone)) continue;
    for (const char* other : {"--db", "--html", "--shard", "--retry", "--against", "--record"}) {
      if (command.Given(other))
        throw BadInput(fmt::format("{} cannot be used with {}.", other, alone));
    }
  }
  const std::pair<const char*, const char*> apart[] = {{"--only", "--show"},
                                                       {"--ways", "--only"},
                                                       {"--ways", "--show"},
                                                       {"--ways", "--json"},
                                                       {"--show", "--json"}};
  for (const auto& [one, other] : apart) {
    if (command.Given(one) && command.Given(other)) {
      throw BadInput(fmt::format("{} and {} do not go together.", one, other));
    }
  }
  if (arguments.retry && arguments.db.empty())
    throw BadInput("--retry has no effect without --db.");
  if (!arguments.db.empty() && arguments.db == arguments.html) {
    throw BadInput(fmt::format("--db and --html are the same file, {}.", arguments.db));
  }
  if (!arguments.against.empty()) ReadHostileTimes(arguments.options, arguments.against);
  if (!arguments.db.empty()) CheckOutputPath("--db", arguments.db);
  if (!arguments.html.empty()) CheckPagePath("--html", arguments.html);
  CheckRecorded(arguments.record, arguments.html);
}

int Show(const HostileArguments& arguments, const Registries& registries) {
  const HostileFlight flight = DrawHostileFlight(arguments.options, *arguments.show, registries);
  std::string text =
      fmt::format("# Flight {} of `{}`.\n#", flight.index, HostileCommand(arguments.options));
  for (const auto& [key, value] : flight.trial.varied) text += fmt::format(" {}: {};", key, value);
  text.back() = '\n';
  std::cout << text << DumpScenario(flight.trial.scenario) << std::flush;
  return kDone;
}

// All flights, or the requested one as a campaign of its own.
Campaign CampaignOf(const HostileArguments& arguments, const Registries& registries) {
  if (!arguments.only) {
    return HostileCampaign(arguments.options,
                           DrawHostileFlights(arguments.options, arguments.jobs, registries));
  }
  HostileFlight flight = DrawHostileFlight(arguments.options, *arguments.only, registries);
  Campaign campaign = HostileCampaign(arguments.options, {std::move(flight)});
  campaign.trials.front().index = 0;
  return campaign;
}

int Fly(const HostileArguments& arguments, const Registries& registries) {
  CampaignOptions flight;
  flight.jobs = arguments.jobs;
  flight.db = arguments.db;
  flight.shard = Shard::Parse(arguments.shard);
  flight.trial_limit_s = arguments.trial_limit_s;
  flight.retry = arguments.retry;
  if (flight.shard.number > arguments.options.flights) {
    throw BadInput(fmt::format("--shard {}: it has no flights, of {}.", arguments.shard,
                               arguments.options.flights));
  }
  const Campaign campaign = CampaignOf(arguments, registries);
  CampaignResult result = RunCampaign(campaign, flight, registries, CampaignProgress());
  if (!result.reports) return kDone;
  if (result.interrupted_by != 0) return Interrupted(result, arguments.db);
  if (arguments.only) result.rows.front().trial.index = *arguments.only;
  if (!arguments.html.empty()) {
    const auto flights = RecordFlown(arguments.html, result.rows, RecordedNamed(arguments.record),
                                     flight, registries);
    WriteHtml("--html", arguments.html,
              HostilePage(arguments.options, result.rows, flights, registries));
    if (!arguments.json) PrintPagePath(arguments.html);
  }
  if (arguments.json) {
    std::cout << HostileJson(arguments.options, result.rows).dump(2) << std::endl;
  } else {
    std::cout << HostileText(arguments.options, result.rows) << std::flush;
    if (!arguments.against.empty()) {
      std::cout << HostilePairsText(result.rows,
                                    ReadHostileTimes(arguments.options, arguments.against))
                << std::flush;
    }
  }
  const bool lost = std::any_of(result.rows.begin(), result.rows.end(),
                                [](const SweepRow& row) { return IsLost(row.result.outcome); });
  return lost || ViolatesGuarantee(result.rows) ? kFellShort : kDone;
}

int Run(HostileArguments arguments, const Registries& registries, const Command& command) {
  CheckArguments(arguments, command);
  for (const std::string& name : arguments.options.families) HostileFamilyNamed(name);
  if (arguments.within_only) arguments.options.share_beyond = 0.0;
  if (arguments.show) return Show(arguments, registries);
  if (arguments.ways) {
    std::cout << HostileWaysText(DrawHostileFlights(arguments.options, arguments.jobs, registries))
              << std::flush;
    return kDone;
  }
  return Fly(arguments, registries);
}

}  // namespace

void AddHostileStudyCommand(Command study, const Registries& registries, CommandRun* run) {
  const Command command =
      study.AddCommand("hostile", "Collisions in worlds that are drawn to be hard", "hostile.md");
  const auto arguments = std::make_shared<HostileArguments>();
  HostileOptions& options = arguments->options;
  command.Add("--flights", options.flights, "Number of flights")
      .Check(Range(1, 1000000))
      .ShowDefault();
  command.AddList("--families", &options.families, "Families that are drawn from; all unless given",
                  "A,B,...", OneOf(HostileFamilyNames()));
  const Option share = command
                           .Add("--share-beyond", options.share_beyond,
                                "Share of the flights beyond the assumptions")
                           .Check(Range(0.0, 1.0))
                           .ShowDefault();
  command.AddFlag("--within-only", arguments->within_only, "No flight goes beyond the assumptions");
  command.Find("--within-only").Excludes(share);
  command.Add("--set", options.set, "Fix a key in every flight").TypeName("KEY=VALUE").OneWord();
  command.Add("--only", arguments->only, "Fly flight N alone")
      .TypeName("N")
      .Check(Range(0, 999999));
  command.Add("--show", arguments->show, "Print the scenario of flight N, fly nothing")
      .TypeName("N")
      .Check(Range(0, 999999));
  command.AddFlag("--ways", arguments->ways, "Say in how many worlds a way exists, fly nothing");
  command.Add("--jobs", arguments->jobs, "Flights at a time").Check(Range(1, 1024)).ShowDefault();
  command.Add("--seed", options.seed, "Seed of the study; the seeds of flights follow from it")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.Add("--shard", arguments->shard, "Fly only the K-th of N parts of the flights")
      .TypeName("K/N")
      .ShowDefault();
  command
      .Add("--trial-limit", arguments->trial_limit_s,
           "Wall time after which a flight is given up as hung [s]")
      .Check(Range(0.1, 1e6))
      .ShowDefault();
  command.AddFile(
      "--db", &arguments->db,
      "Keep the flights, an SQLite file; with one of the same study go on where it ends", "F.db");
  command.AddFile("--html", &arguments->html, "Write the report as a page", "F.html");
  AddRecorded(command, &arguments->record,
              "Fly these again, with a record and a page that shows the flight, which the report "
              "links: failures, or all");
  command.AddFile("--against", &arguments->against,
                  "Compare times with this file: the same flights with --set "
                  "map.observed_free=truth, or otherwise",
                  "F.db");
  command.AddFlag("--retry", arguments->retry,
                  "Fly again what crashed, hung or ended in an error, of the flights in --db");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run, command] {
    *run = [arguments, &registries, command] { return Run(*arguments, registries, command); };
  });
}

}  // namespace touchdown::evaluation
