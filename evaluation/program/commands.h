// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands of the program, one source file each: command_<name>.cc.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/page/replay_page.h"
#include "evaluation/program/command_line.h"
#include "evaluation/video/flight_video.h"
#include "touchdown/evaluation/program/program.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Exit statuses of the program.
inline constexpr int kDone = 0;
inline constexpr int kFellShort = 1;
inline constexpr int kBadInput = 2;

/// Adds a sub-command to `app`; when it is chosen, sets `run` to what returns the exit status.
using CommandRun = std::function<int()>;
/// `fly` and `land`.
void AddFlyCommands(Command app, const Registries& registries, CommandRun* run);
void AddCompareCommand(Command app, const Registries& registries, CommandRun* run);
void AddStudyCommand(Command app, const Registries& registries, CommandRun* run);
void AddSweepCommand(Command app, const Registries& registries, CommandRun* run);
void AddMergeCommand(Command app, CommandRun* run);
void AddCheckTermCommand(Command app, const Registries& registries, CommandRun* run);
void AddCheckVehicleCommand(Command app, const Registries& registries, CommandRun* run);
void AddListCommand(Command app, const Registries& registries, CommandRun* run);
void AddPlanCommand(Command app, const Registries& registries, CommandRun* run);
void AddProfileCommand(Command app, const Registries& registries, CommandRun* run);
void AddReplayCommand(Command app, const Registries& registries, CommandRun* run);
void AddExportCommand(Command app, const Registries& registries, CommandRun* run);

/// The options that choose a scenario, shared by the commands that fly.
struct ScenarioArguments {
  std::string scenario = "straight_turn";
  std::vector<std::string> set;
  std::string planner;
  std::string backend;
  std::string seed;

  void AddTo(Command command, bool scenario_required);
  /// --set and its short forms, in the order in which they count.
  std::vector<std::string> Overrides() const;
  /// The scenario with these options. Prints findings in its vehicle's file. @throws BadInput as LoadScenario does, and
  /// for a --backend of a planner that has its own.
  Scenario Load(const Registries& registries) const;
};

/// @throws BadInput if this build's timings are meaningless and the user did not ask for them.
void CheckTimings(bool allow_debug);

/// Says on stdout that a page was written.
void PrintPagePath(const std::string& path);

/// Tells the log how far a page of flights is.
ReplayProgress LogReplay();

/// Logs how far a video is. While it lives, SIGINT and SIGTERM end the work by Interruption, and nothing of the video
/// is left.
VideoProgress TellVideo();

/// `--record` of campaigns: which flights are recorded; with the words that it takes.
void AddRecorded(Command command, std::string* which, const std::string& help);

/// @throws BadInput if flights are to be recorded without a report beside which they could be.
void CheckRecorded(const std::string& which, const std::string& html);

/// CheckOutputPath for a study, which is never overwritten. @throws BadInput
void CheckNewStudy(const std::string& option, const std::string& path);

/// The same for a study's --db and the --picture of it, where they are not empty. @throws BadInput
void CheckOutputs(const std::string& db, const std::string& picture);

/// Names of the registry's backends.
std::vector<std::string> BackendNames(const Registries& registries);

}  // namespace touchdown::evaluation
