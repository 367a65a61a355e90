// SPDX-License-Identifier: BSD-3-Clause
// Parses the command line with CLI11 and maps every failure to an exit status of the program.
// Faults of the input (CLI::ParseError, BadInput) are 2; faults of the program (any other
// exception) are 1. Each prints one sentence on stderr.
#include "touchdown/evaluation/program/program.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/interrupt_watch.h"
#include "evaluation/base/machine.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/progress.h"
#include "evaluation/base/stderr_log.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/base/words.h"
#include "evaluation/program/commands.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/scenario/scenario_value.h"
#include "evaluation/scenario/scenario_world.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {

void ScenarioArguments::AddTo(Command command, bool scenario_required) {
  const Option positional = command.Add(
      "SCENARIO", scenario, "Name of a shipped scenario (`touchdown list scenarios`) or a file");
  if (scenario_required) {
    positional.Required();
  } else {
    positional.ShowDefault();
  }
  command.Add("--set", set, "Change a key of the scenario; may be given again")
      .TypeName("KEY=VALUE")
      .OneWord();
  command.Add("--planner", planner, "Short for --set planner=").TypeName("NAME");
  command.Add("--backend", backend, "Short for --set solver.backend=").TypeName("NAME");
}

std::vector<std::string> ScenarioArguments::Overrides() const {
  std::vector<std::string> overrides = set;
  if (!planner.empty()) overrides.push_back("planner=" + planner);
  if (!backend.empty()) overrides.push_back("solver.backend=" + backend);
  if (!seed.empty()) overrides.push_back("seed=" + seed);
  return overrides;
}

Scenario ScenarioArguments::Load(const Registries& registries) const {
  Scenario loaded = LoadScenario(FindScenario(scenario), Overrides(), registries);
  if (!backend.empty() && !PlannerOf(loaded, registries).solver.empty()) {
    throw BadInput(fmt::format("--backend {}: the planner {} has no choice of solvers.", backend,
                               loaded.planner));
  }
  for (const sim::VehicleFinding& finding : VehicleWarnings(loaded)) {
    spdlog::warn("warning: vehicle {}: {}; {}.", loaded.vehicle, finding.what, finding.remedy);
  }
  return loaded;
}

void CheckTimings(bool allow_debug) {
  if (TimingsMeanSomething() || allow_debug) return;
  throw BadInput(
      "This build is not optimised, so its timings mean nothing: use the preset release or native, "
      "or give --allow-debug.");
}

void PrintPagePath(const std::string& path) {
  std::cout << fmt::format("{}: open it in a browser\n", path) << std::flush;
}

ReplayProgress LogReplay() {
  const auto lines = std::make_shared<std::map<std::string, Progress>>();
  return [lines](const std::string& name, int done, int all) {
    lines->try_emplace(name, ProgressText{"steps", name}).first->second(done, all);
  };
}

VideoProgress TellVideo() {
  const auto watch = std::make_shared<const InterruptWatch>();
  return [watch, tell = Progress({"pictures", "video"})](int done, int all) mutable {
    watch->ThrowIfAsked();
    tell(done, all);
  };
}

void AddRecorded(Command command, std::string* which, const std::string& help) {
  command.Add("--record", *which, help)
      .Check(OneOf({"none", "failures", "all"}))
      .TypeName("WHICH")
      .ShowDefault();
}

void CheckRecorded(const std::string& which, const std::string& html) {
  if (which == "none" || !html.empty()) return;
  throw BadInput("--record needs --html: the report links the flights.");
}

void CheckNewStudy(const std::string& option, const std::string& path) {
  CheckOutputPath(option, path);
  if (std::filesystem::exists(path)) {
    throw BadInput(
        fmt::format("{} {}: the file exists; a study is never overwritten.", option, path));
  }
}

