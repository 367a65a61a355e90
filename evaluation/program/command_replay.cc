// SPDX-License-Identifier: BSD-3-Clause
// touchdown replay: a recorded flight to be looked at, as a page or as a video.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "evaluation/page/replay_page.h"
#include "evaluation/program/commands.h"
#include "evaluation/video/flight_video.h"

namespace touchdown::evaluation {
namespace {

struct ReplayArguments {
  std::string record;
  std::string beside;
  std::string html;
  std::string video;
};

void CheckReplay(const ReplayArguments& arguments) {
  if (arguments.html.empty() && arguments.video.empty()) {
    throw BadInput("replay needs --html or --video.");
  }
  if (arguments.html.empty() && !arguments.beside.empty()) {
    throw BadInput("--beside needs --html: only a page shows two flights.");
  }
  CheckApart(
      {{"RECORD", arguments.record}, {"--html", arguments.html}, {"--video", arguments.video}});
  CheckApart(
      {{"--beside", arguments.beside}, {"--html", arguments.html}, {"--video", arguments.video}});
  if (!arguments.html.empty()) CheckReplayPage("--html", arguments.html);
  if (!arguments.video.empty()) CheckVideo("--video", arguments.video);
}

int RunReplay(const ReplayArguments& arguments, const Registries& registries) {
  CheckReplay(arguments);
  if (!arguments.html.empty()) {
    std::vector<ShownRecord> records = {{arguments.record, arguments.record}};
    if (!arguments.beside.empty()) records.push_back({arguments.beside, arguments.beside});
    WriteReplayPage(arguments.html, records, registries, LogReplay());
    PrintPagePath(arguments.html);
  }
  if (!arguments.video.empty()) {
    WriteVideo(arguments.record, arguments.video, registries, TellVideo());
    std::cout << fmt::format("{}: a video of the flight\n", arguments.video) << std::flush;
  }
  return kDone;
}

}  // namespace

void AddReplayCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command =
      app.AddCommand("replay", "Show a recorded flight, as a page or as a video", "replay.md");
  const auto arguments = std::make_shared<ReplayArguments>();
  command.AddFile("RECORD", &arguments->record, "A flight's record (`land --record`)", "RECORD")
      .Required();
  command.AddFile("--html", &arguments->html,
                  "Write one page with all of it in, that any browser opens without a network",
                  "F.html");
  command.AddFile("--beside", &arguments->beside, "A second record, shown on the same clock",
                  "RECORD");
  command.AddFile("--video", &arguments->video,
                  "Make a video of it, by the program ffmpeg; an older file is overwritten",
                  "F.mp4");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return RunReplay(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
