// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands of the program, one source file each: command_<name>.cc.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "touchdown/evaluation/program.h"
#include "touchdown/evaluation/scenario.h"

namespace touchdown::evaluation {

/// Exit statuses of the program.
inline constexpr int kDone = 0;
inline constexpr int kFellShort = 1;
inline constexpr int kBadInput = 2;

/// Adds a sub-command to `app`; when it is chosen, sets `run` to what returns the exit status.
using CommandRun = std::function<int()>;
void AddLandCommand(CLI::App& app, const Registries& registries, CommandRun* run);
void AddCompareCommand(CLI::App& app, const Registries& registries, CommandRun* run);
void AddSweepCommand(CLI::App& app, const Registries& registries, CommandRun* run);
void AddCheckTermCommand(CLI::App& app, const Registries& registries, CommandRun* run);
void AddListCommand(CLI::App& app, const Registries& registries, CommandRun* run);

/// The options that choose a scenario, shared by the commands that fly.
struct ScenarioArguments {
  std::string scenario = "straight_turn";
  std::vector<std::string> set;
  std::string planner;
  std::string backend;
  std::string seed;

  void AddTo(CLI::App& command, bool scenario_required);
  /// --set and its short forms, in the order in which they count.
  std::vector<std::string> Overrides() const;
};

/// An option that names a file to write; an empty name is refused. The command asks CheckOutputPath
/// before it runs.
CLI::Option* AddOutputOption(CLI::App& command, const std::string& name, std::string* path,
                             const std::string& help, const std::string& type);

/// Names of the registry's backends.
std::vector<std::string> BackendNames(const Registries& registries);

}  // namespace touchdown::evaluation