void CheckOutputs(const std::string& db, const std::string& picture) {
  if (!db.empty() && db == picture) {
    throw BadInput(fmt::format("--db and --picture are the same file, {}.", db));
  }
  if (!db.empty()) CheckNewStudy("--db", db);
  if (!picture.empty()) CheckPicturePath("--picture", picture);
}

std::vector<std::string> BackendNames(const Registries& registries) {
  std::vector<std::string> names;
  for (const solvers::BackendEntry& entry : registries.backends) names.push_back(entry.name);
  return names;
}

namespace {

// CLI11 answers an unknown word with "a subcommand is required", without the word.
void CheckCommand(const CLI::App& app, const char* const* word, const char* const* end) {
  if (word == end || (*word)[0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == *word) return CheckCommand(*command, word + 1, end);
    names.push_back(command->get_name());
  }
  if (names.empty()) return;
  const std::string of = app.get_parent() == nullptr ? "" : " of " + app.get_name();
  throw BadInput(
      fmt::format("unknown command {}{}{}.", *word, of, Instead(*word, names, "the commands are")));
}

// A sentence that suggests the right word needs no other help.
std::string TryHelp(std::string sentence) {
  if (!sentence.ends_with("?)")) sentence += " (try --help)";
  return sentence;
}

// The words that the chosen command does not know. If options are among them, only these: the words after an unknown
// option are its value.
std::string Unknown(const CLI::App& app) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += " " + command->get_name();
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options()) {
    if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames().front());
  }
  std::vector<std::string> options, words = app.remaining(true);
  for (const std::string& word : words) {
    if (!word.starts_with("-")) continue;
    const std::string option = word.substr(0, word.find('='));
    options.push_back(option + DidYouMean(option, known));
  }
  return options.empty() ? fmt::format("{} takes no {}", name, fmt::join(words, " "))
                         : fmt::format("{} has no option {}", name, fmt::join(options, ", "));
}

// One sentence in one line, even if it contains outside words such as names of files and values of
// keys.
void Complain(const std::string& sentence) { spdlog::error("{}", InOneLine(sentence)); }

}  // namespace

int RunProgram(int argc, const char* const* argv, const Registries& registries) {
  LogToStderr();

  CLI::App app{"Plans, flies and evaluates quadrotor landings on a moving vehicle."};
  app.name("touchdown");
  app.set_version_flag("--version", TOUCHDOWN_VERSION);
  app.require_subcommand(1);
  CommandRun run;
  try {
    RequireDistinct(registries);
  } catch (const std::invalid_argument& error) {
    Complain(std::string(error.what()) + ".");
    return kBadInput;
  }
  Command(&app).EndHelp("README.md");
  AddFlyCommands(Command(&app), registries, &run);
  AddCompareCommand(Command(&app), registries, &run);
  AddStudyCommand(Command(&app), registries, &run);
  AddSweepCommand(Command(&app), registries, &run);
  AddMergeCommand(Command(&app), &run);
  AddPlanCommand(Command(&app), registries, &run);
  AddProfileCommand(Command(&app), registries, &run);
  AddReplayCommand(Command(&app), registries, &run);
  AddExportCommand(Command(&app), registries, &run);
  AddCheckTermCommand(Command(&app), registries, &run);
  AddCheckVehicleCommand(Command(&app), registries, &run);
  AddListCommand(Command(&app), registries, &run);
  try {
    CheckCommand(app, argv + std::min(1, argc), argv + argc);
    app.parse(argc, argv);
    return run();
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ExtrasError&) {
    Complain(TryHelp(Unknown(app)));
    return kBadInput;
  } catch (const CLI::ParseError& error) {
    Complain(TryHelp(error.what()));
    return kBadInput;
  } catch (const BadInput& error) {
    Complain(error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    Complain(error.what());
    return kFellShort;
  } catch (const Interruption& end) {
    spdlog::warn("interrupted");
    return 128 + end.signal;
  } catch (...) {
    spdlog::error("unknown exception: it is no std::exception");
    return kFellShort;
  }
}

}  // namespace touchdown::evaluation
