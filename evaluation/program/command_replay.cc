// SPDX-License-Identifier: BSD-3-Clause
// touchdown replay: a recorded flight, to be looked at again.
#include <memory>
#include <string>

#include "evaluation/base/bad_input.h"
#include "evaluation/program/commands.h"
#include "evaluation/video/flight_video.h"

namespace touchdown::evaluation {
namespace {

struct ReplayArguments {
  std::string record;
  std::string video;
};

int ReplayFlight(const ReplayArguments& arguments, const Registries& registries) {
  if (arguments.video.empty()) throw BadInput("replay needs --video: what is to be made.");
  CheckVideo("--video", arguments.video);
  WriteVideo(arguments.record, arguments.video, registries);
  return kDone;
}

}  // namespace

void AddReplayCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand("replay", "Look at a recorded flight again");
  const auto arguments = std::make_shared<ReplayArguments>();
  command.Add("RECORD", arguments->record, "The record of a flight, as `land --record` writes it")
      .Required();
  command.AddFile("--video", &arguments->video,
                  "Make a video of it, by the program ffmpeg; an older file is overwritten",
                  "F.mp4");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return ReplayFlight(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
