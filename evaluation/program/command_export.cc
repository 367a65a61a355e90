// SPDX-License-Identifier: BSD-3-Clause
// touchdown export: a recorded flight as a file for other people's viewers.
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "evaluation/base/interrupt_watch.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/progress.h"
#include "evaluation/mcap/flight_export.h"
#include "evaluation/program/commands.h"

namespace touchdown::evaluation {
namespace {

struct ExportArguments {
  std::string record;
  std::string mcap;
};

int RunExport(const ExportArguments& arguments, const Registries& registries) {
  CheckApart({{"RECORD", arguments.record}, {"--mcap", arguments.mcap}});
  CheckMcap("--mcap", arguments.mcap);
  const InterruptWatch watch;
  WriteMcap(arguments.record, arguments.mcap, registries,
            [&watch, tell = Progress({"messages", "export"})](int done, int all) mutable {
              watch.ThrowIfAsked();
              tell(done, all);
            });
  std::cout << fmt::format("{}: open it in Foxglove or Rerun\n", arguments.mcap) << std::flush;
  return kDone;
}

}  // namespace

void AddExportCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command =
      app.AddCommand("export", "Write a recorded flight for Foxglove and Rerun", "mcap.md");
  const auto arguments = std::make_shared<ExportArguments>();
  command.AddFile("RECORD", &arguments->record, "A flight's record (`land --record`)", "RECORD")
      .Required();
  command
      .AddFile("--mcap", &arguments->mcap,
               "Write an MCAP file with all that a viewer can draw of it; an older file is "
               "overwritten",
               "F.mcap")
      .Required();
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return RunExport(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
