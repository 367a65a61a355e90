// SPDX-License-Identifier: BSD-3-Clause
// touchdown replay: a recorded flight to be looked at.
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "evaluation/page/replay_page.h"
#include "evaluation/program/commands.h"

namespace touchdown::evaluation {
namespace {

struct ReplayArguments {
  std::string record;
  std::string beside;
  std::string html;
};

int RunReplay(const ReplayArguments& arguments, const Registries& registries) {
  CheckPagePath("--html", arguments.html);
  if (arguments.html == arguments.record || arguments.html == arguments.beside) {
    throw BadInput(fmt::format("--html {}: that is the record.", arguments.html));
  }
  std::vector<ShownRecord> records = {{arguments.record, arguments.record}};
  if (!arguments.beside.empty()) records.push_back({arguments.beside, arguments.beside});
  WriteReplayPage(arguments.html, records, registries, TellReplay());
  std::cout << fmt::format("{}: open it in a browser\n", arguments.html) << std::flush;
  return kDone;
}

}  // namespace

void AddReplayCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand("replay", "Show a recorded flight in three dimensions", "replay.md");
  const auto arguments = std::make_shared<ReplayArguments>();
  command.AddFile("RECORD", &arguments->record, "A flight's record (`land --record`)", "RECORD")
      .Required();
  command
      .AddFile("--html", &arguments->html,
               "Write one page with all of it in, that any browser opens without a network",
               "F.html")
      .Required();
  command.AddFile("--beside", &arguments->beside, "A second record, shown on the same clock",
                  "RECORD");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return RunReplay(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
